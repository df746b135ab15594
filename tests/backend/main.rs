//! One suite, run on every backend: operations, steps, networks, weights.
//!
//! The backends are listed in [`registry`]; another one is one line there. Every concern counts its checks per backend and
//! fails unless each of them made the same number. Values and gradients are held against the host backend; gradients in f64
//! also against central differences, and f32 against f64.
//!
//! | file | holds |
//! |---|---|
//! | `registry` | the backends, and the count of checks |
//! | `check` | a computation against the host backend and central differences |
//! | `input` | what comes in: extents, values, and views of other arrays |
//! | `elementwise`, `layout`, `reduce`, `product`, `convolution`, `compose` | the operations of tensors |
//! | `kinks` | where there is no derivative: what is taken instead |
//! | `step` | every differentiable step of the core |
//! | `dense` | the renderer in tensor operations, the same as the step |
//! | `refusal` | what is refused, in the same words everywhere |
//! | `scene` | parameters to activations, prototypes, outlines, images and losses: one graph, and a fit |
//! | `network`, `training` | 50 steps of Adam from the same weights; replicas on threads |
//! | `modes` | a step of training in every mode |
//! | `published` | DINOv2 and Conditional DETR against their public implementations; their gradients |
//! | `decompose` | MONet and Slot Attention: 50 steps, gradients, files |
//! | `look` | a second look: steps, gradients, files |
//! | `weights` | files written on one backend and read on another |
#![expect(clippy::unwrap_used, clippy::panic, reason = "a failed test with a line number")]
#![expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is checked")]

extern crate alloc;

mod check;
mod compose;
mod convolution;
mod decompose;
mod dense;
mod elementwise;
mod input;
mod kinks;
mod layout;
mod look;
mod modes;
mod network;
mod product;
mod published;
mod reduce;
mod refusal;
mod registry;
mod scene;
mod step;
mod training;
mod weights;
