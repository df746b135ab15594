//! The gradient tests; a module per concern.
