//! Windows of pixels as columns: convolution becomes a product of matrices, pooling a largest number.

use core::convert::Infallible;
use core::ops::Range;

use super::backend::Stride;
use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::{Dims, DimsError};
use crate::real::Real;

/// Windows of an image, c x h x w per item, as columns: (c kh kw) x (rows columns). Row (channel, y, x) holds that pixel of
/// every window. Known as im2col.
///
/// *Derivative*: each pixel gets the sum over the windows that it is in.
#[derive(Clone, Debug, PartialEq)]
pub struct Unfold {
    signature: Signature,
    image: [usize; 3],
    window: [usize; 2],
    /// Rows and columns of windows.
    windows: [usize; 2],
    stride: Stride,
    padding: f64,
}

impl Unfold {
    /// Windows of `window` (height, width) pixels of images of `image` (channels, height, width); padded with 0.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(image: [usize; 3], window: [usize; 2], stride: Stride) -> Result<Self, DimsError> {
        let windows = [stride.windows(image[1], window[0]), stride.windows(image[2], window[1])];
        let columns = Dims::new(&[image[0] * window[0] * window[1], windows[0] * windows[1]])?;
        let signature = Signature::new("unfold", [OpInput::new("images", &image)?], columns);
        Ok(Self { signature, image, window, windows, stride, padding: 0.0 })
    }

    /// The same windows, padded with `value`.
    #[must_use]
    pub fn with_padding(&self, value: f64) -> Self {
        Self { padding: value, ..self.clone() }
    }

    /// Calls `run` for each row of windows of each row of the output: where in the output it stands, where in the image
    /// its first window's pixel would stand (none if the image row is padding), and which of its windows lie inside.
    fn for_each_run(&self, mut run: impl FnMut(usize, Option<usize>, Range<usize>)) {
        let ([channels, h, w], [kh, kw], [rows, columns]) = (self.image, self.window, self.windows);
        let Stride { step, padding } = self.stride;
        let step = step.max(1); // Steps of 0 have no windows.
        let mut out = 0;
        for channel in 0..channels {
            for (ky, kx) in (0..kh).flat_map(|ky| (0..kw).map(move |kx| (ky, kx))) {
                // Windows whose column kx lies inside: padding <= column step + kx < w + padding.
                let first = padding.saturating_sub(kx).div_ceil(step).min(columns);
                let end = (w + padding).saturating_sub(kx).div_ceil(step).clamp(first, columns);
                for row in 0..rows {
                    let y = (row * step + ky).checked_sub(padding).filter(|&y| y < h && first < end);
                    let start = y.map(|y| (channel * h + y) * w + first * step + kx - padding);
                    run(out, start, first..end);
                    out += columns;
                }
            }
        }
    }
}

impl<T: Real> DiffOp<T> for Unfold {
    type Scratch = ();
    type Error = Infallible;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        output.fill(T::of(self.padding));
        self.for_each_run(|out, start, inside| {
            let Some(start) = start else { return };
            let to = &mut output[out..][inside];
            if self.stride.step == 1 {
                to.copy_from_slice(&input[start..start + to.len()]);
            } else {
                to.iter_mut().zip(input[start..].iter().step_by(self.stride.step)).for_each(|(to, &value)| *to = value);
            }
        });
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        _: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), Infallible> {
        self.for_each_run(|out, start, inside| {
            let Some(start) = start else { return };
            let grads = grad_output[out..][inside].iter();
            let to = grad_input[start..].iter_mut().step_by(self.stride.step);
            to.zip(grads).for_each(|(to, &grad)| *to += grad);
        });
        Ok(())
    }
}
