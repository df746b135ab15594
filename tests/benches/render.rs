//! Bench `render`.
fn main() {}
