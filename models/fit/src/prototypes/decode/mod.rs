//! Pictures of few colors without a mixed pixel, whose objects have the shapes of a bank: pixel by pixel.
//!
//! Edges without mixed pixels tell where an outline is to half a pixel and no more, and outlines that are smooth and short miss some
//! pixels of every object. With known shapes a pose has four numbers and every pixel along the outline a say: inside or outside. Poses are
//! found that leave no pixel wrong.
//!
//! ```text
//! picture -> colors -> pixels of one color -> demands -> prototype and pose -> order of painting -> scene
//! ```
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `flat` | a picture | its colors, and the parts of each; none if there are many |
//! | `demand` | pixels of one object | what every pixel demands; how wrong a pose is |
//! | `search` | a demand, a bank | the best prototype and pose |
//! | `split` | objects of one color that touch | the pieces |
//! | `order` | posed objects | which is painted first |
//!
//! Proved by `tests` beside it, and by `tests/report/suites.md`.

mod demand;
mod flat;
mod order;
mod search;
mod split;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::ShapeError;
use dvp_core::{ImageView, Object, Pose, Real, Scene};

use self::demand::Demand;
use self::flat::{FlatPicture, Part};
use self::search::{Posed, Shapes};
use self::split::{explains, split};
use crate::Bank;

/// Parts of fewer pixels are what occlusion left of something.
const LEAST_PART_PX: usize = 6;

/// A bank made ready to find its shapes in pictures of few colors.
#[derive(Clone, Debug)]
pub struct Decoder<T> {
    bank: Bank<T>,
    shapes: Option<Shapes>,
}

/// Why there is no scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undecoded {
    /// Pixels have more than a few colors: they are mixed, or noisy, or those of no drawing.
    NotFlat,
    /// Something in the picture is none of the shapes, or hides in a way that no order of painting brings about.
    Unexplained,
}

/// An object that was found: its pixels, and what they are.
struct Found {
    color: usize,
    pixels: Part,
    posed: Posed,
}

impl<T: Real> Decoder<T> {
    /// Makes a bank ready.
    ///
    /// # Errors
    /// [`ShapeError`] if a prototype is no outline.
    #[inline(never)]
    pub fn new(bank: &Bank<T>) -> Result<Self, ShapeError> {
        Ok(Self { bank: bank.clone(), shapes: Shapes::new(bank)? })
    }

    /// The shapes.
    #[must_use]
    pub fn bank(&self) -> &Bank<T> {
        &self.bank
    }

    /// The scene of a picture: every object has a shape of the bank, and every pixel shows what it should, but for about one in fifty.
    ///
    /// # Errors
    /// [`Undecoded`] if there is no such scene.
    #[inline(never)]
    pub fn scene(&self, image: &ImageView<'_, T>) -> Result<Scene<T>, Undecoded> {
        let picture = FlatPicture::of(image).ok_or(Undecoded::NotFlat)?;
        let shapes = self.shapes.as_ref().ok_or(Undecoded::Unexplained)?;
        let mut found = Vec::new();
        for color in (0..picture.colors.len()).filter(|&color| color != picture.ground) {
            explain(&picture, color, shapes, &mut found).ok_or(Undecoded::Unexplained)?;
        }
        let order = order::painting(&picture, &found, shapes).ok_or(Undecoded::Unexplained)?;
        let unit = f64::of_usize(picture.size.unit_px());
        let object = |&at: &usize| {
            let Found { color, posed, .. } = &found[at];
            let Pose { translation, scale, rotation } = posed.pose.in_scene(unit);
            let pose = Pose { translation: translation.map(T::of), scale: T::of(scale), rotation: T::of(rotation) };
            let efd = self.bank.prototypes[posed.prototype].1.clone();
            let color = picture.colors[*color].map(|v| T::of(f64::from(v)));
            Object::of_efd(pose, color, T::one(), efd, Some(posed.prototype))
        };
        Ok(Scene {
            background: picture.colors[picture.ground].map(|v| T::of(f64::from(v))),
            transparent: false,
            objects: order.iter().map(object).collect(),
            edge: EdgeProfile::hard(T::of(unit)),
            compositing: Compositing::Over,
        })
    }
}

/// The objects of a color: one, if one explains all its parts, else those of each part; none if something is left over.
fn explain(picture: &FlatPicture, color: usize, shapes: &Shapes, found: &mut Vec<Found>) -> Option<()> {
    let pixels = picture.pixels_of(color);
    let area = f64::of_usize(pixels.len());
    let demand = Demand::new(picture, &pixels);
    let whole = shapes.best(&demand).filter(|posed| explains(posed, area));
    if let Some(posed) = whole {
        found.push(Found { color, pixels, posed });
        return Some(());
    }
    for part in picture.parts_of(&pixels) {
        let area = f64::of_usize(part.len());
        let demand = Demand::new(picture, &part);
        match shapes.best(&demand).filter(|posed| explains(posed, area)) {
            Some(posed) => found.push(Found { color, pixels: part, posed }),
            None if part.len() < LEAST_PART_PX => return None,
            None => {
                let pieces = split(picture, &part, shapes)?;
                found.extend(pieces.into_iter().map(|(pixels, posed)| Found { color, pixels, posed }));
            }
        }
    }
    Some(())
}
