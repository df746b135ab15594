//! Files in and out: scenes, data sets, banks, pictures. Texts and pictures in memory are those of `dvp-formats`.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `data_set.rs` | a folder | its images and, where known, their scenes |
//! | `labels.rs` | STEM.labels.png | which object each pixel belongs to |
//! | `npy.rs` | NumPy arrays of float pixels, or of bytes | images, or the bytes |
//! | `npz.rs` | archives of NumPy arrays | arrays of bytes by name |
//! | `tf_record.rs`, `tf_example.rs` | records of TensorFlow | features by name |
//! | `picture.rs` | PNG, JPEG, BMP, GIF, WebP, PNM, TIFF | a [`Picture`] |
//! | `png.rs` | an [`Image`](dvp_core::Image) | PNG |
//! | `atomic.rs` | bytes | a file that is there whole or not at all |
//!
//! `tests/command/bad_input.rs` proves the errors, `tests/command/interrupted.rs` that nothing is left half-written.

mod atomic;
mod data_set;
mod labels;
mod npy;
mod npz;
mod picture;
mod png;
mod tf_example;
mod tf_record;

pub use atomic::write_atomic;
pub use data_set::{DataSet, SCENES_FILE, Sample, bank_near, pictures_of, read_scene_lines};
pub use dvp_formats::format::{
    BitDepth, CapJson, ChannelValue, ColorStopJson, CompletionJson, CompositingJson, DeviationsJson, DoubtJson,
    EdgeJson, EdgeLawJson, FillJson, FormatError, INVISIBLE, JoinJson, ObjectJson, ObjectKnownJson, Picture, Place,
    RampJson, RampKindJson, RingJson, SceneJson, SceneKnownJson, SegmentJson, ShapeJson, StopJson, bank_to_json,
    edge_cut, mdshr_bank, parse_bank, read_bank, read_scene,
};
pub(crate) use dvp_formats::format::{MAX_TEXT, read_text, to_byte};
pub(crate) use labels::WHOLE_ENDING;
pub use labels::{labels_beside, read_labels};
pub(crate) use npy::ByteArray;
pub use npy::read_npy;
pub(crate) use npz::read_npz;
pub use picture::{DEFAULT_MAX_PIXELS, decode_picture, decode_picture_rgba, read_picture, read_picture_rgba};
pub use png::{encode_gray8, encode_gray16, encode_png, encode_png_rgba, from_rgb8, to_rgb8};
pub(crate) use tf_example::Example;
#[cfg(test)]
pub(crate) use tf_example::{Feature, Features, Floats, Strings, Values as TfValues};
pub(crate) use tf_record::TfRecords;
#[cfg(test)]
pub(crate) use tf_record::masked_crc;

#[cfg(test)]
mod tests;
