//! A GeoJSON collection of the objects of a picture.
//!
//! Coordinates are pixels, x right and y down, not degrees: programs that put annotations on pictures (QuPath) take them so. An
//! object of one part is a `Polygon`, of several parts a `MultiPolygon`; outer rings have a positive area in the
//! coordinates as they are, holes a negative one. Properties are what the table tells.
//!
//! *Source*: RFC 7946, but for the units.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use super::error::ExportError;
use super::table::{Cell, Column, Row, columns};
use super::{MeasuredPicture, Polygon, Scale};

/// Decimals of coordinates: a ten-thousandth of a pixel.
const DECIMALS: f64 = 1e4;

/// A number with as many decimals as texts have.
#[must_use]
pub fn decimals(value: f64) -> f64 {
    (value * DECIMALS).round() / DECIMALS
}

#[derive(Serialize)]
struct Collection<'a> {
    r#type: &'static str,
    features: Vec<Feature<'a>>,
}

#[derive(Serialize)]
struct Feature<'a> {
    r#type: &'static str,
    id: u32,
    geometry: Option<Geometry>,
    properties: Properties<'a>,
}

#[derive(Serialize)]
#[serde(tag = "type", content = "coordinates")]
enum Geometry {
    Polygon(Vec<Ring>),
    MultiPolygon(Vec<Vec<Ring>>),
}

/// The last position is the first again.
type Ring = Vec<[f64; 2]>;

/// What the table tells, but the error: a picture that failed has no file.
struct Properties<'a> {
    columns: &'a [Column],
    row: Row<'a>,
}

impl Serialize for Properties<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for column in self.columns {
            match column.cell(&self.row) {
                Cell::Empty => (),
                Cell::Text(text) => map.serialize_entry(&column.name, &text)?,
                Cell::Count(count) => map.serialize_entry(&column.name, &count)?,
                Cell::Number(number) => map.serialize_entry(&column.name, &number)?,
            }
        }
        map.end()
    }
}

/// The collection as JSON; what encloses nothing has no geometry.
///
/// # Errors
/// [`ExportError::Json`].
pub fn geojson(picture: &MeasuredPicture, scale: Option<Scale>) -> Result<Vec<u8>, ExportError> {
    let columns = columns(scale);
    let features = picture.objects().iter().map(|object| {
        let properties = Properties { columns: &columns, row: Row { picture, object: Some(object) } };
        let mut parts: Vec<Vec<Ring>> = object.region.polygons.iter().map(rings).collect();
        let geometry = match parts.len() {
            0 => None,
            1 => parts.pop().map(Geometry::Polygon),
            _ => Some(Geometry::MultiPolygon(parts)),
        };
        Feature { r#type: "Feature", id: object.number, geometry, properties }
    });
    Ok(serde_json::to_vec(&Collection { r#type: "FeatureCollection", features: features.collect() })?)
}

fn rings(polygon: &Polygon) -> Vec<Ring> {
    let closed = |ring: &[[f64; 2]]| {
        let mut ring: Ring = ring.iter().map(|vertex| vertex.map(decimals)).collect();
        ring.dedup();
        ring.extend(ring.first().copied());
        ring
    };
    polygon.rings().map(closed).collect()
}
