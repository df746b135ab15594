//! The precisions that methods know.

use clap::ValueEnum;

/// Numbers to compute with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, ValueEnum)]
pub enum Precision {
    /// 32 bits
    #[default]
    F32,
    /// 64 bits
    #[cfg(feature = "double")]
    F64,
}
