//! What a scene spends: objects, shapes, harmonics, numbers, bits.

use dvp_core::{Object, Scene};
use dvp_fit::scene_bits;

/// What shapes cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    /// The choice among the shapes of a bank.
    Bank,
    /// Their coefficients.
    Free,
}

impl Law {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Bank => "bank",
            Self::Free => "free",
        }
    }
}

/// What a scene spends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spent {
    pub(super) objects: usize,
    /// Different shapes.
    pub(super) shapes: usize,
    /// Mean over the objects whose shape is of no bank; NaN if there are none.
    pub(super) harmonics: f64,
    /// Free numbers: color (3) and pose (4) of each object, the coefficients of each different shape that is of no bank, the
    /// background (3).
    pub(super) numbers: usize,
    /// As fits count them.
    pub(super) bits: f64,
}

impl Spent {
    /// Of a scene whose prototypes are of a bank of that many.
    #[expect(clippy::cast_precision_loss, reason = "few objects of few harmonics")]
    pub(super) fn of(scene: &Scene<f32>, bank: usize) -> Self {
        let objects = &scene.objects;
        let is_new =
            |&(at, object): &(usize, &Object<f32>)| !objects[..at].iter().any(|other| is_same_shape(other, object));
        let different: Vec<&Object<f32>> =
            objects.iter().enumerate().filter(is_new).map(|(_, object)| object).collect();
        let harmonics = |object: &&Object<f32>| object.prototype().is_none().then(|| object.efd_rows().len());
        let free: Vec<usize> = objects.iter().filter_map(|object| harmonics(&object)).collect();
        let coefficients = 4 * different.iter().filter_map(harmonics).sum::<usize>();
        Self {
            objects: objects.len(),
            shapes: different.len(),
            harmonics: free.iter().sum::<usize>() as f64 / free.len() as f64,
            numbers: 3 + 7 * objects.len() + coefficients,
            bits: scene_bits(scene, bank),
        }
    }
}

fn is_same_shape(a: &Object<f32>, b: &Object<f32>) -> bool {
    match (a.prototype(), b.prototype()) {
        (None, None) => a.shape == b.shape,
        (a, b) => a == b,
    }
}
