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
//! | `doubt` | posed objects | what pixels leave open |
//!
//! Proved by `tests` beside it, and by `tests/report/suites.md`.

mod demand;
mod doubt;
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
use self::search::{Effort, Posed, Shapes};
use self::split::{explains, split};
use crate::pose::gauss_newton::PosePx;
use crate::{Ambiguity, Bank};

/// Objects of fewer pixels tell little of a shape.
const LEAST_WHOLE_PX: f64 = 60.0;
/// Share of the pixels of an object that may be wrong where it is to make its shape better, or where nothing explains it better.
const ABOUT: f64 = 0.12;
/// So many more pixels may be wrong with one object as with two.
const MORE_WRONG_PX: usize = 8;
/// How much sharper the edges of scenes are than those of drawings: no pixel lies so near to an outline that it is mixed.
const SHARPER: f64 = 1e3;

/// A bank made ready to find its shapes in pictures of few colors.
#[derive(Clone, Debug)]
pub struct Decoder<T> {
    bank: Bank<T>,
    shapes: Option<Shapes>,
}

/// What a picture of few colors shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded<T> {
    /// Its objects, all of shapes of the bank.
    pub scene: Scene<T>,
    /// What pixels leave open of them.
    pub ambiguity: Vec<Ambiguity>,
}

/// Why there is no scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undecoded {
    /// Pixels have more than a few colors: they are mixed, or noisy, or those of no drawing.
    NotFlat,
    /// Something in the picture is none of the shapes, or hides in a way that no order of painting brings about.
    Unexplained,
}

/// An object that is seen whole.
#[derive(Clone, Debug)]
pub struct WholeObject {
    /// Its shape.
    pub prototype: usize,
    /// Where it is.
    pub(super) pose: PosePx<f64>,
    /// Pixels that show it.
    pub pixels: usize,
    /// Pixels that the shape covers and should not, or the other way round.
    pub wrong: usize,
    /// The middles (px) of pixels on either side of its outline, and whether they are inside.
    pub(super) sides: Vec<([f64; 2], bool)>,
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
    pub fn decode(&self, image: &ImageView<'_, T>) -> Result<Decoded<T>, Undecoded> {
        let picture = FlatPicture::of(image).ok_or(Undecoded::NotFlat)?;
        let shapes = self.shapes.as_ref().ok_or(Undecoded::Unexplained)?;
        let mut found = Vec::new();
        for color in (0..picture.colors.len()).filter(|&color| color != picture.ground) {
            explain(&picture, color, shapes, &mut found).ok_or(Undecoded::Unexplained)?;
        }
        let order = order::painting(&picture, &found, shapes).ok_or(Undecoded::Unexplained)?;
        settle(&picture, &mut found, &order, shapes);
        let unit = f64::of_usize(picture.size.unit_px());
        let object = |&at: &usize| {
            let Found { color, posed, .. } = &found[at];
            let Pose { translation, scale, rotation } = posed.pose.in_scene(unit);
            let pose = Pose { translation: translation.map(T::of), scale: T::of(scale), rotation: T::of(rotation) };
            let efd = self.bank.prototypes[posed.prototype].1.clone();
            let color = picture.colors[*color].map(|v| T::of(f64::from(v)));
            Object::of_efd(pose, color, T::one(), efd, Some(posed.prototype))
        };
        let scene = Scene {
            background: picture.colors[picture.ground].map(|v| T::of(f64::from(v))),
            transparent: false,
            objects: order.iter().map(object).collect(),
            edge: EdgeProfile::hard(T::of(unit * SHARPER)),
            compositing: Compositing::Over,
        };
        Ok(Decoded { scene, ambiguity: doubt::doubts(&picture, &found, &order, shapes) })
    }
}

/// The objects of a color: one for all its parts, or those of each part; none if something is left over.
fn explain(picture: &FlatPicture, color: usize, shapes: &Shapes, found: &mut Vec<Found>) -> Option<()> {
    let pixels = picture.pixels_of(color);
    if pixels.is_empty() {
        return Some(());
    }
    let best = |pixels: &[usize], effort| shapes.best(&Demand::new(picture, pixels), effort);
    let area = f64::of_usize(pixels.len());
    let parts = picture.parts_of(&pixels);
    if let [part] = &parts[..] {
        return explain_part(picture, color, part, shapes, found);
    }
    let mut whole = best(&pixels, Effort::Usual);
    if !whole.is_some_and(|posed| explains(&posed, area)) {
        // Either one object, of which something hides a piece between, or several: whichever leaves less wrong.
        let mut apart = Vec::new();
        let is_explained =
            parts.iter().try_for_each(|part| explain_part(picture, color, part, shapes, &mut apart)).is_some();
        let wrong: usize = apart.iter().map(|found| found.posed.verdict.wrong).sum();
        let limit = wrong + MORE_WRONG_PX * (apart.len().max(1) - 1);
        let joins = |posed: &Posed| if is_explained { posed.verdict.wrong <= limit } else { roughly(posed, area) };
        let wrong = |posed: &Posed| posed.verdict.wrong;
        whole = whole.into_iter().chain(best(&pixels, Effort::Wide)).filter(joins).min_by_key(wrong);
        if whole.is_none() {
            is_explained.then_some(())?;
            found.extend(apart);
            return Some(());
        }
    }
    found.extend(whole.map(|posed| Found { color, pixels, posed }));
    Some(())
}

/// The objects of pixels that hang together: one, or several that have run together.
fn explain_part(
    picture: &FlatPicture,
    color: usize,
    part: &[usize],
    shapes: &Shapes,
    found: &mut Vec<Found>,
) -> Option<()> {
    let area = f64::of_usize(part.len());
    let demand = Demand::new(picture, part);
    let mut posed = shapes.best(&demand, Effort::Usual)?;
    if !explains(&posed, area) {
        // What may be hidden in part is rather one object that was missed.
        let wide = || shapes.best(&demand, Effort::Wide);
        let missed = if demand.is_open() { wide() } else { None };
        if !missed.is_some_and(|posed| explains(&posed, area))
            && let Some(pieces) = split(picture, part, shapes)
        {
            found.extend(pieces.into_iter().map(|(pixels, posed)| Found { color, pixels, posed }));
            return Some(());
        }
        posed = missed.or_else(wide).filter(|posed| roughly(posed, area))?;
    }
    found.push(Found { color, pixels: part.to_vec(), posed });
    Some(())
}

/// Whether a pose explains most of its pixels.
fn roughly(posed: &Posed, area: f64) -> bool {
    f64::of_usize(posed.verdict.wrong) <= (ABOUT * area).max(1.0)
}

/// Poses once more, now that it is known what lies behind each object: it must not be covered.
fn settle(picture: &FlatPicture, found: &mut [Found], order: &[usize], shapes: &Shapes) {
    for (rank, &at) in order.iter().enumerate() {
        let behind: Vec<usize> = order[..rank].iter().flat_map(|&other| found[other].pixels.clone()).collect();
        let Found { pixels, posed, .. } = &found[at];
        let demand = Demand::beside(picture, pixels, behind.into_iter());
        let settled = shapes.settled(*posed, &demand);
        found[at].posed = settled;
    }
}

impl<T: Real> Decoder<T> {
    /// The objects of a picture that are seen whole, beside nothing but ground, as well as the bank explains them: to make it better.
    #[must_use]
    #[inline(never)]
    pub fn whole_objects(&self, image: &ImageView<'_, T>) -> Vec<WholeObject> {
        let (Some(picture), Some(shapes)) = (FlatPicture::of(image), self.shapes.as_ref()) else { return Vec::new() };
        let mut found = Vec::new();
        for color in (0..picture.colors.len()).filter(|&color| color != picture.ground) {
            for part in picture.parts_of(&picture.pixels_of(color)) {
                let demand = Demand::new(&picture, &part);
                if demand.is_open() || demand.area < LEAST_WHOLE_PX {
                    continue;
                }
                let Some(posed) = shapes.best(&demand, Effort::Usual) else { continue };
                let wrong = posed.verdict.wrong;
                if f64::of_usize(wrong) <= ABOUT * demand.area {
                    let Posed { prototype, pose, .. } = posed;
                    let sides = picture.sides_of(&part);
                    found.push(WholeObject { prototype, pose, pixels: part.len(), wrong, sides });
                }
            }
        }
        found
    }
}
