//! Faint objects.

use anyhow::Result;
use dvp_core::Scene;
use rand::RngExt;

use super::Case;
use super::base::{GAP, SCALES, SIDE, apart, case, narrow, random};
use dvp_cli::command::options::square;
use dvp_cli::paint::Painter;

const OBJECTS: usize = 3;

/// Objects that differ from the background by `level` steps of 1/255 in one channel and by less in the others.
pub(super) fn faint(level: f64, seed: u64) -> Result<Case> {
    case(scene(narrow(level / 255.0), seed), SIDE)
}

/// Objects that differ from the background by `level` in one channel and by less in the others, in float pixels.
pub(super) fn faint_floats(level: f64, seed: u64) -> Result<Case> {
    let truth = scene(narrow(level), seed);
    Ok(Case { image: Painter::default().paint(&truth, square(SIDE)?)?, truth, start: None })
}

/// The same scene in every contrast: objects lie on one side of the background, whose colors are whole steps.
fn scene(contrast: f32, seed: u64) -> Scene<f32> {
    let mut rng = random(seed);
    let mut scene = apart(&mut rng, OBJECTS, SCALES, GAP);
    let side: [f32; 3] = core::array::from_fn(|_| if rng.random() { 1.0 } else { -1.0 });
    let room = scene.background.map(|value| (value * (1.0 - contrast) * 255.0).floor() / 255.0);
    scene.background = core::array::from_fn(|c| if side[c] > 0.0 { room[c] } else { 1.0 - room[c] });
    for object in &mut scene.objects {
        let full = rng.random_range(0..3);
        object.paint.set_color(core::array::from_fn(|c| {
            let share: f32 = if c == full { 1.0 } else { rng.random() };
            scene.background[c] + side[c] * share * contrast
        }));
    }
    scene
}
