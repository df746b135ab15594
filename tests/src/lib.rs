//! What the tests share: strategies, finite differences, golden numbers.

pub mod finite_difference;
pub mod strategy;
