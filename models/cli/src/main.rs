//! The command `dvp`.
fn main() {}
