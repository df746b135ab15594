//! The renderer of tensor operations alone, on every backend that this program was built with.

use anyhow::Result;
use dvp_core::render::{DenseRenderer, EdgeProfile, PixelLoss, TensorDrawing};
use dvp_core::tensor::{Backend, Host, HostDevice, Tensor};

use super::renderers::{Candidate, Paints, Sample, timed_ms};
use crate::command::pictures::Picture;
use dvp_cli::method::Precision;
use dvp_cli::paint::Painter;

/// What paints on each backend.
pub(super) fn candidates() -> Vec<Candidate> {
    #[cfg_attr(not(any(feature = "burn", feature = "candle")), expect(unused_mut, reason = "frameworks are features"))]
    let mut all = vec![candidate::<Host>(HostDevice)];
    #[cfg(feature = "burn")]
    all.push(candidate::<dvp_burn::Burn>(<dvp_burn::Burn as Backend>::Device::flex()));
    #[cfg(feature = "candle")]
    all.push(candidate::<dvp_candle::Candle>(dvp_candle::CandleDevice::CPU));
    all
}

fn candidate<B: Backend>(device: B::Device) -> Candidate
where
    B::Device: 'static,
{
    ("tensor-only", B::NAME.into(), Precision::F32, Box::new(Dense::<B> { device }))
}

struct Dense<B: Backend> {
    device: B::Device,
}

impl<B: Backend> Dense<B> {
    /// A tensor of one item.
    fn tensor(&self, values: &[f32], extents: &[usize]) -> Result<Tensor<B>> {
        Ok(Tensor::new(values.to_vec(), extents, &self.device)?)
    }
}

impl<B: Backend> Paints for Dense<B> {
    fn paint(&mut self, picture: &Picture) -> Result<Sample> {
        let (truth, size) = (&picture.truth, picture.image.size());
        let drawing = Painter::default().draw(truth, size)?;
        let (objects, vertices) = (drawing.object_count(), drawing.vertices.len() / drawing.object_count().max(1));
        let tensors = TensorDrawing {
            outlines: self.tensor(drawing.vertices.as_flattened(), &[1, objects, vertices, 2])?,
            colors: self.tensor(drawing.colors.as_flattened(), &[1, objects, 3])?,
            confidences: self.tensor(&drawing.confidences, &[1, objects])?,
            background: self.tensor(&drawing.background, &[1, 3])?,
        };
        let target = self.tensor(picture.image.data(), &[1, 3, size.height(), size.width()])?;
        let renderer = DenseRenderer::new(EdgeProfile::reference(), truth.compositing, size)?;
        let mut image = Vec::new();
        let forward_ms = timed_ms(1, || {
            image = renderer.render(&tensors)?.to_f64()?;
            Ok(())
        })?;
        let backward_ms = timed_ms(1, || {
            let free = TensorDrawing {
                outlines: tensors.outlines.parameter()?,
                colors: tensors.colors.parameter()?,
                confidences: tensors.confidences.parameter()?,
                background: tensors.background.parameter()?,
            };
            let loss = renderer.pixel_loss(&free, &target, PixelLoss::Mae)?.mean_all()?;
            let gradients = loss.backward()?;
            // Brings the numbers to the host, whatever waits.
            gradients.of(&free.outlines).map(|slope| slope.to_f64()).transpose()?;
            Ok(())
        })?;
        Ok(Sample { image, forward_ms, backward_ms })
    }
}
