//! Fits a shape to an image by gradient, inside a model of burn, with burn's own Adam.

#![expect(clippy::print_stdout, reason = "shows how the loss falls")]

use burn::module::{Module, Param};
use burn::optim::{AdamConfig, GradientsParams};
use burn::tensor::{Device, Tensor};
use core::error::Error;
use dvp_burn::{from_burn, to_burn};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, RenderOp};
use dvp_core::shape::{EfdModel, OutlineBasis, OutlineOp};
use dvp_core::tensor::Tensor as CoreTensor;

/// One object on white, in a batch of one.
#[derive(Module, Debug)]
struct Picture {
    descriptors: Param<Tensor<3>>,
    center: Param<Tensor<4>>,
    color: Param<Tensor<3>>,
}

impl Picture {
    fn new(descriptors: [f32; 8], center: [f32; 2], color: [f32; 3], on: &Device) -> Self {
        Self {
            descriptors: Param::from_data([[descriptors]], on),
            center: Param::from_data([[[center]]], on),
            color: Param::from_data([[color]], on),
        }
    }

    /// Steps of the core and of burn in turns: 1 x 3 x height x width.
    fn render(&self) -> Result<Tensor<4>, Box<dyn Error>> {
        let outline = OutlineOp::new::<f32>(EfdModel::new(OutlineBasis::new(64, 2)?), 1)?;
        let outline = CoreTensor::apply::<f32, _>(outline, &[&from_burn(self.descriptors.val())?])?;
        let outline = from_burn(to_burn::<4>(&outline)? + self.center.val())?;
        let renderer = ContourRenderer::<f32>::new(EdgeProfile::reference(), Compositing::default());
        let render = RenderOp::new(renderer, dvp_core::ImageSize::new(64, 64)?, 1, 64)?;
        let [confidence, white] = [1, 3].map(|len| Tensor::<2>::ones([1, len], &self.color.device()));
        let inputs = [&outline, &from_burn(self.color.val())?, &from_burn(confidence)?, &from_burn(white)?];
        Ok(to_burn(&CoreTensor::apply::<f32, _>(render, &inputs)?)?)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let device = Device::flex().autodiff();
    let bean = [0.25, 0.05, 0.0, 0.15, 0.0, 0.03, 0.05, 0.0];
    let target = Picture::new(bean, [0.55, 0.45], [0.9, 0.3, 0.1], &device).render()?.inner();
    let circle = [0.15, 0.0, 0.0, 0.15, 0.0, 0.0, 0.0, 0.0];
    let mut picture = Picture::new(circle, [0.5, 0.5], [0.5; 3], &device);
    let mut adam = AdamConfig::new().init();
    for step in 0..=200 {
        let loss = (picture.render()? - target.clone()).square().mean();
        if step % 50 == 0 {
            println!("step {step}: mean squared error {:.1e}", loss.clone().into_scalar::<f32>());
        }
        picture = adam.step(0.01, picture.clone(), GradientsParams::from_grads(loss.backward(), &picture));
    }
    Ok(())
}
