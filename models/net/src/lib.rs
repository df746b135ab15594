//! Networks that look at an image and propose its scene.
//!
//! In: images and named weights, [`Parameters`](dvp_core::tensor::Parameters). Out: scenes. Everything is written once
//! over [`Tensor`](dvp_core::tensor::Tensor) and runs on every [`Backend`](dvp_core::tensor::Backend); no framework is
//! needed.
//!
//! ```text
//! image -> encoder -> features -> detr -> latents -> heads -> scene -> scene_steps -> image, loss -> train
//! ```
//!
//! A model is a view: it holds handles of the weights that it was loaded with. After a step of an optimizer it is
//! loaded again from the new ones, which copies no number.
//!
//! | module | holds |
//! |---|---|
//! | [`weights`] | [`Weights`](weights::Weights): parameters under a path, checked as they are taken |
//! | [`initial`] | weights of a model that has learned nothing |
//! | [`layers`] | linear maps, norms, perceptrons, attention |
//! | [`dinov2`] | [`Dinov2`](dinov2::Dinov2): image to tokens; loads the published weights by their names |
//! | [`encoder`] | [`Encoder`](encoder::Encoder): image to features, by DINOv2 or strided convolutions |
//! | [`decompose`] | [`Decomposer`](decompose::Decomposer): images to masks and what they show, MONet or Slot Attention; knows no shapes |
//! | [`detr`] | [`ConditionalDetr`](detr::ConditionalDetr): features to one latent per object slot |
//! | [`model`] | [`Model`](model::Model): the whole, with its seven heads |
//! | [`look`] | [`Look`](look::Look): a second look at what was found, object by object |
//! | [`scene_steps`] | predicted scenes painted and judged by the core's differentiable steps |
//! | `square` | pictures of any size on the squares that models take, and back |
//! | `there` | which slots of a predicted scene are objects: where the model is in doubt, the picture decides |
//! | [`optimize`] | OptZ and Rand-OptZ: scenes sought in the space of latents |
//! | [`propose`] | [`Proposer`](propose::Proposer): a trained model that reads pictures of any size, on the host |
//! | [`train`] | modes, steps of training, checkpoints |
//! | [`error`] | [`NetError`](error::NetError) |
//!
//! `tests/backend/published` compares DINOv2 and Conditional DETR with their public PyTorch implementations, on every
//! backend.

extern crate alloc;

pub mod decompose;
pub mod detr;
pub mod dinov2;
pub mod encoder;
pub mod error;
pub mod initial;
#[doc(hidden)]
pub mod instances;
pub mod layers;
pub mod look;
pub mod model;
pub mod optimize;
pub mod propose;
pub mod scene_steps;
mod square;
mod there;
pub mod train;
pub mod weights;
