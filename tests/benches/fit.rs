//! Bench `fit`.
fn main() {}
