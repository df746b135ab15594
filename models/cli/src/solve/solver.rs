//! One picture to one fit, by the chosen method.

use alloc::sync::Arc;
use core::panic::AssertUnwindSafe;
use core::time::Duration;
use std::panic::catch_unwind;
use std::path::PathBuf;

use dvp_fit::picture::Known;
use dvp_fit::{Bank, Fit, FitOptions};
use dvp_net::propose::Proposer;

use super::choice::MethodChoice;
use super::error::SolveError;
use crate::format::{Picture, Place, read_scene};
use crate::method::{Found, Memory, Method, Runner, Task, Tools, seed_of};

/// What a fit starts from.
#[derive(Clone, Debug)]
pub enum Start {
    /// What the method makes of the picture itself.
    Picture,
    /// What a network sees.
    Network(Arc<Proposer>),
    /// A folder of `{stem}.json`.
    Folder(PathBuf),
}

/// What was found in a picture.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Solved {
    /// The scene, and what is known of its numbers.
    pub fit: Fit<f32>,
    /// Processor time of the fit alone, with the cutting of openings, on this thread.
    pub time: Duration,
}

/// Everything that a method needs, shared between threads.
#[derive(Debug)]
pub struct Solver {
    runner: Runner,
    start: Start,
    object_count: Option<usize>,
    segment_count: Option<usize>,
    seed: u64,
}

/// Objects of a random start, where nobody says how many there are.
const RANDOM_OBJECTS: usize = 4;

impl Solver {
    /// A method with its options; `object_count` objects for methods that cannot tell how many there are (none: 4; LIVE at
    /// most 8, or the 5 of its published settings), random starts drawn from `seed`.
    ///
    /// # Errors
    /// [`SolveError::Usage`] for a method and a start that do not go together, [`SolveError::Method`] for options out of range.
    pub fn new(
        choice: MethodChoice,
        options: FitOptions<f32>,
        start: Start,
        object_count: impl Into<Option<usize>>,
        seed: u64,
    ) -> Result<Self, SolveError> {
        let method = choice.method(&start, options.bank.is_some())?;
        let network = match &start {
            Start::Network(network) => Some(Arc::clone(network)),
            _ => None,
        };
        let runner = Runner::new(method, method.default_setting(), &Tools { options, network })?;
        let object_count = object_count.into().or((method == Method::RandOptP).then_some(RANDOM_OBJECTS));
        Ok(Self { runner, start, object_count, segment_count: None, seed })
    }

    /// The same with so many cubics for each path of LIVE; none: 4.
    #[must_use]
    pub fn with_segments(self, segment_count: Option<usize>) -> Self {
        Self { segment_count, ..self }
    }

    /// The fit of a picture, with the openings of a transparent one cut out. `stem` names it: for [`Start::Folder`] its scene is
    /// `{stem}.json`, and random starts differ by it.
    ///
    /// # Errors
    /// [`SolveError`]; of a panic in the fit [`SolveError::Defect`], with `memory` as new.
    pub fn solve(&self, picture: &Picture<f32>, stem: &str, memory: &mut Memory) -> Result<Solved, SolveError> {
        let start = match &self.start {
            Start::Folder(folder) => {
                let path = folder.join(format!("{stem}.json"));
                Some(read_scene(&path)?.to_scene(self.bank(), &Place::file(&path))?)
            }
            _ => None,
        };
        let matte = picture.transparent.then_some(picture.matte);
        let known = Known::default().with_matte(matte).with_coded(picture.coded);
        let task = Task {
            known: Some(known),
            start: start.as_ref(),
            objects: self.object_count,
            segments: self.segment_count,
            seed: seed_of(stem, self.seed),
            ..Task::of(picture.image.view())
        };
        // A defect in the fit of one picture must not cost the others.
        let Ok(found) = catch_unwind(AssertUnwindSafe(|| self.runner.run(&task, memory))) else {
            *memory = Memory::default();
            return Err(SolveError::Defect);
        };
        let Found { fit, cpu, .. } = found?;
        Ok(Solved { fit, time: cpu })
    }

    /// The known shapes.
    #[must_use]
    pub fn bank(&self) -> Option<&Bank<f32>> {
        self.runner.tools().options.bank.as_ref()
    }
}
