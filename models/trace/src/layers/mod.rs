//! Faces to layers: what is painted, from back to front, each whole where others hide it.
//!
//! | file | holds |
//! |---|---|
//! | `junction` | who lies in front where three faces meet |
//! | `edge_to_edge` | who lies beside whom |
//! | `order` | one order of all faces |
//! | `settle` | another order where that is shorter |
//! | `stack` | one depth for each color where that is shorter |
//! | `pen` | faces that a pen has drawn |
//! | `join` | faces of one color that are one thing behind another |
//! | `visible` | what of a boundary is a layer's own |
//! | `walk` | what of a boundary follows what hides it |
//! | `link` | which visible stretch goes on as which behind others |
//! | `sheet` | what reaches as far as the picture does |
//! | `complete` | outlines of what is painted together, in an order |
//! | `lead` | outlines through what is seen, led around what they must not hide |
//! | `repeat` | what is another thing again, elsewhere and in another size |
//! | `overlap` | things of one color that lie on one another |
//! | `frame` | the square that a pen has drawn and others hide in part |
//! | `template` | how an outline lies on what is seen of another thing |
//! | `swap` | who lies in front, once that is known |
//! | `memo` | outlines that were fitted before, and templates that were held against what is seen |
//! | `raster` | the check that an outline hides nothing |

mod complete;
mod edge_to_edge;
mod frame;
mod join;
mod junction;
mod lead;
mod link;
mod memo;
mod order;
mod overlap;
mod pen;
mod raster;
mod repeat;
mod settle;
mod sheet;
mod stack;
mod swap;
mod template;
mod visible;
mod walk;

use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;

use dvp_core::shape::Stroke;

use crate::boundary::Ring;
use crate::outline::Outline;
use crate::partition::{Color, OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::stroke::fit_thin;
use crate::tuning;
use complete::Completion;
use edge_to_edge::EdgeToEdge;
pub(crate) use memo::Memo;
use order::Order;
pub(crate) use raster::polygon;

/// What is painted at once.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its color.
    pub color: Color,
    /// Its form.
    pub form: Form,
    /// The faces that are seen of it; none of a line that was taken out before the picture was cut into faces.
    pub faces: Vec<u32>,
    /// Which of the heaps of the picture, things of one color that have run together, it lies in, if it lies in one.
    pub heap: Option<usize>,
    /// Description length of the form, and of what it misses, bits.
    pub bits: f64,
}

/// What a layer covers, in pixels.
#[derive(Clone, Debug)]
pub enum Form {
    /// Outlines, which fill by the even-odd rule.
    Filled(Vec<Outline>),
    /// What a pen covers along lines.
    Stroked(Stroke<f64>),
}

/// A picture as layers over a background.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Color behind everything.
    pub background: Color,
    /// From back to front.
    pub layers: Vec<Layer>,
}

impl Layers {
    /// Description length of the forms, and of what they miss, bits.
    #[must_use]
    pub fn bits(&self) -> f64 {
        self.layers.iter().map(|layer| layer.bits).sum()
    }

    /// The same with what each of the things costs beside its form.
    #[must_use]
    pub fn bits_of_things(&self) -> f64 {
        // What one heap is cut into are things that no reading has to find.
        let mut heaps: Vec<usize> = self.layers.iter().filter_map(|layer| layer.heap).collect();
        let alone = self.layers.len() - heaps.len();
        heaps.dedup();
        self.bits() + tuning::THING_BITS * (alone + heaps.len()) as f64
    }
}

/// The layers of a reading of a picture. `matte`: the color of what shows nothing, if the picture has such; `memo`: outlines of other readings of it.
#[must_use]
pub(crate) fn layers(partition: &Partition, rings: &[Vec<Ring>], matte: Option<Color>, memo: &Memo) -> Layers {
    let ruler = Ruler { extent: partition.size[0].max(partition.size[1]) as f64 };
    let background = background(partition, rings, matte.map(|matte| partition.as_palette(matte)));
    memo.search();
    let mut pens = pen::find(partition, rings, background, &ruler, memo);
    let edge_to_edge = EdgeToEdge::of(partition, rings);
    let order = Order::of(partition, rings, background, matte.is_some(), &mut pens, &edge_to_edge.votes);
    let rank = order.rank.clone();
    let mut completion = Completion {
        partition,
        rings,
        rank,
        pens,
        neighbors: complete::neighbors(rings),
        seamed: edge_to_edge.pairs,
        order: &order,
        background,
        is_clear: matte.is_some(),
        ruler,
        united: Vec::new(),
        is_searching: false,
        wanted_samples: tuning::MOST_TRIED * rings.iter().flatten().map(|ring| ring.steps.len()).sum::<usize>(),
        known: RefCell::default(),
        memo,
    };
    settle::settle(&mut completion);
    let mut layers = Vec::new();
    let mut groups = join::painted(&mut completion);
    repeat::repeat(&mut completion, &mut groups);
    overlap::part(&completion, &mut groups);
    for (heap, join::Group { faces: group, completed }) in groups.into_iter().enumerate() {
        let color = partition.rgb(partition.color(group[0]));
        match completion.pen(&group) {
            Some(pen) => {
                let bits = (pen.bits + pen.misfit) / pen.strokes.len().max(1) as f64;
                layers.extend(pen.strokes.iter().map(|stroke| Layer {
                    color,
                    form: Form::Stroked(stroke.clone()),
                    faces: group.clone(),
                    heap: None,
                    bits,
                }));
            }
            None if completed.are_things => layers.extend(completed.outlines.iter().map(|outline| Layer {
                color,
                form: Form::Filled(vec![outline.clone()]),
                faces: group.clone(),
                heap: Some(heap),
                bits: outline.bits + outline.misfit,
            })),
            None => {
                let outlines = completed.outlines.clone();
                let bits = outlines.iter().map(|outline| outline.bits + outline.misfit).sum();
                layers.push(Layer { color, form: Form::Filled(outlines), faces: group, heap: None, bits });
            }
        }
    }
    // Thin lines were taken out of what they lie on.
    let lines = partition.lines.iter().filter(|line| !partition.is_gap(line));
    let lines = lines.filter_map(|line| Some((line.color, fit_thin(&line.chain, &ruler)?)));
    layers.extend(lines.map(|(color, (stroke, misfit))| {
        let points: usize = stroke.rings.iter().map(|ring| ring.points.len()).sum();
        // Where it passes and how wide it is can be seen, where it ends less so.
        let bits = (2 * points - 1) as f64 * ruler.number(tuning::THIN_SIGMA) + 2.0 * ruler.number(tuning::CRACK_SIGMA);
        Layer {
            color: partition.rgb(color),
            form: Form::Stroked(stroke),
            faces: Vec::new(),
            heap: None,
            bits: bits + misfit,
        }
    }));
    Layers { background: partition.rgb(partition.color(background)), layers }
}

/// The face that everything lies on: that of the matte, or what alone lies along the border, or else the largest, where what lies along the
/// border counts more.
fn background(partition: &Partition, rings: &[Vec<Ring>], matte: Option<Color>) -> u32 {
    let contact = |face: &u32| -> usize {
        rings[*face as usize].iter().flat_map(|ring| &ring.steps).filter(|step| step.other == OUTSIDE).count()
    };
    // What reaches beyond the picture on many sides counts for more than it shows.
    let key = |face: &u32| partition.faces[*face as usize].area + tuning::BORDER_WEIGHT * contact(face);
    let faces = 0..partition.faces.len() as u32;
    let clear = matte.and_then(|matte| {
        let is_clear = |face: &u32| {
            let color = partition.color(*face);
            (0..3).all(|c| (color[c] - matte[c]).abs() <= partition.mix_noise)
        };
        faces.clone().filter(is_clear).max_by_key(key)
    });
    let mut at_border = faces.clone().filter(|face| contact(face) > 0);
    let alone = at_border.next().filter(|_| at_border.next().is_none());
    clear.or(alone).or_else(|| faces.max_by_key(key)).unwrap_or(0)
}
