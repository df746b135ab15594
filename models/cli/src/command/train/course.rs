//! The steps of a run, whatever is trained.

use std::time::Instant;

use anyhow::Result;
use dvp_net::train::Batch;

use super::curves::{Curves, Entry};
use super::job::Numbers;
use super::settings::Settings;
use super::store::Store;
use crate::command::{Console, Outcome, progress};
use crate::format::{BitDepth, encode_png, write_atomic};

/// Steps between lines of the curves.
const LINE_EVERY: u64 = 10;

/// What is trained, and with what.
pub(super) trait Course {
    /// Steps made.
    fn steps(&self) -> u64;
    /// How many numbers are trained.
    fn numbers(&self) -> usize;
    /// Makes the next step.
    fn step(&mut self) -> Result<Made>;
    /// What it makes of the validation images: two errors, of which the first judges the run, and samples to be drawn.
    fn look(&self) -> Result<Seen>;
    /// The bytes of its file; with what `--resume` needs if `resumable`.
    fn file(&self, resumable: bool, about: &str) -> Result<Vec<u8>>;
}

/// What a step came to.
pub(super) struct Made {
    pub(super) loss: f64,
    /// Two of the terms of the loss.
    pub(super) terms: [Option<f64>; 2],
    /// Length of the gradient.
    pub(super) gradient: f64,
    pub(super) rate: f64,
}

/// What the validation images came to.
pub(super) struct Seen {
    pub(super) errors: [Option<f64>; 2],
    /// Samples, side by side.
    pub(super) sheet: dvp_core::Image<f32>,
}

/// Makes all steps that are left, and writes what they leave. `judged`: what the first error of the validation images is.
pub(super) fn follow(
    course: &mut impl Course,
    settings: &Settings,
    mut curves: Curves,
    held_out: &Batch<f32>,
    judged: &str,
    store: &Store,
    console: &mut Console<'_>,
) -> Result<Outcome> {
    let numbers = Numbers::of(settings);
    let (clock, before) = (Instant::now(), curves.seconds());
    let bar = progress::bar(numbers.steps, course.steps());
    let mut recent = Recent::default();
    let about = serde_json::to_string(settings)?;
    while course.steps() < numbers.steps {
        let Made { loss, terms, gradient, rate } = course.step()?;
        recent.add(loss);
        let step = course.steps();
        let save = step.is_multiple_of(numbers.save_every) || step == numbers.steps;
        if save || step.is_multiple_of(LINE_EVERY) {
            let seen = if save { look(course, store)? } else { [None; 2] };
            let improved = save && curves.best().is_none_or(|best| seen[0] < Some(best));
            let (loss, seconds) = (recent.take(), before + clock.elapsed().as_secs_f64());
            curves.push(&Entry { step, loss, terms, gradient, rate, seconds, seen });
            bar.set_message(format!("loss {loss:.4}"));
            if save {
                store.keep(step, &curves, improved, |resumable| course.file(resumable, &about))?;
            }
        }
        bar.set_position(step);
    }
    bar.finish_and_clear();
    let seconds = before + clock.elapsed().as_secs_f64();
    writeln!(console.out, "{} numbers, {}", course.numbers(), numbers.made(course.steps(), seconds))?;
    let best = curves.best().unwrap_or(f64::NAN);
    writeln!(console.out, "{judged} on {} validation images: {best:.5}", held_out.images.len())?;
    writeln!(console.out, "{}", store.path("best.safetensors").display())?;
    Ok(Outcome::Done)
}

/// Looks at the validation images, and draws some.
fn look(course: &impl Course, store: &Store) -> Result<[Option<f64>; 2]> {
    let Seen { errors, sheet } = course.look()?;
    let path = store.path("samples").join(format!("{:08}.png", course.steps()));
    write_atomic(&path, &encode_png(sheet.view(), BitDepth::Eight)?)?;
    Ok(errors)
}

/// The mean loss since the last line.
#[derive(Default)]
struct Recent {
    sum: f64,
    count: f64,
}

impl Recent {
    fn add(&mut self, loss: f64) {
        self.sum += loss;
        self.count += 1.0;
    }

    fn take(&mut self) -> f64 {
        let mean = self.sum / self.count.max(1.0);
        *self = Self::default();
        mean
    }
}
