//! Instance norm as one step: in tensor operations it is a dozen passes over the pixels forward and thirty back.

use core::convert::Infallible;

use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::{Dims, DimsError};
use crate::real::Real;

/// Channels of an image with mean 0 and variance 1 over their pixels, times a weight plus a bias each; three inputs per item: image,
/// channels x pixels, weights and biases, channels each.
///
/// *Source*: Ulyanov, Vedaldi, Lempitsky: Instance Normalization (2016).
#[derive(Clone, Debug, PartialEq)]
pub struct InstanceNormOp {
    signature: Signature,
    pixels: usize,
    epsilon: f64,
}

impl InstanceNormOp {
    /// Of images of `channels` and `pixels`; `epsilon` is added to the variance.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(channels: usize, pixels: usize, epsilon: f64) -> Result<Self, DimsError> {
        let image = [channels, pixels];
        let inputs = [
            OpInput::new("image", &image)?,
            OpInput::new("weights", &[channels])?,
            OpInput::new("biases", &[channels])?,
        ];
        Ok(Self { signature: Signature::new("instance_norm", inputs, Dims::new(&image)?), pixels, epsilon })
    }

    /// The mean of a channel, and one over the root of its variance.
    fn statistics<T: Real>(&self, channel: &[T]) -> [T; 2] {
        let count = T::of_usize(channel.len().max(1));
        let mean = sum(channel, channel, |x, _| x) / count;
        let variance = sum(channel, channel, |x, _| (x - mean) * (x - mean)) / count;
        [mean, (variance + T::of(self.epsilon)).sqrt().recip()]
    }
}

impl<T: Real> DiffOp<T> for InstanceNormOp {
    type Scratch = ();
    type Error = Infallible;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        let [image, weights, biases] = self.signature.split(input);
        let pixels = self.pixels.max(1);
        let channels = image.chunks_exact(pixels).zip(output.chunks_exact_mut(pixels));
        for ((channel, output), (&weight, &bias)) in channels.zip(weights.iter().zip(biases)) {
            let [mean, scale] = self.statistics(channel);
            output.iter_mut().zip(channel).for_each(|(out, &x)| *out = (x - mean) * (scale * weight) + bias);
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), Infallible> {
        let [image, weights, _] = self.signature.split(input);
        let [grad_image, grad_weights, grad_biases] = self.signature.split_mut(grad_input);
        let pixels = self.pixels.max(1);
        let count = T::of_usize(pixels);
        let channels = image.chunks_exact(pixels).zip(grad_output.chunks_exact(pixels));
        for (k, ((channel, grads), to)) in channels.zip(grad_image.chunks_exact_mut(pixels)).enumerate() {
            let [mean, scale] = self.statistics(channel);
            let total = sum(grads, grads, |grad, _| grad);
            let along = sum(grads, channel, |grad, x| grad * (x - mean)) * scale;
            grad_biases[k] += total;
            grad_weights[k] += along;
            // The mean and the variance move with every pixel.
            let (factor, shift, slope) = (scale * weights[k], total / count, along / count * scale);
            for ((to, &grad), &x) in to.iter_mut().zip(grads).zip(channel) {
                *to += factor * (grad - shift - (x - mean) * slope);
            }
        }
        Ok(())
    }
}

/// Sums that are added up beside one another: one after the other each would wait for the one before.
const LANES: usize = 16;

/// The sum of `of` over pairs of numbers.
fn sum<T: Real>(a: &[T], b: &[T], of: impl Fn(T, T) -> T) -> T {
    let (a_lanes, a_rest) = a.as_chunks::<LANES>();
    let (b_lanes, b_rest) = b.as_chunks::<LANES>();
    let mut sums = [T::zero(); LANES];
    for (a, b) in a_lanes.iter().zip(b_lanes) {
        sums.iter_mut().zip(a).zip(b).for_each(|((sum, &a), &b)| *sum += of(a, b));
    }
    let rest = a_rest.iter().zip(b_rest).map(|(&a, &b)| of(a, b)).sum::<T>();
    sums.into_iter().sum::<T>() + rest
}
