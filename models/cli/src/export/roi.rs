//! Regions of interest of ImageJ: a `.roi` per object, zipped for its ROI Manager.
//!
//! An object of one ring is a polygon with coordinates finer than pixels; one of several rings is a composite, holes turning the
//! other way than what is around them.
//!
//! *Source*: the classes `ij.io.RoiEncoder` and `ij.io.RoiDecoder` of ImageJ: numbers are big-endian; 64 bytes of head, coordinates, 64
//! bytes of a second head, the name.

use std::io::Write as _;

use dvp_core::geometry::Bounds;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::{CompressionMethod, ZipArchiveWriter};

use super::ExportError;
use super::{MeasuredObject, Region};

/// The version of the format that coordinates finer than pixels came with, and names that are told apart from them.
const VERSION: i16 = 227;
/// Bytes of each of the two heads.
const HEAD: usize = 64;
const POLYGON: u8 = 0;
const RECTANGLE: u8 = 1;
/// The option that says that coordinates follow once more as fractions.
const SUB_PIXEL: i16 = 128;
/// Segments of a composite.
const MOVE: f32 = 0.0;
const LINE: f32 = 1.0;
const CLOSE: f32 = 4.0;

/// The archive of the objects of a picture, in their order, each called by its number and class: `0001-circle.roi`. Objects
/// that enclose nothing are left out.
///
/// # Errors
/// [`ExportError::Zip`] if the encoder refuses.
pub fn roi_zip(objects: &[MeasuredObject]) -> Result<Vec<u8>, ExportError> {
    let refused = |error: rawzip::Error| ExportError::Zip(std::io::Error::other(error));
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for object in objects {
        let Some(bounds) = object.bounds else { continue };
        // A slash would make a folder.
        let name = format!("{:04}-{}", object.number, object.class().replace(['/', '\\'], "_"));
        // Deflated: Java cannot read entries whose size follows them if they are stored as they are.
        let file = archive.new_file(format!("{name}.roi")).compression_method(CompressionMethod::DEFLATE);
        let (mut entry, config) = file.start().map_err(refused)?;
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        writer.write_all(&roi(&object.region, &bounds, &name))?;
        let (encoder, descriptor) = writer.finish().map_err(refused)?;
        encoder.finish()?;
        entry.finish(descriptor).map_err(refused)?;
    }
    archive.finish().map_err(refused)
}

/// The bytes of a region of interest.
pub(super) fn roi(region: &Region, bounds: &Bounds<f64>, name: &str) -> Vec<u8> {
    let ring = region.largest_ring().unwrap_or(&[]);
    let one = region.rings().count() == 1;
    let count = u16::try_from(ring.len()).ok().filter(|_| one);
    let coordinates = match count {
        Some(_) => polygon(ring, bounds),
        None => composite(region),
    };
    let sides = [bounds.min.y.floor(), bounds.min.x.floor(), bounds.max.y.ceil(), bounds.max.x.ceil()].map(short);
    let mut bytes = b"Iout".to_vec();
    bytes.extend(VERSION.to_be_bytes());
    bytes.extend([if count.is_some() { POLYGON } else { RECTANGLE }, 0]);
    bytes.extend(sides.into_iter().flat_map(i16::to_be_bytes));
    bytes.extend(count.unwrap_or(0).to_be_bytes());
    // Lines and rotated rectangles have coordinates here; then the width of the stroke.
    bytes.extend([0; 16 + 2]);
    let floats = if count.is_some() { 0 } else { coordinates.len() / size_of::<f32>() };
    bytes.extend(u32::try_from(floats).unwrap_or(u32::MAX).to_be_bytes());
    // Colors of stroke and fill, subtype.
    bytes.extend([0; 4 + 4 + 2]);
    bytes.extend(if count.is_some() { SUB_PIXEL } else { 0 }.to_be_bytes());
    // Arrow, round corners, position in a stack.
    bytes.extend([0; 2 + 2 + 4]);
    let second = HEAD + coordinates.len();
    bytes.extend(long(second));
    bytes.extend(coordinates);
    // Channel, slice and frame, after four bytes that nobody reads.
    bytes.extend([0; 4 + 12]);
    let name: Vec<u16> = name.encode_utf16().collect();
    bytes.extend(long(second + HEAD));
    bytes.extend(long(name.len()));
    bytes.resize(second + HEAD, 0);
    bytes.extend(name.into_iter().flat_map(u16::to_be_bytes));
    bytes
}

/// All x from the left side of the box in whole pixels, all y from its upper side, then all x and all y as they are.
fn polygon(ring: &[[f64; 2]], bounds: &Bounds<f64>) -> Vec<u8> {
    let starts = [bounds.min.x.floor(), bounds.min.y.floor()];
    let axes = || (0..2).flat_map(|axis| ring.iter().map(move |vertex| (axis, vertex[axis])));
    let whole = axes().flat_map(|(axis, value)| short((value - starts[axis]).round()).to_be_bytes());
    whole.chain(axes().flat_map(|(_, value)| float(value))).collect()
}

/// Ring after ring: a move to its first vertex, lines to the others, a close.
fn composite(region: &Region) -> Vec<u8> {
    let mut bytes = Vec::new();
    for ring in region.rings() {
        for (i, &[x, y]) in ring.iter().enumerate() {
            bytes.extend(if i == 0 { MOVE } else { LINE }.to_be_bytes());
            bytes.extend(float(x));
            bytes.extend(float(y));
        }
        bytes.extend(CLOSE.to_be_bytes());
    }
    bytes
}

#[expect(clippy::cast_possible_truncation, reason = "single precision is what the format has")]
fn float(value: f64) -> [u8; 4] {
    (value as f32).to_be_bytes()
}

/// Two bytes; readers take what is above 32767 back from the negative numbers that it wraps to.
#[expect(clippy::cast_possible_truncation, reason = "wraps, as the format does")]
fn short(value: f64) -> i16 {
    value as i64 as i16
}

fn long(value: usize) -> [u8; 4] {
    i32::try_from(value).unwrap_or(i32::MAX).to_be_bytes()
}
