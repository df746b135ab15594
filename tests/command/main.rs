//! The command tests; a module per concern.
