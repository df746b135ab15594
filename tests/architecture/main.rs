//! The house plan, kept by reading manifests and `use` lines; a module per concern.
#![expect(clippy::unwrap_used, reason = "what cannot be read fails the test")]

extern crate alloc;

mod crates;
mod house;
mod modules;
mod publish;
mod source;
