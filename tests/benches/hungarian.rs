//! Bench `hungarian`.
fn main() {}
