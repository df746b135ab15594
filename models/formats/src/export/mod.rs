//! What people measure.
//!
//! In: a scene and what its fit knows of it ([`measure`]). Out: numbers, label maps, tables.
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
//! | `region.rs` | the rings of an object | simple polygons with holes, [`Region`] |
//! | `measure.rs` | a scene and the covariance of its fit | [`MeasuredObject`]s |
//! | `scale.rs` | `0.12mm/px` | [`Scale`] |
//! | `table/` | objects of many pictures | a table: CSV, Parquet |
//! | `label_map.rs` | a scene, and the picture that it was read from | which object is seen in each pixel |
//! | `geojson.rs` | objects | a GeoJSON collection of features |
//! | `error.rs` | | [`ExportError`] |
//!
//! Proved by `models/cli/src/export/tests`, together with the formats of other programs that the command writes, by
//! `tests/command/exports.rs`, and by other programs in `tests/interop/check_exports.py`.

mod error;
mod geojson;
mod label_map;
mod measure;
mod region;
mod scale;
mod table;

pub use error::ExportError;
pub use geojson::{decimals, geojson};
pub use label_map::{label_map, label_map_in};
pub use measure::{Deviations, MeasuredObject, measure};
pub use region::{Polygon, Region};
pub use scale::Scale;
pub use table::{ColumnValues, HAS_PARQUET, TableColumn, table_columns, table_csv, table_parquet};

use dvp_core::ImageSize;

/// A picture of a run, with what came of it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MeasuredPicture {
    /// How the picture was named.
    pub picture: String,
    /// How its results are named.
    pub stem: String,
    /// What was found, or why nothing was.
    pub found: Result<Found, String>,
}

/// The objects of a picture.
#[derive(Clone, Debug)]
pub struct Found {
    /// The size of the picture.
    pub size: ImageSize,
    /// The objects, in the order of painting.
    pub objects: Vec<MeasuredObject>,
}

impl MeasuredPicture {
    /// A picture with the objects that were found in it, or why none were.
    #[must_use]
    pub fn new(picture: String, stem: String, found: Result<Found, String>) -> Self {
        Self { picture, stem, found }
    }

    /// The objects; none if the picture failed.
    #[must_use]
    pub fn objects(&self) -> &[MeasuredObject] {
        self.found.as_ref().map_or(&[], |found| &found.objects)
    }
}
