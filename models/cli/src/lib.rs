//! The library behind the command `dvp`: formats, data sets, sub-commands.

pub mod format;
