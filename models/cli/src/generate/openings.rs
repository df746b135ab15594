//! Random scenes like those of the suites of compositional scene representation whose shapes have openings.
//!
//! *Source*: `FudanVI/compositional-scene-representation-toolbox`: 64 x 64 pixels, two to four squares and triangles (some upside down)
//! with an opening of their own form, 1 to 1.5 times as large, at whole pixels, a quarter of each at least in view. Differences: outlines
//! with straight sides instead of scaled steps of pixels, covered shares of pixels instead of a filter, and colors, which the published
//! program leaves white: any, as long as no two of a picture are alike.

use dvp_core::render::{Compositing, EdgeProfile, TileRenderer, hard::HardMask};
use dvp_core::shape::{AnyShape, Polygon, REFERENCE_VERTICES};
use dvp_core::{ImageSize, Object, Pose, Scene};
use dvp_fit::paint::drawing_of;

use super::chance::{Chance, below, color, uniform};
use super::settings::Range;

/// Columns, and rows, of a picture.
pub const OPENINGS_SIDE: usize = 64;
/// Fewest and most objects of a picture.
const OBJECTS: [usize; 2] = [2, 4];
/// Scale of the shapes.
const SCALE: Range = Range::new(1.0, 1.5);
/// Share of every object that is in view.
const LEAST_VISIBLE: f32 = 0.25;
/// Draws of the place of an object before the picture is begun anew.
const TRIES: usize = 10;
/// Least distance of two colors of a picture, as of points of the unit cube.
const LEAST_CONTRAST: f32 = 0.3;

/// A ring of a shape, px at scale 1.
type Ring = &'static [[f32; 2]];

/// Square, triangle, triangle upside down: extent in px at scale 1, outer ring and opening.
const SHAPES: [([f32; 2], [Ring; 2]); 3] = [
    (
        [14.0, 14.0],
        [&[[0.0, 0.0], [14.0, 0.0], [14.0, 14.0], [0.0, 14.0]], &[[4.0, 4.0], [4.0, 10.0], [10.0, 10.0], [10.0, 4.0]]],
    ),
    (
        [28.0, 15.0],
        [
            &[[13.5, 0.0], [14.5, 0.0], [28.0, 13.5], [28.0, 15.0], [0.0, 15.0], [0.0, 13.5]],
            &[[13.5, 6.0], [8.5, 11.0], [19.5, 11.0], [14.5, 6.0]],
        ],
    ),
    (
        [28.0, 15.0],
        [
            &[[13.5, 15.0], [0.0, 1.5], [0.0, 0.0], [28.0, 0.0], [28.0, 1.5], [14.5, 15.0]],
            &[[13.5, 9.0], [14.5, 9.0], [19.5, 4.0], [8.5, 4.0]],
        ],
    ),
];

/// Scene number `index` of the data set `seed`, for pictures of [`OPENINGS_SIDE`] pixels, and the class of each of its objects: square,
/// triangle, triangle upside down.
#[must_use]
pub fn sample_openings(seed: u64, index: u64) -> (Scene<f32>, Vec<u32>) {
    let mut rng = Chance::new(seed, index);
    loop {
        if let Some(found) = draw(&mut rng) {
            return found;
        }
    }
}

fn draw(rng: &mut Chance) -> Option<(Scene<f32>, Vec<u32>)> {
    let size = ImageSize::new(OPENINGS_SIDE, OPENINGS_SIDE).ok()?;
    let mut scene = Scene {
        background: color(rng, Range::new(0.0, 1.0)),
        transparent: false,
        objects: Vec::new(),
        edge: EdgeProfile::area(),
        compositing: Compositing::Over,
    };
    let mut classes = Vec::new();
    for _ in 0..OBJECTS[0] + below(rng, OBJECTS[1] - OBJECTS[0] + 1) {
        let class = below(rng, SHAPES.len());
        let scale = uniform(rng, SCALE);
        let color = new_color(rng, &scene);
        let is_placed = (0..TRIES).any(|_| {
            scene.objects.push(object(rng, class, scale, color));
            let is_seen = all_are_seen(&scene, size);
            if !is_seen {
                scene.objects.pop();
            }
            is_seen
        });
        if !is_placed {
            return None;
        }
        classes.push(u32::try_from(class).unwrap_or(0));
    }
    Some((scene, classes))
}

/// A color far from those of the scene.
fn new_color(rng: &mut Chance, scene: &Scene<f32>) -> [f32; 3] {
    loop {
        let new = color(rng, Range::new(0.0, 1.0));
        let far = |other: [f32; 3]| (0..3).map(|c| (new[c] - other[c]).powi(2)).sum::<f32>() >= LEAST_CONTRAST.powi(2);
        if far(scene.background) && scene.objects.iter().all(|object| far(object.color())) {
            return new;
        }
    }
}

/// A shape with its box at a whole pixel inside the picture.
fn object(rng: &mut Chance, class: usize, scale: f32, color: [f32; 3]) -> Object<f32> {
    #[expect(clippy::cast_precision_loss, reason = "below 100")]
    let side = OPENINGS_SIDE as f32;
    let (extent, rings) = SHAPES[class];
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers from 0 to 64"
    )]
    let mut place = |extent: f32| {
        let room = (side - (extent * scale).ceil()) as usize + 1;
        (below(rng, room) as f32 + extent * scale / 2.0) / side
    };
    let translation = extent.map(&mut place);
    let corner = |corner: &[f32; 2]| [0, 1].map(|axis| (corner[axis] - extent[axis] / 2.0) / side);
    let rings = rings.map(|ring| ring.iter().map(corner).collect());
    Object {
        shape: AnyShape::Polygon(Polygon { rings: rings.into() }),
        pose: Pose { translation, scale, rotation: 0.0 },
        paint: color.into(),
        confidence: 1.0,
    }
}

/// Whether enough of every object is in view.
fn all_are_seen(scene: &Scene<f32>, size: ImageSize) -> bool {
    let Ok(drawing) = drawing_of(scene, size, REFERENCE_VERTICES) else { return false };
    let renderer = TileRenderer { coverage: HardMask, compositing: scene.compositing };
    let mut owners = vec![usize::MAX; size.pixels()];
    let mut areas = vec![0.0_f32; scene.objects.len()];
    let visited =
        renderer.visit_coverage(&drawing, size, &mut Default::default(), |object, pixel, coverage: &[f32]| {
            for (owner, _) in owners[pixel..].iter_mut().zip(coverage).filter(|(_, coverage)| **coverage >= 0.5) {
                *owner = object;
                areas[object] += 1.0;
            }
        });
    let mut seen = vec![0.0_f32; areas.len()];
    for &owner in &owners {
        if let Some(seen) = seen.get_mut(owner) {
            *seen += 1.0;
        }
    }
    visited.is_ok() && seen.iter().zip(&areas).all(|(seen, area)| *seen >= LEAST_VISIBLE * area)
}
