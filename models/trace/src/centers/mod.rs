//! Outlines in pictures without a mixed pixel, moved until they have the middle of every pixel on the right side.
//!
//! In: layers and the faces of a picture with hard edges. Out: the same layers. Windows say of such an edge no more than that it passes between the
//! middles of two pixels, and outlines that are the best through windows pass some of them on the wrong side. That a pixel is inside or outside is no
//! measurement with a deviation but a fact: to deny it costs the color of that pixel. Numbers move as little as the facts ask for; an outline that
//! cannot meet them gets another piece where a piece is cheaper than what is wrong.
//!
//! `numbers` takes outlines apart and puts them together, `rows` tells how far they are from pixels, `slopes` finds the change that they ask for.

mod numbers;
mod rows;
mod slopes;

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::layers::{Form, Layers};
use crate::outline::{Outline, OutlineShape};
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::tuning;
use numbers::{Curves, curves, cut, distance, numbers, polygon, with_numbers};
use rows::{Place, Rows};
use slopes::{Depth, Slopes};

/// How far outlines are held from the middles of pixels, pixels; and, where that cannot be, once more.
const MARGINS: [f64; 2] = [0.04, 0.01];
/// Nearer ones count as on the wrong side, pixels: polygons are off by less.
const SURE: f64 = 0.006;
/// Steps of an outline.
const STEPS: usize = 12;
/// Middles of pixels that are nearer to an outline, pixels, may be missed by a step.
const NEAR: f64 = 1.0;
/// Share of what is missed that is missed still after a step that leads nowhere.
const LEAST_GAIN: f64 = 0.95;
/// Weight of the changes of numbers from which on no step is shorter.
const MOST_DAMPING: f64 = 1e5;
/// Pieces that an outline may get without being better.
const MOST_IDLE: usize = 3;
/// Pixels on either side of a boundary whose middles are looked at.
const REACH: usize = 1;
/// Step of differences, pixels.
const STEP: f64 = 1e-4;
/// What a pixel on the wrong side costs, bits, beside its place: its color is told.
const WRONG_BITS: f64 = 24.0;

/// Moves the outlines of layers so that the middle of every pixel shows the layer that it shows in the picture, where that can be.
pub fn meet(layers: &mut Layers, partition: &Partition) {
    let ruler = Ruler { extent: partition.size[0].max(partition.size[1]) as f64 };
    // The layer of each face, counted from 1; 0 for what shows the background.
    let mut owners = vec![0; partition.faces.len()];
    for (layer, number) in layers.layers.iter().zip(1..) {
        layer.faces.iter().for_each(|&face| owners[face as usize] = number);
    }
    for (layer, number) in layers.layers.iter_mut().zip(1..) {
        let Form::Filled(outlines) = &mut layer.form else { continue };
        if layer.faces.is_empty() {
            continue;
        }
        let facts = Facts::of(partition, &owners, number, &layer.faces, outlines);
        layer.bits += facts.meet(outlines, &ruler);
    }
}

/// The middle of a pixel, and whether a layer covers it.
#[derive(Clone, Copy, Debug)]
struct Fact {
    at: Vec2<f64>,
    is_inside: bool,
}

/// What is known of the pixels along the boundary of a layer, row by row.
struct Facts(Vec<Fact>);

impl Facts {
    /// Of the layer `number`, which `faces` are seen of: its own pixels are inside, those of what lies behind outside; what lies in front hides it.
    fn of(partition: &Partition, owners: &[usize], number: usize, faces: &[u32], outlines: &[Outline]) -> Self {
        let [width, height] = partition.size;
        let mut bounds = [usize::MAX, usize::MAX, 0, 0];
        for face in faces.iter().map(|&face| &partition.faces[face as usize]) {
            let [left, top, right, bottom] = face.bounds;
            bounds = [bounds[0].min(left), bounds[1].min(top), bounds[2].max(right), bounds[3].max(bottom)];
        }
        // Behind what hides it an outline may go anywhere, but must not come out beyond.
        for point in outlines.iter().flat_map(|outline| polygon(&outline.shape)) {
            let [x, y] = point.to_array().map(|at| at.max(0.0) as usize);
            bounds = [bounds[0].min(x), bounds[1].min(y), bounds[2].max(x + 1), bounds[3].max(y + 1)];
        }
        let known = |x: usize, y: usize| -> Option<bool> {
            let face = partition.face_at([x, y]);
            let owner = *owners.get(face as usize).filter(|_| face != OUTSIDE)?;
            (owner <= number).then_some(owner == number)
        };
        let mut facts = Vec::new();
        for y in bounds[1].saturating_sub(REACH)..(bounds[3] + REACH).min(height) {
            // Whether all around the last pixel are as it is.
            let mut is_one = false;
            for x in bounds[0].saturating_sub(REACH)..(bounds[2] + REACH).min(width) {
                let Some(is_inside) = known(x, y) else {
                    is_one = false;
                    continue;
                };
                // Beyond the border nothing is known.
                let around = |at: usize, first: usize| (first..=2 * REACH).map(move |k| (at + k).wrapping_sub(REACH));
                // Of what is around the pixel before only the last column is new.
                let mut columns = around(x, if is_one { 2 * REACH } else { 0 });
                is_one = columns.all(|u| around(y, 0).all(|v| known(u, v) == Some(is_inside)));
                if !is_one {
                    facts.push(Fact { at: Vec2::new(x as f64 + 0.5, y as f64 + 0.5), is_inside });
                }
            }
        }
        Self(facts)
    }

    /// Moves outlines to where all facts are met, or fewer are not; the bits that new pieces cost.
    fn meet(&self, outlines: &mut [Outline], ruler: &Ruler) -> f64 {
        let mut found: Vec<OutlineShape> = outlines.iter().map(|outline| outline.shape.clone()).collect();
        let mut state = self.state(&found);
        if state.wrong == 0 {
            return 0.0;
        }
        self.approach(&mut found, &mut state);
        let wrong_bits = WRONG_BITS + 2.0 * ruler.extent.max(1.0).log2();
        // Bits of new pieces, in the best outlines and in those at hand.
        let (mut bits, mut spent) = (0.0, 0.0);
        let (mut trial, mut then) = (found.clone(), state.clone());
        let mut idle = 0;
        while then.wrong > 0 && idle < MOST_IDLE {
            let Some((ring, piece)) = self.worst(&trial, &then) else { break };
            let whole = trial[ring].ring();
            let before = numbers(&trial[ring]).len();
            trial[ring] = OutlineShape::Path(cut(&whole, piece));
            let more = numbers(&trial[ring]).len().saturating_sub(before) as f64;
            spent += more * ruler.number(tuning::CRACK_SIGMA) + tuning::OUTLINE_PIECE_BITS;
            if spent > bits + state.wrong as f64 * wrong_bits {
                break;
            }
            then = self.state(&trial);
            self.approach(&mut trial, &mut then);
            idle += 1;
            if spent + then.wrong as f64 * wrong_bits < bits + state.wrong as f64 * wrong_bits {
                (found, state, bits, idle) = (trial.clone(), then.clone(), spent, 0);
            }
        }
        for (outline, shape) in outlines.iter_mut().zip(found) {
            if outline.shape != shape {
                outline.shape = shape;
            }
        }
        bits
    }

    /// How outlines stand to the facts.
    fn state(&self, shapes: &[OutlineShape]) -> State {
        let curves: Vec<Curves> = shapes.iter().map(curves).collect();
        let rows = Rows::of(&curves, self.rows());
        let depth = |fact: &Fact| if fact.is_inside { -rows.depth(fact.at) } else { rows.depth(fact.at) };
        let depths: Vec<f64> = self.0.iter().map(depth).collect();
        State { wrong: depths.iter().filter(|&&depth| depth < SURE).count(), depths }
    }

    /// The rows of pixels that they are about.
    fn rows(&self) -> Range<usize> {
        let [first, last] = [self.0.first(), self.0.last()].map(|fact| fact.map_or(0, |fact| fact.at.y as usize));
        first..last + 1
    }

    /// Moves the numbers of outlines toward where all facts are met, as little as that takes.
    fn approach(&self, shapes: &mut Vec<OutlineShape>, state: &mut State) {
        for margin in MARGINS {
            if state.wrong > 0 {
                self.keep(shapes, state, margin);
            }
        }
    }

    /// The same with outlines that are held so far from what they must not cover or miss, pixels.
    fn keep(&self, shapes: &mut Vec<OutlineShape>, state: &mut State, margin: f64) {
        let (mut now, mut then) = (shapes.clone(), state.clone());
        let mut damping = 1.0;
        let mut slopes = self.slopes(&now, &then);
        for _ in 0..STEPS {
            let Some(change) = slopes.change(damping, margin) else { break };
            let mut at = 0;
            let moved: Vec<OutlineShape> = now
                .iter()
                .map(|shape| {
                    let numbers: Vec<f64> = numbers(shape)
                        .iter()
                        .zip(&change[at..])
                        .map(|(number, change)| number.value + change)
                        .collect();
                    at += numbers.len();
                    with_numbers(shape, &numbers)
                })
                .collect();
            let next = self.state(&moved);
            let [strain, before] = [&next, &then].map(|state| state.strain(margin));
            if strain < before {
                let is_idle = strain > LEAST_GAIN * before;
                (now, then, damping) = (moved, next, damping * 0.2);
                if (then.wrong, strain) < (state.wrong, state.strain(margin)) {
                    shapes.clone_from(&now);
                    state.clone_from(&then);
                }
                if then.wrong == 0 || is_idle {
                    break;
                }
                slopes = self.slopes(&now, &then);
            } else if damping > MOST_DAMPING {
                break;
            } else {
                damping *= 10.0;
            }
        }
    }

    /// How the depths of what is near change with the numbers of outlines.
    fn slopes(&self, shapes: &[OutlineShape], state: &State) -> Slopes {
        let curves: Vec<Curves> = shapes.iter().map(curves).collect();
        let rows = Rows::of(&curves, self.rows());
        let mut depths = Vec::new();
        // Of each curve, the middles that it is the nearest to, with the line of it: only what moves that curve moves it nearer or farther.
        let none = |curves: &Curves| vec![Vec::<(usize, usize, Vec2<f64>)>::new(); curves.len()];
        let mut nearest: Vec<_> = curves.iter().map(none).collect();
        for (fact, &value) in self.0.iter().zip(&state.depths).filter(|&(_, &depth)| depth < NEAR) {
            let Place { ring, curve, line } = rows.nearest(fact.at);
            nearest[ring][curve].push((depths.len(), line, fact.at));
            depths.push(Depth { value, slopes: Vec::new() });
        }
        let mut levers = Vec::new();
        for ((shape, curves), nearest) in shapes.iter().zip(&curves).zip(&nearest) {
            let with_levers = numbers(shape);
            let mut moved: Vec<f64> = with_levers.iter().map(|number| number.value).collect();
            for (j, number) in with_levers.iter().enumerate() {
                let step = STEP / number.lever.max(1e-3);
                moved[j] = number.value + step;
                let with_step = with_numbers(shape, &moved);
                moved[j] = number.value;
                let [one, other] = number.curves;
                for &curve in if one == other { &number.curves[..1] } else { &number.curves } {
                    let moved = numbers::curve(&with_step, curve);
                    // The line that is nearest stays so, unless there is one more of them.
                    let is_same = moved.len() == curves[curve].len();
                    for &(k, line, at) in &nearest[curve] {
                        let near = moved.get(line..line + 2).filter(|_| is_same).unwrap_or(&moved);
                        let Depth { value, slopes } = &mut depths[k];
                        slopes.push((levers.len(), (value.signum() * distance(near, at) - *value) / step));
                    }
                }
                levers.push(number.lever);
            }
        }
        Slopes { levers, depths }
    }

    /// The outline, and the curve of it, that most of what is wrong lies beside.
    fn worst(&self, shapes: &[OutlineShape], state: &State) -> Option<(usize, usize)> {
        let curves: Vec<Curves> = shapes.iter().map(|shape| curves(&OutlineShape::Path(shape.ring()))).collect();
        let rows = Rows::of(&curves, self.rows());
        let mut strains: Vec<(f64, (usize, usize))> = Vec::new();
        for (fact, depth) in self.0.iter().zip(&state.depths).filter(|&(_, &depth)| depth < SURE) {
            let Place { ring, curve, .. } = rows.nearest(fact.at);
            let nearest = (ring, curve);
            match strains.iter_mut().find(|(_, place)| *place == nearest) {
                Some((strain, _)) => *strain += MARGINS[0] - depth,
                None => strains.push((MARGINS[0] - depth, nearest)),
            }
        }
        strains.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
    }
}

/// How outlines stand to facts.
#[derive(Clone, Debug)]
struct State {
    /// Pixels on the wrong side.
    wrong: usize,
    /// Of each fact: how far the outline is from it, pixels, negative on the wrong side.
    depths: Vec<f64>,
}

impl State {
    /// Sum of the squares of what outlines are too near to the middles of pixels by, or beyond.
    fn strain(&self, margin: f64) -> f64 {
        self.depths.iter().map(|depth| (margin - depth).max(0.0).powi(2)).sum()
    }
}
