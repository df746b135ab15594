//! MAE and MSE over pixels and channels.

use super::pixel_vjp::pixel_vjp;
use super::{ImagePair, Loss, LossError, check_length};
use crate::real::Real;
use crate::render::PixelLoss;

/// Partial sums side by side: enough to fill the adders of the vector units.
const LANES: usize = 16;
/// Values summed in `T` before the sum goes on in f64: f32 sums stay exact to about 1e-6.
const BLOCK: usize = 4096;

impl<T: Real> Loss<T> for PixelLoss {
    type Input<'a> = ImagePair<'a, T>;
    /// 3 x height x width.
    type Grad = [T];
    type Scratch = ();

    #[inline(never)]
    fn value(&self, pair: ImagePair<'_, T>, (): &mut ()) -> Result<T, LossError> {
        let (a, b) = (pair.image().data(), pair.target().data());
        let sum = match self {
            Self::Mae => sum_of_differences(a, b, |d: T| if d < T::zero() { -d } else { d }),
            Self::Mse => sum_of_differences(a, b, |d: T| d * d),
        };
        Ok(T::of(sum / T::of_usize(a.len()).as_f64()))
    }

    #[inline(never)]
    fn vjp(&self, pair: ImagePair<'_, T>, cotangent: T, scratch: &mut (), grad: &mut [T]) -> Result<T, LossError> {
        check_length("image gradient", grad, pair.image().data().len())?;
        pixel_vjp(*self, pair, cotangent, grad);
        self.value(pair, scratch)
    }
}

/// The sum of `term(a - b)`.
fn sum_of_differences<T: Real>(a: &[T], b: &[T], term: impl Fn(T) -> T) -> f64 {
    let mut total = 0.0;
    for (a, b) in a.chunks(BLOCK).zip(b.chunks(BLOCK)) {
        let mut lanes = [T::zero(); LANES];
        let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
        for (a, b) in a.iter().zip(b) {
            for ((lane, &a), &b) in lanes.iter_mut().zip(a).zip(b) {
                *lane += term(a - b);
            }
        }
        for ((lane, &a), &b) in lanes.iter_mut().zip(a_rest).zip(b_rest) {
            *lane += term(a - b);
        }
        total += lanes.iter().map(|lane| lane.as_f64()).sum::<f64>();
    }
    total
}
