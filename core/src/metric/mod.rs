//! Metrics: numbers from two images or two scenes, by the rules of the reference system.
