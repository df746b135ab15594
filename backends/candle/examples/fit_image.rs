//! Fits a shape to an image by gradient, inside a model of candle, with candle's own Adam.

#![expect(clippy::print_stdout, reason = "shows how the loss falls")]

use candle_core::{DType, Device, Result, Tensor, Var};
use candle_nn::{AdamW, Optimizer, ParamsAdamW};
use core::error::Error;
use dvp_candle::{from_candle, to_candle};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, RenderOp};
use dvp_core::shape::{EfdModel, OutlineBasis, OutlineOp};
use dvp_core::tensor::Tensor as CoreTensor;

/// One object on white, in a batch of one.
struct Picture {
    descriptors: Var,
    center: Var,
    color: Var,
}

impl Picture {
    fn new(descriptors: [f32; 8], center: [f32; 2], color: [f32; 3], on: &Device) -> Result<Self> {
        Ok(Self {
            descriptors: Var::new(&[[descriptors]], on)?,
            center: Var::new(&[[[center]]], on)?,
            color: Var::new(&[[color]], on)?,
        })
    }

    /// Steps of the core and of candle in turns: 1 x 3 x height x width.
    fn render(&self) -> core::result::Result<Tensor, Box<dyn Error>> {
        let outline = OutlineOp::new::<f32>(EfdModel::new(OutlineBasis::new(64, 2)?), 1)?;
        let outline = CoreTensor::apply::<f32, _>(outline, &[&from_candle(&self.descriptors)?])?;
        let outline = from_candle(&to_candle(&outline).broadcast_add(&self.center)?)?;
        let renderer = ContourRenderer::<f32>::new(EdgeProfile::reference(), Compositing::default());
        let render = RenderOp::new(renderer, dvp_core::ImageSize::new(64, 64)?, 1, 64)?;
        let [confidence, white] = [1, 3].map(|len| Tensor::ones((1, len), DType::F32, self.color.device()));
        let inputs = [&outline, &from_candle(&self.color)?, &from_candle(&confidence?)?, &from_candle(&white?)?];
        Ok(to_candle(&CoreTensor::apply::<f32, _>(render, &inputs)?))
    }
}

fn main() -> core::result::Result<(), Box<dyn Error>> {
    let bean = [0.25, 0.05, 0.0, 0.15, 0.0, 0.03, 0.05, 0.0];
    let target = Picture::new(bean, [0.55, 0.45], [0.9, 0.3, 0.1], &Device::Cpu)?.render()?.detach();
    let circle = [0.15, 0.0, 0.0, 0.15, 0.0, 0.0, 0.0, 0.0];
    let picture = Picture::new(circle, [0.5, 0.5], [0.5; 3], &Device::Cpu)?;
    let variables = vec![picture.descriptors.clone(), picture.center.clone(), picture.color.clone()];
    let mut adam = AdamW::new(variables, ParamsAdamW { lr: 0.01, weight_decay: 0.0, ..Default::default() })?;
    for step in 0..=200 {
        let loss = (picture.render()? - &target)?.sqr()?.mean_all()?;
        if step % 50 == 0 {
            println!("step {step}: mean squared error {:.1e}", loss.to_vec0::<f32>()?);
        }
        adam.backward_step(&loss)?;
    }
    Ok(())
}
