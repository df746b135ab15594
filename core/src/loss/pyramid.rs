//! An image loss over an image and its halved copies: far objects still pull on each other.

use alloc::vec;
use alloc::vec::Vec;

use super::pyramid_vjp::halve_vjp;
use super::{ImagePair, Loss, LossError, check_length};
use crate::dims::ImageSize;
use crate::image::{CHANNELS, ImageView};
use crate::real::Real;

/// The mean of an image loss over `levels` levels, each half the size of the one before.
///
/// A pixel of a level is the mean of the 2 x 2 pixels below it; at an odd right or lower border of the 2 or the 1 that
/// exist, so that sizes are halved upwards and 1 stays 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pyramid<L> {
    loss: L,
    levels: usize,
}

impl<L> Pyramid<L> {
    /// `loss` over `levels` levels, the image itself being the first.
    ///
    /// # Errors
    /// [`LossError::Zero`] without a level.
    pub fn new(loss: L, levels: usize) -> Result<Self, LossError> {
        if levels == 0 { Err(LossError::Zero { what: "pyramid levels" }) } else { Ok(Self { loss, levels }) }
    }
}

/// Memory of a [`Pyramid`].
#[derive(Clone, Debug, Default)]
pub struct PyramidScratch<T, S> {
    /// The levels above the image itself.
    levels: Vec<Level<T>>,
    loss: S,
}

#[derive(Clone, Debug)]
struct Level<T> {
    size: ImageSize,
    image: Vec<T>,
    target: Vec<T>,
    grad: Vec<T>,
}

impl<T: Real> Level<T> {
    fn pair(&self) -> Result<ImagePair<'_, T>, LossError> {
        ImagePair::new(ImageView::new(self.size, &self.image)?, ImageView::new(self.size, &self.target)?)
    }
}

impl<T: Real, S> PyramidScratch<T, S> {
    /// Fills `count` levels above the pair.
    fn fill(&mut self, pair: ImagePair<'_, T>, count: usize) -> Result<(), LossError> {
        let mut size = pair.size();
        self.levels.truncate(count);
        for k in 0..count {
            let above = halved(size)?;
            if self.levels.get(k).is_none_or(|level| level.size != above) {
                let zeros = vec![T::zero(); above.pixels() * CHANNELS];
                let level = Level { size: above, image: zeros.clone(), target: zeros.clone(), grad: zeros };
                self.levels.truncate(k);
                self.levels.push(level);
            }
            let (below, rest) = self.levels.split_at_mut(k);
            let level = &mut rest[0];
            let (image, target) = match below.last() {
                Some(level) => (&level.image[..], &level.target[..]),
                None => (pair.image().data(), pair.target().data()),
            };
            halve(size, image, above, &mut level.image);
            halve(size, target, above, &mut level.target);
            size = above;
        }
        Ok(())
    }
}

impl<T, L> Loss<T> for Pyramid<L>
where
    T: Real,
    L: for<'a> Loss<T, Input<'a> = ImagePair<'a, T>, Grad = [T]>,
{
    type Input<'a> = ImagePair<'a, T>;
    /// 3 x height x width.
    type Grad = [T];
    type Scratch = PyramidScratch<T, L::Scratch>;

    fn value(&self, pair: ImagePair<'_, T>, scratch: &mut Self::Scratch) -> Result<T, LossError> {
        scratch.fill(pair, self.levels - 1)?;
        let mut sum = self.loss.value(pair, &mut scratch.loss)?;
        for level in &scratch.levels {
            sum += self.loss.value(level.pair()?, &mut scratch.loss)?;
        }
        Ok(sum / T::of_usize(self.levels))
    }

    fn vjp(
        &self,
        pair: ImagePair<'_, T>,
        cotangent: T,
        scratch: &mut Self::Scratch,
        grad: &mut [T],
    ) -> Result<T, LossError> {
        check_length("image gradient", grad, pair.image().data().len())?;
        scratch.fill(pair, self.levels - 1)?;
        let (each, count) = (cotangent / T::of_usize(self.levels), self.levels);
        let mut sum = self.loss.vjp(pair, each, &mut scratch.loss, grad)?;
        for level in &mut scratch.levels {
            // Taken out, so that the level can be read while its gradient is written.
            let mut own = core::mem::take(&mut level.grad);
            own.fill(T::zero());
            let value = level.pair().and_then(|pair| self.loss.vjp(pair, each, &mut scratch.loss, &mut own));
            level.grad = own;
            sum += value?;
        }
        for k in (0..scratch.levels.len()).rev() {
            let (below, rest) = scratch.levels.split_at_mut(k);
            let (size, grad_below) = match below.last_mut() {
                Some(level) => (level.size, &mut level.grad[..]),
                None => (pair.size(), &mut *grad),
            };
            halve_vjp(size, grad_below, rest[0].size, &rest[0].grad);
        }
        Ok(sum / T::of_usize(count))
    }
}

fn halved(size: ImageSize) -> Result<ImageSize, LossError> {
    // A size halved upwards stays valid; the error is that of an impossible number.
    ImageSize::new(size.width().div_ceil(2), size.height().div_ceil(2))
        .map_err(|_| LossError::Zero { what: "side of a pyramid level" })
}

/// The columns (or rows) under column (or row) `i` of the next level.
pub(super) fn under(i: usize, len: usize) -> core::ops::Range<usize> {
    2 * i..(2 * i + 2).min(len)
}

fn halve<T: Real>(size: ImageSize, image: &[T], above: ImageSize, out: &mut [T]) {
    let planes = image.chunks_exact(size.pixels()).zip(out.chunks_exact_mut(above.pixels()));
    for (plane, out) in planes {
        for (r, out_row) in out.chunks_exact_mut(above.width()).enumerate() {
            let rows = under(r, size.height());
            for (c, value) in out_row.iter_mut().enumerate() {
                let columns = under(c, size.width());
                let sum: T =
                    rows.clone().map(|y| plane[y * size.width()..][columns.clone()].iter().copied().sum::<T>()).sum();
                *value = sum / T::of_usize(rows.len() * columns.len());
            }
        }
    }
}
