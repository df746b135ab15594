/* Calls the proof from a program that has no Rust runtime. */
int dvp_no_std_proof(void);

int main(void) {
    return dvp_no_std_proof();
}
