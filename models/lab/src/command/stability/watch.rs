//! Runs that may panic or never end.

use core::panic::AssertUnwindSafe;
use core::time::Duration;
use std::panic::catch_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};

use anyhow::{Context, Result};

/// How a piece of work ended.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Ended<R> {
    Done(R),
    Panicked,
    /// It runs on, on a thread that nobody waits for.
    NotInTime,
}

/// Does `work` on a thread of its own and waits for it, `limit` at most.
///
/// # Errors
/// If the system has no more threads.
pub(super) fn within<R: Send + 'static>(
    limit: Duration,
    work: impl FnOnce() -> R + Send + 'static,
) -> Result<Ended<R>> {
    let (sender, receiver) = channel();
    let guarded = move || {
        // Nobody listens if the time was up.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
    };
    std::thread::Builder::new().spawn(guarded).context("threads cannot be started")?;
    Ok(match receiver.recv_timeout(limit) {
        Ok(Ok(result)) => Ended::Done(result),
        Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => Ended::Panicked,
        Err(RecvTimeoutError::Timeout) => Ended::NotInTime,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_is_told() {
        let long = Duration::from_secs(60);
        assert_eq!(within(long, || 7).unwrap(), Ended::Done(7));
        assert_eq!(within(long, move || assert!(long.is_zero())).unwrap(), Ended::Panicked);
        let asleep = || std::thread::sleep(Duration::from_secs(60));
        assert_eq!(within(Duration::from_millis(20), asleep).unwrap(), Ended::NotInTime);
    }
}
