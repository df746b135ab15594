//! The border to Python: errors as exceptions, work without the interpreter's lock, no panic that gets across.

use core::any::Any;
use core::error::Error;
use core::fmt::Display;
use core::panic::AssertUnwindSafe;
use std::ffi::OsString;
use std::io::{stderr, stdout};
use std::panic::catch_unwind;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    dvp,
    DvpError,
    PyValueError,
    "What dvp could not do: what was wrong, where, and what to do about it."
);

/// Most pixels of an image that is painted or measured: memory that cannot be had would end the process.
pub(crate) const MOST_PIXELS: usize = 1 << 28;

/// An error and its causes as one line. Causes that the text tells already are left out.
pub(crate) fn in_words(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let told = error.to_string();
        if !text.contains(&told) {
            text = format!("{text}: {told}");
        }
        cause = error.source();
    }
    text
}

/// The exception of an error.
pub(crate) fn exception(error: &(impl Error + 'static)) -> PyErr {
    DvpError::new_err(in_words(error))
}

/// The exception of a text.
pub(crate) fn refusal(text: impl Display) -> PyErr {
    DvpError::new_err(text.to_string())
}

/// The text of a panic, which is a defect.
pub(crate) fn defect(panic: &(dyn Any + Send)) -> String {
    let cause = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("a defect of dvp, please report it: {}", cause.unwrap_or("unknown"))
}

/// What `work` makes without the interpreter's lock; a panic becomes an exception.
pub(crate) fn unlocked<R: Send, E: Error + Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<R, E> + Send,
) -> PyResult<R> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(Ok(result)) => Ok(result),
        Ok(Err(error)) => Err(exception(&error)),
        Err(panic) => Err(refusal(defect(&*panic))),
    }
}

/// Runs the command with its arguments, the program's name first, on the process's own streams; returns its exit code.
#[pyfunction]
pub(crate) fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    let run = || Ok::<_, core::convert::Infallible>(dvp::command::run(arguments, &mut stdout(), &mut stderr()));
    unlocked(py, run)
}
