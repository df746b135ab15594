//! Weights that come with the program.

/// The bytes of the weights that are taken where none are named, as `dvp train` writes them: a model of the size `cells`,
/// trained as `tests/report/training.md` says.
pub const BUILT_IN: &[u8] = include_bytes!("../../weights/cells.safetensors");

/// Weights of a second look, trained on shaken scenes of MDS-HR. See `tests/report/training.md`.
pub const BUILT_IN_LOOK: &[u8] = include_bytes!("../../weights/look.safetensors");
