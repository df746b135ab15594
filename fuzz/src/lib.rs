//! Inputs of the fuzz targets, and what becomes of scenes. The `Debug` of inputs prints Rust, so that a crash pastes into a test.

use std::fmt;

use arbitrary::{Arbitrary, Result, Unstructured};
use dvp::paint::{Painter, RendererName};
use dvp_core::{Drawing, ImageSize, Real, Scene};

/// A number anywhere: mostly near the image, sometimes huge, tiny, or none.
pub fn number(u: &mut Unstructured<'_>) -> Result<f32> {
    Ok(match u.int_in_range(0..=15)? {
        0 => f32::from_bits(u.arbitrary()?),
        1 => *u.choose(&[0.0, -0.0, 1e-30, 1e30, -1e30, f32::MAX, f32::MIN_POSITIVE, f32::NAN, f32::INFINITY])?,
        2 => f32::from(u.int_in_range(-64_i16..=64)?) / 8.0,
        3 => f32::from(u.arbitrary::<i16>()?),
        _ => f32::from(u.arbitrary::<u16>()?) / 32768.0 - 0.5,
    })
}

/// A point of two such numbers.
pub fn point(u: &mut Unstructured<'_>) -> Result<[f32; 2]> {
    Ok([number(u)?, number(u)?])
}

/// Up to `most` items.
pub fn list<T>(
    u: &mut Unstructured<'_>,
    most: usize,
    mut item: impl FnMut(&mut Unstructured<'_>) -> Result<T>,
) -> Result<Vec<T>> {
    (0..u.int_in_range(0..=most)?).map(|_| item(u)).collect()
}

/// A list as Rust code; NaN and infinity by their names.
struct Code<'a>(&'a [f32]);

impl fmt::Display for Code<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[")?;
        for &v in self.0 {
            match v {
                v if v.is_nan() => write!(f, "f32::NAN, ")?,
                f32::INFINITY => write!(f, "f32::INFINITY, ")?,
                f32::NEG_INFINITY => write!(f, "f32::NEG_INFINITY, ")?,
                v => write!(f, "{v:?}, ")?,
            }
        }
        write!(f, "]")
    }
}

/// A list of numbers.
#[derive(Clone)]
pub struct Numbers(pub Vec<f32>);

impl fmt::Debug for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "vec!{}", Code(&self.0))
    }
}

/// A polygon.
#[derive(Clone)]
pub struct Points(pub Vec<[f32; 2]>);

impl fmt::Debug for Points {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "vec![")?;
        self.0.iter().try_for_each(|point| write!(f, "{}, ", Code(point)))?;
        write!(f, "]")
    }
}

impl<'a> Arbitrary<'a> for Points {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        list(u, 24, point).map(Self)
    }
}

/// Where rings begin, in any order and anywhere.
#[derive(Clone, Debug)]
pub struct Breaks(pub Vec<usize>);

impl Breaks {
    /// In order, and none behind `count` vertices.
    pub fn rising(mut self, count: usize) -> Vec<usize> {
        self.0.iter_mut().for_each(|start| *start = (*start).min(count));
        self.0.sort_unstable();
        self.0
    }
}

impl<'a> Arbitrary<'a> for Breaks {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        list(u, 6, |u| u.int_in_range(0..=40)).map(Self)
    }
}

/// A small image size.
pub fn size(u: &mut Unstructured<'_>, most: usize) -> Result<ImageSize> {
    let (width, height) = (u.int_in_range(1..=most)?, u.int_in_range(1..=most)?);
    ImageSize::new(width, height).map_err(|_| arbitrary::Error::IncorrectFormat)
}

/// A drawing of up to four wild objects, often of several rings, sometimes with breaks that are none, and the size to paint it at.
pub struct Painting {
    /// What to paint.
    pub drawing: Drawing<f32>,
    /// How large.
    pub size: ImageSize,
}

impl<'a> Arbitrary<'a> for Painting {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let size = size(u, 40)?;
        let mut drawing = Drawing { background: [number(u)?, number(u)?, number(u)?], ..Drawing::default() };
        for _ in 0..u.int_in_range(0..=4)? {
            let outline = Points::arbitrary(u)?.0;
            let color = [number(u)?, number(u)?, number(u)?];
            drawing.push(&outline, color, f32::from(u.arbitrary::<u8>()?) / 255.0);
        }
        let breaks = Breaks::arbitrary(u)?;
        drawing.breaks = if u.ratio(7, 8)? { breaks.rising(drawing.vertices.len()) } else { breaks.0 };
        Ok(Self { drawing, size })
    }
}

impl fmt::Debug for Painting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let drawing = &self.drawing;
        writeln!(f, "let size = ImageSize::new({}, {}).unwrap();", self.size.width(), self.size.height())?;
        writeln!(
            f,
            "let mut drawing = Drawing {{ background: {}, ..Drawing::default() }};",
            Code(&drawing.background)
        )?;
        for k in 0..drawing.object_count() {
            let outline = Points(drawing.outline(k).to_vec());
            writeln!(f, "drawing.push(&{outline:?}, {}, {:?});", Code(&drawing.colors[k]), drawing.confidences[k])?;
        }
        writeln!(f, "drawing.breaks = vec!{:?};", drawing.breaks)
    }
}

/// Paints a scene with every renderer: an error, or finite pixels.
///
/// # Panics
/// If a pixel is not finite.
pub fn paint<T: Real>(scene: &Scene<T>) {
    let size = ImageSize::new(24, 16).expect("24 x 16 is a size");
    for renderer in [RendererName::Contour, RendererName::Triangles, RendererName::Exact, RendererName::Hard] {
        let painter = Painter::from(renderer);
        if let Ok(image) = painter.paint_rgba(scene, size) {
            assert!(image.data().iter().all(|v| v.is_finite()), "{renderer:?}");
        }
    }
}
