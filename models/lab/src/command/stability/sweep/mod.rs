//! The difficulties, one at a time: each a list of levels from easy to hard, and a picture for every level and seed.
//!
//! | file | difficulties |
//! |---|---|
//! | `base` | the scenes that are made difficult |
//! | `start` | starts that are displaced, turned, too small, too large |
//! | `overlap` | twins of one color, one object in front of another |
//! | `crop` | objects that leave the picture |
//! | `contrast` | faint objects; faint ones in float pixels for the precision of numbers |
//! | `spoil` | noise, JPEG, blur |
//! | `extent` | small objects, many objects, small and large pictures |
//! | `edge` | softness and offset of the edge profile |
//! | `degenerate` | outlines that cross themselves, vertices on top of one another |
//!
//! All levels of a difficulty have the same scenes, so that they differ in nothing else.

mod base;
mod contrast;
mod crop;
mod degenerate;
mod edge;
mod extent;
mod overlap;
mod spoil;
mod start;
#[cfg(test)]
mod tests;

use anyhow::Result;
use dvp_core::{Image, Scene};

/// A picture and its truth.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) image: Image<f32>,
    pub(super) truth: Scene<f32>,
    /// What methods start from that need a start; none: the truth, perturbed.
    pub(super) start: Option<Scene<f32>>,
}

/// Who is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Who {
    /// All methods.
    All,
    /// Those that go on from a start.
    Starts,
    /// Those that know both precisions, in both.
    Precisions,
}

/// One difficulty.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    /// As options and files have it.
    pub(super) name: &'static str,
    /// Above its chart.
    pub(super) title: &'static str,
    /// What the levels are, with their unit.
    pub(super) axis: &'static str,
    /// From easy to hard.
    pub(super) levels: &'static [f64],
    pub(super) who: Who,
    /// Pictures per level are divided by this: some levels are large.
    pub(super) thinned: u64,
    /// The picture of a level and a seed.
    pub(super) make: fn(f64, u64) -> Result<Case>,
}

impl Sweep {
    /// Indices of the levels, of a quick run every second one, the first and the last among them.
    pub(super) fn chosen(&self, quick: bool) -> Vec<usize> {
        let last = self.levels.len() - 1;
        (0..=last).filter(|k| !quick || k.is_multiple_of(2) || *k == last).collect()
    }
}

const fn sweep(
    name: &'static str,
    title: &'static str,
    axis: &'static str,
    levels: &'static [f64],
    make: fn(f64, u64) -> Result<Case>,
) -> Sweep {
    Sweep { name, title, axis, levels, who: Who::All, thinned: 1, make }
}

const fn of_starts(sweep: Sweep) -> Sweep {
    Sweep { who: Who::Starts, ..sweep }
}

/// All difficulties.
pub(super) const SWEEPS: &[Sweep] = &[
    of_starts(sweep(
        "displacement",
        "Start displaced",
        "displacement of every object, px of 128",
        &[0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0],
        start::displaced,
    )),
    of_starts(sweep(
        "rotation",
        "Start turned (hearts)",
        "rotation error of every object, degrees",
        &[0.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 135.0, 180.0],
        start::turned,
    )),
    of_starts(sweep(
        "start-small",
        "Start too small",
        "scale of the start over the true one",
        &[1.0, 0.7, 0.5, 0.25, 0.1, 0.01, 1e-4, 1e-8, 0.0],
        start::scaled,
    )),
    of_starts(sweep(
        "start-large",
        "Start too large",
        "scale of the start over the true one",
        &[1.0, 1.4, 2.0, 3.0, 4.0, 8.0],
        start::scaled,
    )),
    sweep(
        "twins",
        "Twins of one color",
        "distance of the centers, scale 0.1",
        &[0.3, 0.2, 0.15, 0.1, 0.075, 0.05, 0.03],
        overlap::twins,
    ),
    sweep(
        "occlusion",
        "Occlusion (over)",
        "share of the rear object that is hidden",
        &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
        overlap::occluded,
    ),
    sweep(
        "crop",
        "Objects cropped by the border",
        "share of the object outside the picture",
        &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
        crop::cropped,
    ),
    sweep(
        "contrast",
        "Contrast",
        "largest channel difference to the background, steps of 1/255",
        &[255.0, 128.0, 64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0],
        contrast::faint,
    ),
    sweep(
        "object-size",
        "Small objects",
        "diameter of the outline, px (edges add 2.9 px)",
        &[32.0, 16.0, 8.0, 6.0, 4.0, 3.0, 2.0, 1.0, 0.5],
        extent::small_objects,
    ),
    sweep(
        "count",
        "Number of objects",
        "objects in 256 x 256 px",
        &[1.0, 0.0, 2.0, 4.0, 6.0, 8.0, 12.0, 20.0, 30.0, 50.0],
        extent::many_objects,
    ),
    sweep(
        "noise",
        "Noise",
        "standard deviation of every channel",
        &[0.0, 0.004, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.2, 0.3],
        spoil::noisy,
    ),
    sweep(
        "jpeg",
        "JPEG",
        "quality (colors at half resolution)",
        &[100.0, 95.0, 90.0, 75.0, 50.0, 30.0, 20.0, 10.0, 5.0],
        spoil::compressed,
    ),
    sweep(
        "blur",
        "Blur",
        "standard deviation of the Gaussian, px",
        &[0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0],
        spoil::blurred,
    ),
    sweep("edge-hard", "Hard edges", "sigma of the edge profile", &[1e-4, 3e-5, 1e-5, 3e-6, 1e-6], edge::sigma),
    sweep("edge-soft", "Soft edges", "sigma of the edge profile", &[1e-4, 3e-4, 1e-3, 3e-3, 1e-2], edge::sigma),
    sweep(
        "edge-thin",
        "Edges at the outline",
        "offset of the edge profile",
        &[5e-4, 1.5e-4, 5e-5, 5e-6, 0.0],
        edge::offset,
    ),
    sweep(
        "edge-fat",
        "Edges far outside the outline",
        "offset of the edge profile",
        &[5e-4, 1.5e-3, 5e-3, 1.5e-2, 5e-2],
        edge::offset,
    ),
    sweep(
        "self-crossing",
        "Outlines that cross themselves",
        "second harmonic over the first (loops above 0.5)",
        &[0.0, 0.25, 0.45, 0.6, 0.8, 1.0, 1.5],
        degenerate::crossing,
    ),
    sweep(
        "coincident",
        "Coincident vertices",
        "times that the outline is run through",
        &[1.0, 3.0, 7.0, 9.0, 21.0],
        degenerate::coincident,
    ),
    Sweep {
        who: Who::Precisions,
        ..sweep(
            "precision",
            "f32 and f64",
            "contrast in float pixels that are not rounded",
            &[1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6],
            contrast::faint_floats,
        )
    },
    sweep(
        "image-small",
        "Small pictures",
        "side, px",
        &[128.0, 64.0, 48.0, 32.0, 24.0, 16.0, 12.0, 8.0],
        extent::pictures,
    ),
    Sweep {
        thinned: 4,
        ..sweep(
            "image-soft",
            "Large pictures, edges as soft in proportion",
            "side, px",
            &[128.0, 256.0, 512.0, 1024.0],
            extent::pictures,
        )
    },
    Sweep {
        thinned: 4,
        ..sweep(
            "image-sharp",
            "Large pictures, edges of a pixel",
            "side, px",
            &[128.0, 256.0, 512.0, 1024.0, 2048.0],
            extent::sharp_pictures,
        )
    },
];
