//! Losses: a number and its gradient from two images or two scenes.
