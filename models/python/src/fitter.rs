//! Pictures to scenes, one or many, by the solver that `dvp fit` runs.

use alloc::sync::Arc;
use core::panic::AssertUnwindSafe;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::panic::catch_unwind;
use std::sync::mpsc;
use std::sync::{Mutex, PoisonError};

use dvp::format::FormatError;
use dvp::method::{Memory, load_network};
use dvp::solve::{MaskFit, MethodChoice, SolveError, Solved, Solver, Start, fit_masks};
use dvp_core::render::Compositing;
use dvp_fit::{Bank, FitOptions};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::border::{DvpError, defect, exception, in_words, refusal, unlocked};
use crate::input::{InputError, Labels, PyLabels, PySource, Source, bank};
use crate::scene::{Origin, Scene};

/// How often a run over many pictures asks whether the user has interrupted it.
const INTERRUPT_CHECK: Duration = Duration::from_millis(100);

/// Why no scene came of a picture.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FitterError {
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(transparent)]
    Format(#[from] FormatError),
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A method made ready, with its memory.
#[pyclass(frozen, module = "dvp._dvp")]
pub(crate) struct Fitter {
    solver: Solver,
    bank: Option<Arc<Bank<f32>>>,
    max_pixels: usize,
    memory: Mutex<Vec<Memory>>,
}

#[pymethods]
impl Fitter {
    #[new]
    #[pyo3(signature = (bank_text, method, max_objects, objects, start, model, seed, compositing, max_pixels))]
    #[expect(clippy::too_many_arguments, reason = "the Python half names and documents each of them")]
    fn new(
        py: Python<'_>,
        bank_text: &str,
        method: &str,
        max_objects: Option<usize>,
        objects: Option<usize>,
        start: &str,
        model: Option<std::path::PathBuf>,
        seed: u64,
        compositing: Option<&str>,
        max_pixels: usize,
    ) -> PyResult<Self> {
        let method = MethodChoice::named(method).ok_or_else(|| {
            refusal(format!("method {method:?}: must be segment, opt-iter, live, live-published, opt-p or rand-opt-p"))
        })?;
        let compositing = match compositing {
            None => None,
            Some("over") => Some(Compositing::Over),
            Some("blend") => Some(Compositing::Blend),
            Some(other) => return Err(refusal(format!("compositing {other:?}: must be over, blend or None"))),
        };
        let bank = unlocked(py, || bank(bank_text))?;
        let start = match start {
            "segment" => Start::Picture,
            "net" if bank.is_some() => {
                return Err(refusal("start=\"net\" takes the shapes that the network knows: leave bank away"));
            }
            "net" => {
                let network = load_network(model.as_deref()).map_err(|error| exception(&error))?;
                Start::Network(Arc::new(network))
            }
            folder => Start::Folder(folder.into()),
        };
        if model.is_some() && !matches!(start, Start::Network(_)) {
            return Err(refusal("model goes with start=\"net\" only"));
        }
        let defaults = FitOptions::default();
        let max_objects = max_objects.unwrap_or(defaults.max_objects);
        let options = defaults.with_bank(bank.clone()).with_max_objects(max_objects).with_compositing(compositing);
        let solver = Solver::new(method, options, start, objects, seed).map_err(|error| exception(&error))?;
        Ok(Self { solver, bank: bank.map(Arc::new), max_pixels, memory: Mutex::default() })
    }

    /// The scene of one picture.
    fn fit(&self, py: Python<'_>, source: PySource<'_>, stem: &str, coded: bool) -> PyResult<Scene> {
        let source = source.to_owned();
        unlocked(py, || {
            let mut memory = self.take();
            let scene = self.solve(&source, stem, coded, &mut memory);
            self.give(memory);
            scene
        })
    }

    /// The scenes of many pictures in their order, or the exceptions of those that failed; on `threads` threads, 0 for one per core.
    fn fit_many<'py>(
        &self,
        py: Python<'py>,
        sources: Vec<PySource<'py>>,
        stems: Vec<String>,
        coded: Vec<bool>,
        threads: usize,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let work: Vec<_> = sources.iter().map(PySource::to_owned).zip(stems).zip(coded).collect();
        drop(sources);
        let found = self.solve_all(py, &work, threads)?;
        let of = |result: Result<Scene, String>| match result {
            Ok(scene) => Ok(Bound::new(py, scene)?.into_any()),
            Err(text) => Ok(DvpError::new_err(text).into_value(py).into_bound(py).into_any()),
        };
        found.into_iter().map(of).collect()
    }

    /// The scene of another program's masks, with the colors of a picture if there is one.
    fn fit_masks(&self, py: Python<'_>, masks: PyLabels<'_>, picture: Option<PySource<'_>>) -> PyResult<Scene> {
        let (masks, picture) = (masks.to_owned(), picture.map(|picture| picture.to_owned()));
        unlocked(py, || self.masks(masks, picture.as_ref()))
    }
}

impl Fitter {
    fn solve(&self, source: &Source, stem: &str, coded: bool, memory: &mut Memory) -> Result<Scene, FitterError> {
        let picture = source.picture(self.max_pixels, coded)?;
        let Solved { fit, time, .. } = self.solver.solve(&picture, stem, memory)?;
        Ok(Scene::of_fit(&fit, &picture, Origin { bank: self.bank.clone(), labels: None, time: Some(time) })?)
    }

    fn masks(&self, masks: Labels, picture: Option<&Source>) -> Result<Scene, FitterError> {
        let (size, labels) = masks.read(self.max_pixels)?;
        let found = match picture {
            None => fit_masks(size, &labels, None)?,
            Some(source) => {
                let alpha = source.rgba(self.max_pixels)?;
                fit_masks(size, &labels, Some((source.picture(self.max_pixels, false)?, &alpha)))?
            }
        };
        let MaskFit { fit, picture, labels, .. } = found;
        Ok(Scene::of_fit(&fit, &picture, Origin { bank: None, labels: Some(labels), time: None })?)
    }

    /// Fits on threads of their own while this one listens for interrupts.
    fn solve_all(
        &self,
        py: Python<'_>,
        work: &[((Source, String), bool)],
        threads: usize,
    ) -> PyResult<Vec<Result<Scene, String>>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| exception(&FitterError::from(error)))?;
        let stop = AtomicBool::new(false);
        let one = |memory: &mut Memory, ((source, stem), coded): &((Source, String), bool)| {
            if stop.load(Ordering::Relaxed) {
                return Err("interrupted".to_owned());
            }
            let solve = || self.solve(source, stem, *coded, memory).map_err(|error| in_words(&error));
            let result = catch_unwind(AssertUnwindSafe(solve)).unwrap_or_else(|panic| Err(defect(&*panic)));
            result.map_err(|text| match source {
                Source::Path(path) if !text.starts_with(&*path.to_string_lossy()) => {
                    format!("{}: {text}", path.display())
                }
                _ => text,
            })
        };
        let (done, results) = mpsc::channel();
        let (results, pool, one) = (Mutex::new(results), &pool, &one);
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let run = || work.par_iter().map_init(Memory::default, one).collect::<Vec<_>>();
                // Nobody is left to tell if the other side has gone.
                let _ = done.send(pool.install(run));
            });
            loop {
                let next = || results.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(INTERRUPT_CHECK);
                match py.detach(next) {
                    Ok(found) => return Ok(found),
                    Err(mpsc::RecvTimeoutError::Disconnected) => {
                        return Err(refusal("the threads of the run have died"));
                    }
                    Err(mpsc::RecvTimeoutError::Timeout) => {
                        if let Err(interrupt) = py.check_signals() {
                            stop.store(true, Ordering::Relaxed);
                            // The scope waits until the pictures in work are finished.
                            return Err(interrupt);
                        }
                    }
                }
            }
        })
    }

    /// Memory of an earlier fit, or new.
    fn take(&self) -> Memory {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default()
    }

    fn give(&self, memory: Memory) {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner).push(memory);
    }
}
