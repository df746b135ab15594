//! Resampling along one axis.

/// Weights of samples in one of those that are made of them: of sample `start` and the ones that follow it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Taps {
    pub(crate) start: usize,
    /// Sum to 1.
    pub(crate) weights: Vec<f64>,
}

/// How each of `to` samples is made of `from`, both at least 1.
///
/// Sample k lies at k + 1/2 of as many; where samples get fewer, the kernel is stretched by as much, so that none is
/// passed over.
pub(crate) fn taps(from: usize, to: usize) -> Vec<Taps> {
    let step = from as f64 / to as f64;
    let stretch = step.max(1.0);
    // The kernel is 0 beyond 2.
    let reach = 2 * from.div_ceil(to) + 1;
    let one = |k: usize| {
        let center = step * (k as f64 + 0.5);
        let nearest = from * (2 * k + 1) / (2 * to);
        let start = nearest.saturating_sub(reach);
        let row: Vec<f64> =
            (start..from.min(nearest + reach + 1)).map(|j| cubic((j as f64 + 0.5 - center) / stretch)).collect();
        let sum: f64 = row.iter().sum();
        Taps { start, weights: row.iter().map(|weight| weight / sum).collect() }
    };
    (0..to).map(one).collect()
}

/// [`taps`] as a matrix, `to` x `from`.
pub(crate) fn bicubic(from: usize, to: usize) -> Vec<f64> {
    let mut weights = vec![0.0; from * to];
    for (Taps { start, weights: own }, row) in taps(from, to).iter().zip(weights.chunks_exact_mut(from)) {
        row[*start..start + own.len()].copy_from_slice(own);
    }
    weights
}

/// Keys' cubic kernel of slope -1/2 at 1: 1 at 0, 0 at the other whole numbers and beyond 2.
///
/// *Source*: Keys: Cubic convolution interpolation for digital image processing (1981), eq. 15.
fn cubic(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        (1.5 * x - 2.5) * x * x + 1.0
    } else if x < 2.0 {
        ((2.5 - 0.5 * x) * x - 4.0) * x + 2.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_comes_out_unchanged_for_its_own_extents() {
        let identity: Vec<f64> = (0..16).map(|k| if k % 5 == 0 { 1.0 } else { 0.0 }).collect();
        assert_eq!(bicubic(4, 4), identity);
    }

    #[test]
    fn resampling_by_hand() {
        // 2 samples as 4: the first of 4 lies at 1/4, 1/4 before sample 0 (at 1/2) and 5/4 before sample 1.
        // cubic(1/4) = 1.5/64 - 2.5/16 + 1 = 0.8671875; cubic(5/4) = -0.5 125/64 + 2.5 25/16 - 5 + 2 = -0.0703125.
        let sum = 0.8671875 - 0.0703125;
        let up = bicubic(2, 4);
        assert!((up[0] - 0.8671875 / sum).abs() < 1e-15 && (up[1] + 0.0703125 / sum).abs() < 1e-15, "{up:?}");
        // 4 samples as 1, at 2: the kernel is 4 times as wide; distances 3/2, 1/2, 1/2, 3/2 count as 3/8 and 1/8.
        // cubic(3/8) = 1.5 27/512 - 2.5 9/64 + 1 = 0.7275390625; cubic(1/8) = 1.5/512 - 2.5/64 + 1 = 0.9638671875.
        let sum = 2.0 * (0.7275390625 + 0.9638671875);
        let down = bicubic(4, 1);
        for (found, expected) in down.iter().zip([0.7275390625, 0.9638671875, 0.9638671875, 0.7275390625]) {
            assert!((found - expected / sum).abs() < 1e-15, "{down:?}");
        }
    }
}
