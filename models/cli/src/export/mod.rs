//! What people measure, and what other programs read.
//!
//! In: a scene and what its fit knows of it ([`measure`]). Out: the bytes of a file. Measures, tables and label maps are those of
//! `dvp-formats`.
//!
//! *Units*: pixels. x runs to the right, y down; (0, 0) is the outer corner of the first pixel, whose center is
//! (0.5, 0.5). Programs that count from the center of the first pixel, as scikit-image does, have centroids and bounds that are
//! 0.5 less.
//!
//! What is measured is the outline that is drawn, whole: also where other objects hide it or where it leaves the picture.
//! The fat edges of MDS-HR reach beyond the outline and do not count.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `efd.rs` | objects of many pictures | normalized descriptors: CSV, the `.nef` of SHAPE |
//! | `label_map.rs` | a label map | PNG |
//! | `whole.rs` | a scene | the coverage of every object, PNG |
//! | `roi.rs` | objects | regions of interest of ImageJ, zipped |
//! | `coco.rs` | objects of many pictures | a COCO data set, JSON |
//!
//! Proved by `tests/` in this folder, `tests/command/exports.rs`, and by other programs in `tests/interop/check_exports.py`.

mod coco;
mod efd;
mod label_map;
mod roi;
#[cfg(test)]
mod tests;
mod whole;

pub use coco::coco;
pub use dvp_formats::export::{
    ColumnValues, Deviations, ExportError, Found, HAS_PARQUET, MeasuredObject, MeasuredPicture, Polygon, Region, Scale,
    TableColumn, geojson, label_map, label_map_in, measure, table_columns, table_csv, table_parquet,
};
pub use efd::{efd_csv, efd_nef, normal_efd};
pub use label_map::label_map_png;
pub use roi::roi_zip;
pub use whole::{whole_coverage, whole_png};
