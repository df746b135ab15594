//! A shape of one's own in a differentiable picture: superellipses |x/a|^(2/p) + |y/b|^(2/p) = 1, from rectangles (p near 0)
//! over ellipses (p = 1) to diamonds (p = 2), whose three numbers are found from an image.
//!
//! `cargo run --release -p dvp-core --example custom_shape`
//!
//! All that a step needs is a [`DiffOp`]: what it does with the numbers of one item, and the way back. The steps of the core
//! come before and after it, on any backend. A loss of one's own is a `DiffOp` likewise, from an image to one number.

#![expect(clippy::print_stdout, reason = "shows what was found")]

use core::convert::Infallible;
use core::error::Error;
use core::f64::consts::TAU;

use dvp_core::diff_op::{DiffOp, OpInput, Signature};
use dvp_core::dims::{Dims, DimsError};
use dvp_core::optim::AdamSettings;
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, RenderLossOp, RenderOp};
use dvp_core::tensor::{Adam, Host, HostDevice, Parameters, Tensor};
use dvp_core::{Image, ImageSize, Real};

const VERTICES: usize = 64;
const STEPS: usize = 600;

/// Numbers (a, b, p) of one superellipse around the middle of the picture to its outline, 1 x vertices x 2, scene units.
///
/// *Derivative*: of |cos t|^p by p taken as 0 where the cosine is 0, and likewise for the sine.
#[derive(Debug)]
struct Superellipse {
    signature: Signature,
}

impl Superellipse {
    fn new() -> Result<Self, DimsError> {
        let inputs = [OpInput::new("numbers", &[3])?];
        Ok(Self { signature: Signature::new("superellipse", inputs, Dims::new(&[1, VERTICES, 2])?) })
    }
}

/// Sign(u) |u|^p and its derivative by p.
fn power<T: Real>(u: T, p: T) -> [T; 2] {
    let size = u.abs();
    if size < T::of(1e-6) {
        return [T::zero(); 2];
    }
    let value = u.signum() * size.powf(p);
    [value, value * size.ln()]
}

/// Cosine and sine of the angle of every vertex.
fn directions<T: Real>() -> impl Iterator<Item = [T; 2]> {
    (0..VERTICES).map(|k| {
        let angle = TAU * k as f64 / VERTICES as f64;
        [T::of(angle.cos()), T::of(angle.sin())]
    })
}

impl<T: Real> DiffOp<T> for Superellipse {
    type Scratch = ();
    type Error = Infallible;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        let [a, b, p] = [input[0], input[1], input[2]];
        for (vertex, [cos, sin]) in output.as_chunks_mut::<2>().0.iter_mut().zip(directions()) {
            *vertex = [T::of(0.5) + a * power(cos, p)[0], T::of(0.5) + b * power(sin, p)[0]];
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
        let [a, b, p] = [input[0], input[1], input[2]];
        for (grad, [cos, sin]) in grad_output.as_chunks::<2>().0.iter().zip(directions()) {
            let ([x, x_by_p], [y, y_by_p]) = (power(cos, p), power(sin, p));
            grad_input[0] += grad[0] * x;
            grad_input[1] += grad[1] * y;
            grad_input[2] += grad[0] * a * x_by_p + grad[1] * b * y_by_p;
        }
        Ok(())
    }
}

/// What a drawing has beside its outlines: a dark object that is there, on white.
fn colors() -> Result<[Tensor<Host>; 3], Box<dyn Error>> {
    let values: [(&[usize], f32); 3] = [(&[1, 1, 3], 0.2), (&[1, 1], 1.0), (&[1, 3], 1.0)];
    let mut tensors = Vec::new();
    for (extents, value) in values {
        tensors.push(Tensor::new(vec![value; extents.iter().product()], extents, &HostDevice)?);
    }
    tensors.try_into().map_err(|_| "three tensors".into())
}

fn main() -> Result<(), Box<dyn Error>> {
    let size = ImageSize::new(64, 64)?;
    let renderer = || ContourRenderer::<f32>::new(EdgeProfile::reference(), Compositing::Blend);
    let [color, there, background] = colors()?;
    let outline = |numbers: &Tensor<Host>| Tensor::apply::<f32, _>(Superellipse::new()?, &[numbers]);

    let truth = [0.3_f32, 0.2, 0.5];
    let truly = outline(&Tensor::new(truth.to_vec(), &[1, 3], &HostDevice)?)?;
    let paint = RenderOp::new(renderer(), size, 1, VERTICES)?;
    let painted = Tensor::apply::<f32, _>(paint, &[&truly, &color, &there, &background])?;
    let target = Image::from_planar(size, painted.to_f64()?.into_iter().map(f32::of).collect())?;

    let mut parameters = Parameters::<Host>::new();
    parameters.insert("numbers", &Tensor::new(vec![0.2_f32, 0.25, 1.0], &[1, 3], &HostDevice)?)?;
    let mut adam = Adam::new(AdamSettings::default());
    for step in 0..=STEPS {
        let op = RenderLossOp::new(renderer(), PixelLoss::Mse, vec![target.clone()], 1, VERTICES)?;
        let drawn = outline(parameters.get("numbers")?)?;
        let loss = Tensor::apply::<f32, _>(op, &[&drawn, &color, &there, &background])?.mean_all()?;
        if step % 150 == 0 {
            println!("step {step}: mean squared error {:.1e}", loss.number()?);
        }
        let gradients = parameters.gradients(&loss.backward()?);
        adam.step(&mut parameters, &gradients, 0.005)?;
    }
    let found = parameters.get("numbers")?.to_f64()?;
    println!("found {found:.3?}, drawn {truth:?}");
    let off = found.iter().zip(truth).map(|(found, truth)| (found - f64::from(truth)).abs()).fold(0.0, f64::max);
    if off > 0.02 { Err(format!("the shape is off by {off}").into()) } else { Ok(()) }
}
