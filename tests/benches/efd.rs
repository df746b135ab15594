//! Bench `efd`.
fn main() {}
