//! Which methods are run, and with which settings.

use dvp_cli::method::{Method, Precision, Setting};

/// Steps of a method in f32 and in f64, when there is time and when there is little.
struct Sweep {
    method: Method,
    single: &'static [usize],
    double: &'static [usize],
    quick_single: &'static [usize],
    quick_double: &'static [usize],
}

/// Joint steps of segment-and-fit.
const JOINT: &[usize] = &[0, 1, 2, 3, 5, 10, 20];
/// Of unknown shapes.
const HARMONICS: &[usize] = &[2, 4, 8, 16, 31];
/// Adam.
const ADAM: &[usize] = &[10, 30, 100, 300];
const NONE: &[usize] = &[];

const SWEEPS: [Sweep; 15] = {
    use Method as M;
    [
        sweep(M::SegmentBank, [JOINT, JOINT, &[0, 1, 3, 10, 20], &[10]]),
        sweep(M::SegmentFree, [HARMONICS, &[31], &[4, 8, 31], &[31]]),
        sweep(M::Lm, [&[1, 2, 3, 5, 10, 20], &[20], &[3, 20], &[20]]),
        sweep(M::LmContinuation, [&[1, 2, 3, 6, 12], &[12], &[3, 12], NONE]),
        sweep(M::OptP, [ADAM, ADAM, &[10, 100, 300], &[100]]),
        sweep(M::OptIter, [&[100, 250, 500], &[500], &[500], NONE]),
        sweep(M::OptIterPublished, [&[500], NONE, &[500], NONE]),
        sweep(M::Live, [&[20, 60, 200], &[60], &[60], NONE]),
        sweep(M::LivePublished, [&[500], NONE, &[500], NONE]),
        sweep(M::RandOptP, [&[100, 500], &[500], &[500], NONE]),
        sweep(M::RandOptZ, [&[100], NONE, &[100], NONE]),
        sweep(M::Net, [&[0], NONE, &[0], NONE]),
        sweep(M::NetLm, [&[1, 3, 12], NONE, &[12], NONE]),
        sweep(M::NetOptP, [ADAM, NONE, &[10, 100], NONE]),
        sweep(M::OptZ, [ADAM, NONE, &[10, 100], NONE]),
    ]
};

const fn sweep(method: Method, [single, double, quick_single, quick_double]: [&'static [usize]; 4]) -> Sweep {
    Sweep { method, single, double, quick_single, quick_double }
}

/// Every method with the settings that are charted.
pub(super) fn settings(quick: bool) -> Vec<(Method, Setting)> {
    let mut all = Vec::new();
    for Sweep { method, single, double, quick_single, quick_double } in &SWEEPS {
        let (single, double) = if quick { (quick_single, quick_double) } else { (single, double) };
        for (precision, steps) in [(Precision::F32, single), (Precision::F64, double)] {
            all.extend(steps.iter().map(|&steps| (*method, Setting { steps, precision })));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_method_is_charted_once_with_each_setting() {
        for quick in [false, true] {
            let all = settings(quick);
            let different: BTreeSet<_> = all.iter().collect();
            assert_eq!(different.len(), all.len());
            assert!(Method::all().iter().all(|method| all.iter().any(|(other, _)| other == method)));
            assert!(all.iter().all(|(method, setting)| method.knows(setting.precision)));
        }
    }
}
