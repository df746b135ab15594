//! Both models against their public PyTorch implementations, on small random weights: `tests/golden_data/models`, where
//! `make_models.py` says how the outputs were made.
#![expect(clippy::unwrap_used, reason = "what fails here is a failed test, in functions of the tests too")]

mod backends;
mod detr;
mod dinov2;
mod published;
