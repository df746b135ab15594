//! The command `dvp`.

use std::io::{stderr, stdout};
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(dvp::command::run(std::env::args_os(), &mut stdout(), &mut stderr()))
}

/// Large pictures touch a gigabyte: in pages of 4 kB that was a quarter of the time.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static GLOBAL: mimalloc::MiMalloc = mimalloc::MiMalloc;
