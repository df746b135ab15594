//! The library behind the command `dvp`: formats, data sets, sub-commands.

extern crate alloc;

pub mod format;
pub mod svg;
