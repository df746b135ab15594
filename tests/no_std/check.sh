#!/usr/bin/env bash
# Core, trace and fit work without std: the clean build must link and run, and the build that lets std in must fail with the
# duplicate lang item. Either outcome alone would prove nothing. Exits 0 only if both are as expected.
set -euo pipefail
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$PWD/target}
log=$(mktemp)
trap 'rm -f "$log"' EXIT

cargo build --quiet --release --locked --target-dir "$target/no_std"
"${CC:-cc}" main.c "$target/no_std/release/libdvp_no_std_proof.a" -o "$target/no_std/proof"
code=0
"$target/no_std/proof" || code=$?
if [ "$code" -ne 0 ]; then
    echo "no_std: the program without std failed at step $code of src/lib.rs" >&2
    exit 1
fi
echo "no_std: core, trace and fit link and run without std"

if cargo build --quiet --release --locked --target-dir "$target/no_std" --features sneak_std 2> "$log"; then
    echo "no_std: std slipped in and the build did not notice" >&2
    exit 1
fi
if ! grep -q 'duplicate lang item' "$log"; then
    echo "no_std: the build with std failed for another reason:" >&2
    cat "$log" >&2
    exit 1
fi
echo "no_std: with std let in the build fails, as it must: $(grep -m1 'duplicate lang item' "$log")"
