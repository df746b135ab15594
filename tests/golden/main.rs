//! The golden tests; a module per concern.
