//! Processor time.

use core::time::Duration;

use cpu_time::ThreadTime;

use super::error::ClockError;

/// What `work` makes, and the processor time that it took on this thread.
///
/// # Errors
/// Those of `work`, and [`ClockError`] if the system has no thread clock.
pub fn timed<R, E: From<ClockError>>(work: impl FnOnce() -> Result<R, E>) -> Result<(R, Duration), E> {
    let clock = ThreadTime::try_now().map_err(|_| ClockError)?;
    let result = work()?;
    Ok((result, clock.try_elapsed().map_err(|_| ClockError)?))
}
