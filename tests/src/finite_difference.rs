//! Central differences in f64, the judge of every vjp.

use core::fmt::Write as _;

/// Compares `grad` with central differences of `f` at `x`, lane by lane; all lanes that fail are in one message.
///
/// A lane passes if it agrees to `tolerance` x (1 + the largest of both gradients). The step is that of [`step`]: an
/// error of about 1e-12 from the third derivative, and 1e-10 x |f| from rounding.
///
/// # Errors
/// The lanes that disagree, with both numbers.
pub fn compare(x: &[f64], grad: &[f64], tolerance: f64, f: impl FnMut(&[f64]) -> f64) -> Result<(), String> {
    compare_by(step, x, grad, tolerance, f)
}

/// [`compare`] by steps of another length.
///
/// # Errors
/// The lanes that disagree, with both numbers.
pub fn compare_by(
    step: impl Fn(f64) -> f64,
    x: &[f64],
    grad: &[f64],
    tolerance: f64,
    mut f: impl FnMut(&[f64]) -> f64,
) -> Result<(), String> {
    if x.is_empty() || x.len() != grad.len() {
        return Err(format!("{} inputs, {} gradients", x.len(), grad.len()));
    }
    let mut moved = x.to_vec();
    let mut numeric = Vec::with_capacity(x.len());
    for lane in 0..x.len() {
        let step = step(x[lane]);
        moved[lane] = x[lane] + step;
        let above = f(&moved);
        moved[lane] = x[lane] - step;
        let below = f(&moved);
        moved[lane] = x[lane];
        numeric.push((above - below) / (2.0 * step));
    }
    let largest = numeric.iter().chain(grad).fold(0.0_f64, |largest, g| largest.max(g.abs()));
    let mut message = String::new();
    for (lane, (numeric, analytic)) in numeric.iter().zip(grad).enumerate() {
        // Written so that a NaN fails.
        if (numeric - analytic).abs() <= tolerance * (1.0 + largest) {
            continue;
        }
        let _ = write!(message, "lane {lane}: vjp {analytic:e}, differences {numeric:e}; ");
    }
    if message.is_empty() { Ok(()) } else { Err(message) }
}

/// Whether differences over steps of several lengths agree. Near cusps and where a smooth arc all but turns back, vertices move
/// faster than differences can follow.
#[must_use]
pub fn are_steady(x: &[f64], f: &mut dyn FnMut(&[f64]) -> f64) -> bool {
    let mut moved = x.to_vec();
    (0..x.len()).all(|lane| {
        let [short, long] = [1.0, 3.0].map(|factor| {
            let step = factor * step(x[lane]);
            let [below, above] = [-step, step].map(|step| {
                moved[lane] = x[lane] + step;
                f(&moved)
            });
            moved[lane] = x[lane];
            (above - below) / (2.0 * step)
        });
        (short - long).abs() <= 1e-6 * (1.0 + short.abs())
    })
}

/// How far [`compare`] moves `x` to either side.
#[must_use]
pub fn step(x: f64) -> f64 {
    1e-6 * (1.0 + x.abs())
}

/// The dot product of two slices: the scalar that a cotangent makes of an output.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn a_wrong_gradient_is_found() {
        // d/dx (x0^2 + 3 x1) = (2 x0, 3).
        let f = |x: &[f64]| x[0] * x[0] + 3.0 * x[1];
        assert_eq!(compare(&[2.0, 5.0], &[4.0, 3.0], 1e-8, f), Ok(()));
        assert!(compare(&[2.0, 5.0], &[4.0, 3.001], 1e-8, f).unwrap_err().starts_with("lane 1"));
        assert!(compare(&[2.0, 5.0], &[f64::NAN, 3.0], 1e-8, f).unwrap_err().starts_with("lane 0"));
    }
}
