//! Scenes of flat objects - circles, polygons, paths, strokes, elliptic Fourier outlines - and the differentiable renderers
//! that paint them.
//!
//! # Data flow
//!
//! ```text
//! image -> contour -> shape -> scene -> drawing -> render -> loss -> gradient
//! ```
//!
//! | module | comes in | goes out |
//! |---|---|---|
//! | [`real`] | f32 or f64 | one trait for both |
//! | [`dims`] | numbers of pixels, extents of arrays | a checked size |
//! | [`geometry`] | points | distances, boxes, the one vocabulary of the plane |
//! | [`optim`] | losses of steps | the next learning rate |
//! | [`diff_op`] | the inputs of a step, on slices | its output and, backward, gradients |
//! | [`tensor`] | values and extents | arrays of any framework, and networks on them |
//! | [`image`] | slices of pixels | checked views |
//! | [`contour`] | a mask | closed polygons traced from it |
//! | [`shape`] | the numbers of a shape, or a contour | rings of vertices, exact boundaries, measures, EFD, symmetry |
//! | [`scene`] | objects and background | a drawing: posed rings with colors |
//! | [`render`] | a drawing | an image and, backward, gradients |
//! | [`matching`] | a cost matrix | the best assignment |
//! | [`loss`], [`metric`] | two images or two scenes | a number and, for losses, gradients |
//! | [`simd`] | a hot loop | the same, compiled for the processor at hand |
//!
//! # Units and signs
//!
//! | quantity | unit |
//! |---|---|
//! | scene coordinates | the *shorter* image side is 1; x right, y down; the pixel (row r, column c) has its center at ((c + 0.5)/m, (r + 0.5)/m), m = min(width, height). A square image spans \[0, 1\] x \[0, 1\] |
//! | rotation | radians; a point v of the unit outline goes to `s R v + t`, R = \[\[cos a, -sin a\], \[sin a, cos a\]\] |
//! | [`EdgeProfile`](render::EdgeProfile) `offset`, `sigma`, `cut` | by its law: squared length or length in the *doubled* frame of the reference renderer, where the shorter side is 2 |
//! | signed distance | positive outside, negative inside |
//! | fill | what an odd number of an object's rings goes around (even-odd); shapes that fill otherwise resolve their rings |
//! | color | linear in the stored values, \[0, 1\] per channel |
//! | image memory | planar: channel, row, column |
//!
//! Every differentiable step `x` has an `x_vjp` beside it: the gradient of a scalar pulled back through the step,
//! **added** to what the caller's gradient already holds.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | `std` (default) | the platform's maths, AVX2 and AVX-512 kernels picked at run time |
//! | `triangles` | [`render::TriangleRenderer`], coverage by triangles as in the paper; needs std |
//! | `parallel` | batches of differentiable steps on all cores; needs std |
//! | `safetensors` | weights as the bytes of a safetensors file |
#![no_std]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

/// The example of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub mod contour;
pub mod diff_op;
pub mod dims;
pub mod geometry;
pub mod image;
#[doc(hidden)]
pub mod instances;
pub mod loss;
pub mod matching;
pub mod metric;
pub mod optim;
pub mod real;
pub mod render;
pub mod scene;
pub mod shape;
pub mod simd;
#[doc(hidden)]
pub mod sort;
pub mod tensor;

pub use dims::ImageSize;
pub use geometry::Vec2;
pub use image::{Image, ImageView};
pub use real::Real;
pub use scene::{Drawing, DrawingGrad, Object, Paint, Pose, Scene, SceneGrad};
pub use shape::{AnyShape, Efd, Outline, Shape};
