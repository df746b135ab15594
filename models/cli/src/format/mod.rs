//! Files in and out: scenes, data sets, banks, pictures.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `error.rs` | | the one error of this module, with file, line, field and remedy |
//! | `scene_json/` | scene JSON | [`SceneJson`], the text's structure, and a [`Scene`](dvp_core::Scene) with every number checked; and the way back |
//! | `bank.rs` | bank JSON, or the name `mdshr` | a [`Bank`](dvp_fit::Bank) |
//! | `data_set.rs` | a folder | its images and, where known, their scenes |
//! | `labels.rs` | STEM.labels.png | which object each pixel belongs to |
//! | `npy.rs` | NumPy arrays of float pixels | images |
//! | `picture.rs` | PNG, JPEG, BMP, GIF, WebP, PNM, TIFF | a [`Picture`] |
//! | `png.rs` | an [`Image`](dvp_core::Image) | PNG |
//! | `atomic.rs` | bytes | a file that is there whole or not at all |
//!
//! `tests/command/bad_input.rs` proves the errors, `tests/command/interrupted.rs` that nothing is left half-written.

mod atomic;
mod bank;
mod data_set;
mod error;
mod labels;
mod npy;
mod picture;
mod png;
mod scene_json;

pub use atomic::write_atomic;
pub use bank::{bank_to_json, mdshr_bank, parse_bank, read_bank};
pub use data_set::{DataSet, SCENES_FILE, Sample, bank_near, pictures_of, read_scene_lines};
pub use error::{FormatError, Place};
pub use labels::{labels_beside, read_labels};
pub use npy::read_npy;
pub use picture::{DEFAULT_MAX_PIXELS, Picture, decode_picture, decode_picture_rgba, read_picture, read_picture_rgba};
pub(crate) use png::to_byte;
pub use png::{BitDepth, encode_gray8, encode_gray16, encode_png, encode_png_rgba, from_rgb8, to_rgb8};
pub(crate) use scene_json::read_text;
pub use scene_json::{
    CapJson, CompletionJson, CompositingJson, DeviationsJson, DoubtJson, EdgeJson, EdgeLawJson, FillJson, INVISIBLE,
    JoinJson, ObjectJson, ObjectKnownJson, RingJson, SceneJson, SceneKnownJson, SegmentJson, ShapeJson, StopJson,
    edge_cut, read_scene,
};

#[cfg(test)]
mod tests;
