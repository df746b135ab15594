//! An ellipse through samples, by algebra.

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::as_f64;
use super::track::Track;

/// Center, radii and angle of the ellipse a x^2 + b x y + c y^2 + d x + e y = 1, least squares over all samples, around their mean;
/// none if it is no ellipse.
pub(super) fn ellipse(track: &Track) -> Option<[f64; 5]> {
    let count = as_f64(track.len());
    let mean = track.samples.iter().fold(Vec2::default(), |sum, sample| sum + sample.point) / count;
    let spread = track.samples.iter().map(|sample| (sample.point - mean).length_squared()).sum::<f64>() / count;
    let scale = spread.sqrt();
    let mut rows = [[0.0; 6]; 5];
    for sample in &track.samples {
        let Vec2 { x, y } = (sample.point - mean) / scale;
        let terms = [x * x, x * y, y * y, x, y];
        for (row, term) in rows.iter_mut().zip(terms) {
            row.iter_mut().zip(terms).for_each(|(entry, other)| *entry += term * other);
            row[5] += term;
        }
    }
    let [a, b, c, d, e] = eliminate(&mut rows)?;
    let determinant = 4.0 * a * c - b * b;
    if determinant <= 0.0 {
        return None;
    }
    let (x, y) = ((b * e - 2.0 * c * d) / determinant, (b * d - 2.0 * a * e) / determinant);
    // Around its center: a x^2 + b x y + c y^2 = level.
    let level = 1.0 - 0.5 * (d * x + e * y);
    let angle = 0.5 * b.atan2(a - c);
    let (half_sum, half_difference) = (0.5 * (a + c), 0.5 * (a - c).hypot(b));
    let radii = [level / (half_sum + half_difference), level / (half_sum - half_difference)]
        .map(|square| square.sqrt() * scale);
    let center = mean + Vec2::new(x, y) * scale;
    let found = [center.x, center.y, radii[0], radii[1], angle];
    found.iter().all(|number| number.is_finite()).then_some(found)
}

/// Solves five equations, the last column their right-hand side, with pivots.
fn eliminate(rows: &mut [[f64; 6]; 5]) -> Option<[f64; 5]> {
    for column in 0..5 {
        let pivot = (column..5).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))?;
        rows.swap(column, pivot);
        if rows[column][column].abs() < 1e-12 {
            return None;
        }
        for row in 0..5 {
            if row != column {
                let share = rows[row][column] / rows[column][column];
                let other = rows[column];
                rows[row].iter_mut().zip(other).for_each(|(entry, other)| *entry -= share * other);
            }
        }
    }
    Some(core::array::from_fn(|k| rows[k][5] / rows[k][k]))
}
