//! What the true scene costs, by the law that fits are priced by.

use anyhow::Result;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, ImageSize, Object, Pose, Scene};
use dvp_fit::{Unexplained, scene_bits};

use super::spent::{Law, Spent};
use dvp_cli::paint::Painter;

/// What a true scene costs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Price {
    bank: Spent,
    free: Spent,
    /// Bits if every object is written with a shape of its own, though others have the same.
    pub(super) own_bits: f64,
}

impl Price {
    /// Of a scene, painted at `size`, whose prototypes are of a bank of that many.
    ///
    /// Shapes that are written out have the number of harmonics that is shortest to write, with what the picture then misses:
    /// no fit can know of more. Objects of one prototype share a shape, of as many harmonics as the one that needs most.
    pub(super) fn of(truth: &Scene<f32>, size: ImageSize, bank: usize) -> Result<Self> {
        let needed =
            (0..truth.objects.len()).map(|at| needed_harmonics(truth, at, size)).collect::<Result<Vec<_>>>()?;
        let with_shapes = |shape: &dyn Fn(usize, &Object<f32>) -> Object<f32>| Scene {
            objects: truth.objects.iter().enumerate().map(|(at, object)| shape(at, object)).collect(),
            ..truth.clone()
        };
        let shared = with_shapes(&|_, object| {
            let alike = truth.objects.iter().zip(&needed).filter(|(other, _)| other.shape.efd() == object.shape.efd());
            written_out(object, alike.map(|(_, &harmonics)| harmonics).max().unwrap_or(1))
        });
        let known =
            with_shapes(&|at, object| if object.prototype().is_some() { object } else { &shared.objects[at] }.clone());
        let background = Scene { objects: Vec::new(), ..truth.clone() };
        let nothing = scene_bits(&background, bank);
        let alone = truth.objects.iter().zip(&needed).map(|(object, &harmonics)| {
            let objects = vec![written_out(object, harmonics)];
            scene_bits(&Scene { objects, ..background.clone() }, bank) - nothing
        });
        let own_bits = nothing + alone.sum::<f64>();
        Ok(Self { bank: Spent::of(&known, bank), free: Spent::of(&shared, bank), own_bits })
    }

    /// What the scene spends if shapes cost what `law` says.
    pub(super) fn by(&self, law: Law) -> Spent {
        match law {
            Law::Bank => self.bank,
            Law::Free => self.free,
        }
    }
}

/// Edges of the outlines that are painted: vertices at t = i / 63.
const EDGES: usize = REFERENCE_VERTICES - 1;
/// Harmonics that so many vertices carry.
const MOST_HARMONICS: usize = EDGES / 2;

/// The object with its shape cut to so many harmonics, and of no bank. All that the vertices carry leave every vertex where it
/// is: at t = i / 63 harmonic 63 - n is harmonic n with the sines negative, and harmonic 63 does not move.
pub(super) fn written_out(object: &Object<f32>, harmonics: usize) -> Object<f32> {
    let mut rows = vec![[0.0; 4]; MOST_HARMONICS.min(object.efd_rows().len())];
    let mut center = [[0.0; 2]];
    for (n, &[a, b, c, d]) in (1_usize..).zip(object.efd_rows()) {
        let turns = n % EDGES;
        let (n, sign) = if turns <= MOST_HARMONICS { (turns, 1.0) } else { (EDGES - turns, -1.0) };
        if let Some(row) = n.checked_sub(1).and_then(|n| rows.get_mut(n)) {
            for (sum, value) in row.iter_mut().zip([a, sign * b, c, sign * d]) {
                *sum += value;
            }
        } else {
            center[0][0] += a;
            center[0][1] += c;
        }
    }
    rows.truncate(harmonics);
    object.pose.transform(&mut center);
    let pose = Pose { translation: center[0], ..object.pose };
    Object { pose, shape: Efd::new(rows).into(), ..object.clone() }
}

/// The number of harmonics of an object that is shortest to write with what the picture misses without the others.
fn needed_harmonics(truth: &Scene<f32>, at: usize, size: ImageSize) -> Result<usize> {
    let painter = Painter::default();
    let whole = painter.paint(truth, size)?;
    let mut cut = truth.clone();
    let mut best = (f64::INFINITY, 1);
    for harmonics in 1..=MOST_HARMONICS.min(truth.objects[at].efd_rows().len()) {
        cut.objects[at] = written_out(&truth.objects[at], harmonics);
        let shape = scene_bits(&Scene { objects: vec![cut.objects[at].clone()], ..Scene::empty([0.0; 3]) }, 1);
        if shape >= best.0 {
            break;
        }
        let bits = shape + Unexplained::of(&whole.view(), painter.paint(&cut, size)?.data()).bits;
        if bits < best.0 {
            best = (bits, harmonics);
        }
    }
    Ok(best.1)
}
