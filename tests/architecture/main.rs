//! The architecture tests; a module per concern.
