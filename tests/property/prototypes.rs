//! Distances between forms see the shape alone; k-medoids finds what brute force finds.

use core::f64::consts::TAU;

use dvp_core::Efd;
use dvp_fit::prototypes::{DistanceMatrix, Form, k_medoids, silhouette};
use proptest::prelude::*;

/// Outlines without symmetry: a circle with random harmonics 1 to 5.
fn efd() -> impl Strategy<Value = Efd<f64>> {
    prop::collection::vec(prop::array::uniform4(-0.12..0.12), 5).prop_map(|mut rows| {
        rows[0][0] += 1.0;
        rows[0][3] += 1.0;
        Efd::new(rows)
    })
}

/// The same curve, started elsewhere, turned, scaled, run through in the other direction.
fn moved(efd: &Efd<f64>, [phase, rotation, scale]: [f64; 3], reverse: bool) -> Efd<f64> {
    let mut efd = efd.clone();
    efd.shift(phase);
    efd.rotate_scale(rotation, scale);
    if reverse {
        // t becomes -t: sines change their sign.
        efd.rows_mut().iter_mut().for_each(|row| *row = [row[0], -row[1], row[2], -row[3]]);
    }
    efd
}

fn mirrored(efd: &Efd<f64>) -> Efd<f64> {
    Efd::new(efd.rows().iter().map(|&[a, b, c, d]| [a, b, -c, -d]).collect())
}

fn motion() -> impl Strategy<Value = [f64; 3]> {
    (0.0..TAU, 0.0..TAU, 0.01..100.0).prop_map(|(phase, rotation, scale)| [phase, rotation, scale])
}

#[expect(clippy::unwrap_used, reason = "what fails here is a failed test")]
fn form(efd: &Efd<f64>) -> Form {
    Form::new(efd).unwrap()
}

/// How far apart the polygons of 256 edges that stand for an outline may be, in its sizes (root mean square radii), if the start is moved: a
/// moved start cuts other corners. A chord misses a curve by an eighth of the square of its step times the second derivative at most.
fn polygon(efd: &Efd<f64>) -> f64 {
    let norm = |row: &[f64; 4]| row.iter().map(|number| number * number).sum::<f64>().sqrt();
    let size = (0.5 * efd.rows().iter().map(|row| norm(row).powi(2)).sum::<f64>()).sqrt();
    let bend: f64 = efd.rows().iter().zip(1..).map(|(row, order)| f64::from(order * order) * norm(row)).sum();
    (TAU / 256.0).powi(2) / 8.0 * bend / size
}

proptest! {
    #[test]
    fn a_moved_copy_is_no_distance_away(efd in efd(), by in motion(), reverse in prop::bool::ANY) {
        let distance = form(&efd).distance(&form(&moved(&efd, by, reverse)), false);
        prop_assert!(distance < polygon(&efd), "{distance}");
    }

    #[test]
    fn a_mirrored_copy_is_no_distance_away_if_mirrors_count(efd in efd(), by in motion(), reverse in prop::bool::ANY) {
        let copy = form(&moved(&mirrored(&efd), by, reverse));
        let alignment = form(&efd).align(&copy, true);
        prop_assert!(alignment.distance < polygon(&efd), "{alignment:?}");
        let apart = form(&efd).distance(&copy, false);
        prop_assert!(apart >= alignment.distance);
        // Chiral: the distance is that to its own mirror image.
        prop_assert!((apart - form(&efd).distance(&form(&efd).mirrored(), false)).abs() < 2.0 * polygon(&efd));
    }

    #[test]
    fn distance_is_symmetric_and_keeps_the_triangle(a in efd(), b in efd(), c in efd(), mirror in prop::bool::ANY) {
        let [a, b, c] = [form(&a), form(&b), form(&c)];
        let ab = a.distance(&b, mirror);
        prop_assert!((ab - b.distance(&a, mirror)).abs() < 1e-9);
        prop_assert!(ab <= a.distance(&c, mirror) + c.distance(&b, mirror) + 1e-9);
        prop_assert!(a.distance(&a, mirror) < 1e-9);
    }

    #[test]
    fn an_alignment_lays_one_form_on_the_other(a in efd(), b in efd(), by in motion(), mirror in prop::bool::ANY) {
        let (a, b) = (form(&a), form(&moved(&b, by, false)));
        let alignment = a.align(&b, mirror);
        let laid = b.aligned(&alignment);
        // Descriptors differ by the distance: half the squared norm of the rows is the mean squared distance.
        let (p, q) = (a.efd(0.0), laid.efd(0.0));
        let squares = p.rows().iter().flatten().zip(q.rows().iter().flatten()).map(|(x, y)| (x - y).powi(2));
        prop_assert!(((squares.sum::<f64>() / 2.0).sqrt() - alignment.distance).abs() < 1e-9);
    }

    #[test]
    fn no_turn_or_start_is_closer(a in efd(), b in efd(), by in motion()) {
        let distance = form(&a).distance(&form(&b), false);
        let (p, q) = (form(&a).efd(0.0), moved(&form(&b).efd(0.0), [by[0], by[1], 1.0], false));
        let squares = p.rows().iter().flatten().zip(q.rows().iter().flatten()).map(|(x, y)| (x - y).powi(2));
        prop_assert!((squares.sum::<f64>() / 2.0).sqrt() >= distance - 1e-9);
    }

    #[test]
    fn k_medoids_equals_brute_force(points in prop::collection::vec(prop::array::uniform2(0.0..1.0), 3..8), k in 1_usize..4) {
        let distance = |i: usize, j: usize| {
            let (p, q): ([f64; 2], [f64; 2]) = (points[i], points[j]);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let distances = DistanceMatrix::new(points.len(), distance);
        let found = k_medoids(&distances, k);
        // All subsets of k points.
        let sets = (0_u32..1 << points.len()).filter(|set| set.count_ones() as usize == k.min(points.len()));
        let cost = |set: u32| -> f64 {
            (0..points.len())
                .map(|i| (0..points.len()).filter(|j| set >> j & 1 == 1).map(|j| distances.row(i)[j]).fold(f64::INFINITY, f64::min))
                .sum()
        };
        let best = sets.map(cost).fold(f64::INFINITY, f64::min);
        prop_assert!((found.cost - best).abs() < 1e-9, "{} instead of {best}", found.cost);
        let value = silhouette(&distances, &found);
        prop_assert!((-1.0..=1.0).contains(&value.mean) && value.error >= 0.0);
    }
}
