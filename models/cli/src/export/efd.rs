//! Normalized elliptic Fourier descriptors of objects, for morphometrics.
//!
//! *Conventions*: the outline is that around the largest part of the object, without holes, x right and y down in pixels, turning from +x to
//! +y, parametrized by its length. x(t) = sum a_n cos(2 pi n t) + b_n sin(2 pi n t), y(t) = sum c_n cos(2 pi n t) + d_n sin(2 pi n t), n from 1.
//! Position, size, angle and starting point are taken out by the ellipse of the first harmonic: a_1 = 1, b_1 = c_1 = 0,
//! 0 < d_1 <= 1. That leaves two starting points, the ends of the long axis of that ellipse: the one that lies farther from
//! the center is taken. Mirror images differ: all b_n and c_n change their signs.
//!
//! *Source*: F. P. Kuhl and C. R. Giardina, "Elliptic Fourier features of a closed contour", 1982.

use core::fmt::Write as _;

use dvp_core::Efd;
use dvp_core::shape::ShapeError;

use super::ExportError;
use super::{MeasuredObject, MeasuredPicture, Region};

/// The first `harmonics` normalized descriptors of a region.
///
/// # Errors
/// [`ShapeError::TooFewPoints`] if nothing is enclosed, [`ShapeError::Degenerate`] if the first harmonic vanishes.
pub(super) fn normal_form(region: &Region, harmonics: usize) -> Result<Efd<f64>, ShapeError> {
    normal_efd(region.largest_ring().unwrap_or(&[]), harmonics)
}

/// The first `harmonics` normalized descriptors of a closed contour, by the conventions of `dvp fit --efd`: position, size, angle
/// and starting point are taken out by the first harmonic, a_1 = 1, b_1 = c_1 = 0, |d_1| <= 1, and of the two ends of its long axis
/// the one farther from the center is the start. d_1 > 0 for contours that turn from +x to +y.
///
/// # Errors
/// [`ShapeError::TooFewPoints`] below three distinct points, [`ShapeError::NotFinite`], [`ShapeError::TooLarge`],
/// [`ShapeError::Degenerate`] if the first harmonic vanishes.
pub fn normal_efd(ring: &[[f64; 2]], harmonics: usize) -> Result<Efd<f64>, ShapeError> {
    let (efd, _) = Efd::from_contour(ring, harmonics)?;
    let normal = efd.normalize()?.efd;
    let twin = normal.half_turn();
    Ok(if start_distance(&twin) > start_distance(&normal) { twin } else { normal })
}

/// The squared distance of the starting point from the center.
fn start_distance(efd: &Efd<f64>) -> f64 {
    let [x, y] = [0, 2].map(|k| efd.rows().iter().map(|row| row[k]).sum::<f64>());
    x * x + y * y
}

/// The normalized descriptors of all objects as CSV: `picture`, `stem`, `object`, `harmonic`, `a`, `b`, `c`, `d`; a row per
/// harmonic. What has no descriptors (an object that encloses nothing) has one row with an empty `harmonic`.
///
/// # Errors
/// [`ExportError::Table`] if the encoder refuses.
pub fn efd_csv(pictures: &[MeasuredPicture], harmonics: usize) -> Result<Vec<u8>, ExportError> {
    let refused = |error: csv::Error| ExportError::Table(error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["picture", "stem", "object", "harmonic", "a", "b", "c", "d"]).map_err(refused)?;
    for (picture, object) in objects(pictures) {
        let names = [picture.picture.clone(), picture.stem.clone(), object.number.to_string()];
        match normal_form(&object.region, harmonics) {
            Ok(efd) => {
                for (n, row) in (1..).zip(efd.rows()) {
                    let numbers = row.map(|value| format!("{:.9}", nine_decimals(value)));
                    let harmonic = [n.to_string()];
                    writer.write_record(names.iter().chain(&harmonic).chain(&numbers)).map_err(refused)?;
                }
            }
            Err(_) => writer.write_record(names.iter().map(String::as_str).chain([""; 5])).map_err(refused)?,
        }
    }
    writer.into_inner().map_err(|error| ExportError::Table(error.to_string()))
}

/// The normalized descriptors of all objects in the format `.nef` of SHAPE, which Momocs reads as well: two lines of head
/// (which coefficients of the first harmonic are constant, how many harmonics), then per object its name (`STEM_NUMBER`)
/// and a line of a, b, c, d per harmonic. Objects without descriptors are left out.
///
/// *Source*: H. Iwata and Y. Ukai, "SHAPE: a computer program package for quantitative evaluation of biological shapes
/// based on elliptic Fourier descriptors", 2002; as the function `nef2Coe` of Momocs reads it.
#[must_use]
pub fn efd_nef(pictures: &[MeasuredPicture], harmonics: usize) -> Vec<u8> {
    let mut text = format!("#CONST 1 1 1 0\n#HARMO {harmonics}\n");
    for (picture, object) in objects(pictures) {
        let Ok(efd) = normal_form(&object.region, harmonics) else { continue };
        // A name is one word.
        let stem: String = picture.stem.chars().map(|c| if c.is_whitespace() { '_' } else { c }).collect();
        // Writing to a string never fails.
        let _ = writeln!(text, "{stem}_{}", object.number);
        for [a, b, c, d] in efd.rows().iter().map(|row| row.map(nine_decimals)) {
            let _ = writeln!(text, " {a:.9e} {b:.9e} {c:.9e} {d:.9e}");
        }
    }
    text.into_bytes()
}

/// Rounded, without a sign where that leaves nothing.
fn nine_decimals(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

fn objects(pictures: &[MeasuredPicture]) -> impl Iterator<Item = (&MeasuredPicture, &MeasuredObject)> {
    pictures.iter().flat_map(|picture| picture.objects().iter().map(move |object| (picture, object)))
}
