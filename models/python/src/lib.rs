//! The native half of the Python package `dvp`.
//!
//! In: arrays, bytes, paths and texts, as `python/dvp` has checked and laid them out. Out: arrays, texts and [`Scene`](scene::Scene)s. All
//! that is found is found by the crate `dvp`, as the command finds it; nothing is worked out here but how it crosses the border.
//!
//! | file | holds |
//! |---|---|
//! | `border.rs` | `DvpError`, work without the interpreter's lock, panics turned to errors |
//! | `input.rs` | pictures, label maps and banks as Python hands them over |
//! | `fitter.rs` | `Fitter`: one picture or many to scenes |
//! | `scene.rs` | `Scene`: what was found, in every form that the command writes |
//! | `table.rs` | measures of many scenes by columns |
//! | `descriptors.rs` | descriptors of contours |
//! | `samples.rs` | random scenes, and scores of scenes |
//! | `step.rs` | scenes as numbers to images or losses, and the way back |
//! | `step_py.rs` | the same for Python, in either precision |
//!
//! Proved by `tests/`, in Python.

extern crate alloc;

mod border;
mod descriptors;
mod fitter;
mod input;
mod samples;
mod scene;
mod step;
mod step_py;
mod table;

use pyo3::prelude::*;

/// The native half of `dvp`; not to be used by itself.
#[pymodule]
fn _dvp(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("DvpError", module.py().get_type::<border::DvpError>())?;
    module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<fitter::Fitter>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<step_py::SceneStep>()?;
    module.add_function(wrap_pyfunction!(table::columns, module)?)?;
    module.add_function(wrap_pyfunction!(descriptors::efd, module)?)?;
    module.add_function(wrap_pyfunction!(samples::generate, module)?)?;
    module.add_function(wrap_pyfunction!(samples::evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(border::run_command, module)?)
}
