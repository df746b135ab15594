//! Weights that come with the program.

/// The bytes of the weights that are taken where none are named, as `dvp train` writes them. None yet.
///
/// To build them in: `Some(include_bytes!("../../weights/small.safetensors"))`.
pub const BUILT_IN: Option<&[u8]> = None;
