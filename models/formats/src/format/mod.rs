//! Texts of scenes and banks, and pictures as decoders leave them.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `error.rs` | | the one error of reading and writing files, with file, line, field and remedy |
//! | `scene_json/` | scene JSON | [`SceneJson`], the text's structure, and a [`Scene`](dvp_core::Scene) with every number checked; and the way back |
//! | `bank.rs` | bank JSON, or the name `mdshr` | a [`Bank`](dvp_fit::Bank) |
//! | `picture.rs` | pixels | a [`Picture`] |
//! | `interleave.rs` | an image | the bytes that encoders of pictures take |

mod bank;
mod error;
mod interleave;
mod picture;
mod scene_json;

pub use bank::{bank_to_json, mdshr_bank, parse_bank, read_bank};
pub use error::{FormatError, Place};
pub use interleave::{interleaved_bytes, interleaved_rgba_bytes};
pub use picture::{BitDepth, ChannelValue, Picture, to_byte, to_step};
pub use scene_json::{
    CapJson, ColorStopJson, CompletionJson, CompositingJson, DeviationsJson, DoubtJson, EdgeJson, EdgeLawJson,
    FillJson, INVISIBLE, JoinJson, MAX_TEXT, ObjectJson, ObjectKnownJson, RampJson, RampKindJson, RingJson, SceneJson,
    SceneKnownJson, SegmentJson, ShapeJson, StopJson, edge_cut, read_scene, read_text,
};
