//! Networks that look at an image and propose its scene.
//!
//! In: images and named weights, [`Parameters`](dvp_core::tensor::Parameters). Out: tokens of the image and, from them,
//! one latent vector per object. Everything is written once over [`Tensor`](dvp_core::tensor::Tensor) and runs on every
//! [`Backend`](dvp_core::tensor::Backend); no framework is needed.
//!
//! A model is a view: it holds handles of the weights that it was loaded with. After a step of an optimizer it is
//! loaded again from the new ones, which copies no number.
//!
//! | module | holds |
//! |---|---|
//! | [`dinov2`] | [`Dinov2`](dinov2::Dinov2): image to tokens; loads the published weights by their names |
//! | [`detr`] | [`ConditionalDetr`](detr::ConditionalDetr): tokens to one latent per object slot |
//! | [`layers`] | what both are made of: linear maps, layer norm, perceptrons, attention |
//! | [`weights`] | [`Weights`](weights::Weights): parameters under a path, checked as they are taken |
//! | [`error`] | [`NetError`](error::NetError) |
//!
//! `tests/backend/published` compares both models with their public PyTorch implementations, on every backend.

pub mod detr;
pub mod dinov2;
pub mod error;
pub mod layers;
pub mod weights;
