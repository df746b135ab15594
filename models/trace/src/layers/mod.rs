//! Faces to layers: what is painted, from back to front, each whole where others hide it.
//!
//! `junction` reads who lies in front where three faces meet, `order` makes one order of it, `visible` takes from a boundary what
//! is a layer's own, `raster` checks that a completed outline hides nothing.

mod junction;
mod order;
mod raster;
mod visible;

use alloc::vec::Vec;

use dvp_core::shape::{FillRule, Outline as Polygons, Path, Shape as _};

use crate::boundary::{Ring, Step};
use crate::outline::{Outline, fit_closed};
use crate::partition::{Color, OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use order::Order;

/// What is painted at once.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its color.
    pub color: Color,
    /// Its outlines, which fill by the even-odd rule.
    pub outlines: Vec<Outline>,
}

/// A picture as layers over a background.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Color behind everything.
    pub background: Color,
    /// From back to front.
    pub layers: Vec<Layer>,
}

/// The layers of a picture. `background`: the color of what shows nothing, if the picture has such.
#[must_use]
pub fn layers(partition: &Partition, rings: &[Vec<Ring>], matte: Option<Color>) -> Layers {
    let background = background(partition, rings, matte);
    let order = Order::of(partition, rings, background, matte.is_some());
    let ruler = Ruler { extent: partition.size[0].max(partition.size[1]) as f64 };
    let back = partition.faces[background as usize].color;
    let mut layers = Vec::new();
    for &face in &order.faces[1..] {
        let rank = order.rank[face as usize];
        let of_face = &rings[face as usize];
        let is_behind_all = of_face.iter().flat_map(|ring| &ring.steps).all(|step| {
            step.other == OUTSIDE || order.rank[step.other as usize] > rank || partition.faces[step.other as usize].color == back
        });
        if partition.faces[face as usize].color == back && is_behind_all {
            continue;
        }
        let is_hidden = |step: &Step| step.other == OUTSIDE || order.rank[step.other as usize] > rank;
        let outlines = outlines(partition, of_face, face, is_hidden, &ruler, |label| {
            if label == face {
                Some(true)
            } else if order.rank[label as usize] > rank {
                None
            } else {
                Some(false)
            }
        });
        if !outlines.is_empty() {
            layers.push(Layer { color: partition.color(face), outlines });
        }
    }
    Layers { background: partition.palette[back], layers }
}

/// The outlines of a face: those of its own boundary, completed where it is hidden, or else all around what is seen.
fn outlines(
    partition: &Partition,
    rings: &[Ring],
    face: u32,
    is_hidden: impl Fn(&Step) -> bool,
    ruler: &Ruler,
    wanted: impl Fn(u32) -> Option<bool>,
) -> Vec<Outline> {
    let mut whole = Vec::new();
    for (k, ring) in rings.iter().enumerate() {
        let own = ring.steps.iter().filter(|step| !is_hidden(step)).count();
        if k > 0 && own == 0 {
            continue;
        }
        let samples = visible::samples(ring, if own == 0 { &(|_: &Step| false) as &dyn Fn(&Step) -> bool } else { &is_hidden });
        whole.extend(fit_closed(&samples, ruler));
    }
    let is_good = |outlines: &[Outline]| {
        let polygons: Vec<Vec<[f64; 2]>> = outlines.iter().filter_map(|outline| polygon(outline)).collect();
        if polygons.is_empty() {
            return false;
        }
        let wrong = raster::compare(partition, &polygons, |i| wanted(partition.labels[i]));
        (wrong.bare + wrong.hidden) as f64 <= crate::tuning::MOST_WRONG * partition.faces[face as usize].area as f64
    };
    if is_good(&whole) {
        return whole;
    }
    let seen: Vec<Outline> =
        rings.iter().filter_map(|ring| fit_closed(&visible::samples(ring, |_| false), ruler)).collect();
    if is_good(&seen) {
        return seen;
    }
    rings.iter().map(|ring| traced(&visible::samples(ring, |_| false), ring, ruler)).collect()
}

/// The last resort: the polygon through the samples themselves.
fn traced(samples: &RingSamples, ring: &Ring, ruler: &Ruler) -> Outline {
    let mut points: Vec<[f64; 2]> = samples.runs.iter().flatten().map(|sample| sample.point.to_array()).collect();
    if points.len() < 3 {
        points = ring.steps.iter().map(|step| step.crack.start.map(|value| value as f64)).collect();
    }
    Outline::polygon(points, ruler)
}

/// The polygon of an outline.
fn polygon(outline: &Outline) -> Option<Vec<[f64; 2]>> {
    let path = Path { rings: alloc::vec![outline.path_ring()], fill: FillRule::EvenOdd };
    let mut polygons = Polygons::default();
    path.boundary().ok()?.flatten(0.1, &mut polygons).ok()?;
    (polygons.vertices.len() > 2).then_some(polygons.vertices)
}

/// The face that everything lies on: that of the matte, or else the one along most of the border.
fn background(partition: &Partition, rings: &[Vec<Ring>], matte: Option<Color>) -> u32 {
    let contact = |face: &u32| -> usize {
        rings[*face as usize].iter().flat_map(|ring| &ring.steps).filter(|step| step.other == OUTSIDE).count()
    };
    let key = |face: &u32| (contact(face), partition.faces[*face as usize].area);
    let faces = 0..partition.faces.len() as u32;
    let clear = matte.and_then(|matte| {
        let is_clear = |face: &u32| {
            let color = partition.color(*face);
            (0..3).all(|c| (color[c] - matte[c]).abs() <= partition.mix_noise)
        };
        faces.clone().filter(is_clear).max_by_key(key)
    });
    clear.or_else(|| faces.max_by_key(key)).unwrap_or(0)
}
