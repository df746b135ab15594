//! The backends under test, and how many checks each of them passed.

use alloc::collections::BTreeMap;
use core::cell::Cell;
use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;

use dvp_core::tensor::Backend;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// How a concern ends.
pub(crate) type Outcome = Result<(), TestCaseError>;

/// A backend under test.
pub(crate) trait Tested: Backend {
    /// Where its arrays live in this suite.
    fn place() -> Self::Device;
}

/// The list of backends: type and device. Everything else follows from it.
macro_rules! backends {
    ($($backend:ty => $device:expr,)+) => {
        $(impl Tested for $backend {
            fn place() -> Self::Device {
                $device
            }
        })+

        /// Runs a generic `fn(&Tally) -> Outcome` on every backend and compares the counts.
        macro_rules! on_every_backend {
            ($check:ident) => {
                crate::registry::assert_same_counts(
                    stringify!($check),
                    &[$(crate::registry::count::<$backend>($check::<$backend>)),+],
                )
            };
        }
    };
}

backends! {
    dvp_core::tensor::Host => dvp_core::tensor::HostDevice,
    dvp_burn::Burn => <<dvp_burn::Burn as Backend>::Device>::flex(),
    dvp_candle::Candle => dvp_candle::CandleDevice::CPU,
}

#[expect(clippy::single_component_path_imports, reason = "makes the macro a name of this module")]
pub(crate) use on_every_backend;

/// Names of the backends in the list, counted as one check each.
fn name<B: Tested>(tally: &Tally) -> Outcome {
    NAMES.lock().unwrap().push(B::NAME);
    tally.check(true, String::new)
}

static NAMES: Mutex<Vec<&str>> = Mutex::new(Vec::new());

/// The list holds the host and every adapter, which are called as their folders.
#[test]
fn no_backend_is_left_out() {
    let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../backends")).unwrap();
    let folders = entries.map(Result::unwrap).filter(|entry| entry.file_type().unwrap().is_dir());
    let mut expected: Vec<String> = folders.map(|folder| folder.file_name().into_string().unwrap()).collect();
    expected.push("host".into());
    expected.sort();
    on_every_backend!(name);
    let mut names = NAMES.lock().unwrap().clone();
    names.sort_unstable();
    assert_eq!(names, expected);
}

/// Checks that a backend passed in one concern.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    checks: Cell<usize>,
}

impl Tally {
    /// Notes one comparison.
    pub(crate) fn check(&self, holds: bool, message: impl FnOnce() -> String) -> Outcome {
        self.checks.set(self.checks.get() + 1);
        if holds { Ok(()) } else { Err(TestCaseError::fail(message())) }
    }
}

/// Runs a concern on one backend: its name and how many checks it passed.
pub(crate) fn count<B: Tested>(concern: impl FnOnce(&Tally) -> Outcome) -> (&'static str, usize) {
    let tally = Tally::default();
    if let Err(error) = concern(&tally) {
        panic!("{}: {error}", B::NAME);
    }
    (B::NAME, tally.checks.get())
}

/// Fails if a backend made another number of checks than the first; prints the counts, and those of all concerns so far.
pub(crate) fn assert_same_counts(concern: &str, counts: &[(&'static str, usize)]) {
    static TOTALS: Mutex<BTreeMap<&'static str, usize>> = Mutex::new(BTreeMap::new());
    let checks = counts[0].1;
    assert!(checks > 0, "{concern} checked nothing");
    assert!(counts.iter().all(|&(_, other)| other == checks), "{concern}: not the same checks everywhere: {counts:?}");
    let mut totals = TOTALS.lock().unwrap();
    let mut line = format!("{concern}: {checks} checks on each backend; so far");
    for (name, checks) in counts {
        let total = totals.entry(name).or_default();
        *total += checks;
        line.push_str(&format!(" {name} {total}"));
    }
    // Not by a macro, whose words the harness keeps to itself when a test passes.
    line.push('\n');
    std::io::stderr().write_all(line.as_bytes()).unwrap();
}

/// Runs `check` on `cases` cases of a strategy: the same ones on every backend, every time. `PROPTEST_RNG_SEED` chooses
/// others.
pub(crate) fn for_cases<S: Strategy>(cases: u32, strategy: S, check: impl Fn(S::Value) -> Outcome) -> Outcome {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(1);
    }
    TestRunner::new(config).run(&strategy, check).map_err(|error| TestCaseError::fail(error.to_string()))
}
