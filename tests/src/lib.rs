//! What the tests share: strategies, finite differences, golden numbers.
