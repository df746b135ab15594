use super::*;

/// A regular polygon of 64 edges around (20, 20), its edges' middles 10 px away, with a sample on each.
fn polygon() -> (Vec<[f64; 2]>, Vec<EdgeSample<f64>>) {
    let step = core::f64::consts::TAU / 64.0;
    let at = |angle: f64, radius: f64| [20.0 + radius * angle.cos(), 20.0 + radius * angle.sin()];
    let radius = 10.0 / (0.5 * step).cos();
    let outline = (0..=64_u32).map(|i| at(f64::from(i) * step, radius)).collect();
    let middles = (0..64_u32).map(|i| at((f64::from(i) + 0.5) * step, 10.0));
    (outline, middles.map(|point| EdgeSample { point, distance: 0.0, weight: 0.5 }).collect())
}

/// What is asked of the polygon: of a known shape under a known profile.
fn known<'a>(outline: &'a [[f64; 2]], samples: &'a [EdgeSample<f64>]) -> Outlined<'a, f64> {
    let (center, unit_px, pixel_noise) = ([20.0, 20.0], 40.0, 0.003);
    Outlined { outline, center, samples, unit_px, pixel_noise, blur_px: 0.0, is_free: false, area: 1e3 }
}

fn of(object: &Outlined<'_, f64>) -> [f64; 25] {
    covariance(object, &mut EdgeLanes::default()).0
}

/// Variances of x and log scale of the polygon where its samples have a variance (px^2) of their own and miss so much alike (px^2).
///
/// Position: 32 of 64 samples count (mean of cos^2), 40 px per unit. Log scale: 10 px per unit. What the whole outline misses only makes it
/// larger; what an eighth of it misses moves it by the mean normal of that eighth, and makes it larger by an eighth of it.
fn expected(own: f64, alike: f64) -> [f64; 2] {
    let mean = |arc: u32| {
        (0..8).map(|i| (f64::from(8 * arc + i) + 0.5) * core::f64::consts::TAU / 64.0).map(f64::cos).sum::<f64>()
    };
    let shift = (0..8).map(mean).map(|sum| (sum / 32.0).powi(2)).sum::<f64>();
    [(own / 32.0 + alike * shift) / 1600.0, (own / 64.0 + alike * (1.0 + 1.0 / 8.0)) / 100.0]
}

#[test]
fn of_a_disk() {
    let (outline, samples) = polygon();
    let found = of(&known(&outline, &samples));
    // Each sample tells its distance to 0.003 / 0.5 px. The angle is as unknown as before.
    let [x, scale] = expected((0.003_f64 / 0.5).powi(2), SYSTEMATIC_PX * SYSTEMATIC_PX);
    for (i, expected) in [x, x, scale, 3.29].into_iter().enumerate() {
        assert!((found[6 * i] - expected).abs() < 1e-6 * expected, "{i}: {} is not {expected}", found[6 * i]);
        for j in (0..4).filter(|&j| j != i) {
            assert!(found[5 * i + j].abs() < 1e-6 * (found[6 * i] * found[6 * j]).sqrt(), "{i}, {j}");
        }
    }
    // Without samples nothing is known.
    let found = of(&known(&outline, &[]));
    assert!((found[0] - 1.0).abs() < 1e-12 && (found[18] - 3.29).abs() < 1e-12);
}

#[test]
fn what_is_missed_beyond_the_noise_is_missed_alike() {
    let (outline, samples) = polygon();
    let off: Vec<EdgeSample<f64>> = samples.iter().map(|sample| EdgeSample { distance: 0.03, ..*sample }).collect();
    let own = (0.003_f64 / 0.5).powi(2);
    let [x, scale] = expected(own, 0.03 * 0.03 - own + SYSTEMATIC_PX * SYSTEMATIC_PX);
    let found = of(&known(&outline, &off));
    assert!((found[0] / x - 1.0).abs() < 1e-6, "{} is not {x}", found[0]);
    assert!((found[12] / scale - 1.0).abs() < 1e-6, "{} is not {scale}", found[12]);
}

#[test]
fn a_blur_makes_disks_smaller() {
    let (outline, samples) = polygon();
    let clear = known(&outline, &samples);
    let blurred = of(&Outlined { blur_px: 2.0, ..clear })[12] - of(&clear)[12];
    // 2^2 / (2 * 10) px of 10 px.
    assert!((blurred.sqrt() / 0.02 - 1.0).abs() < 0.01, "{blurred}");
}

#[test]
fn what_no_sample_tells_is_a_guess_of_free_outlines() {
    let (outline, samples) = polygon();
    // The right half: edges that begin between -90 and 90 degrees have no sample.
    let left: Vec<_> = samples.into_iter().filter(|sample| sample.point[0] < 20.0).collect();
    let known = known(&outline, &left);
    let free = Outlined { is_free: true, ..known };
    let [known, free] = [known, free].map(|object| of(&object));
    // Half of the circumference: a triangle over it has 1/8 of its square, the disk is off by half of that share, and the pixel bends.
    let (run, area) = (10.0 * core::f64::consts::PI, 100.0 * core::f64::consts::PI);
    let share = run * run / 8.0 / area;
    let scale = (0.5 * share).powi(2) + (0.25_f64 / 100.0).powi(2);
    assert!(((free[12] - known[12]) / scale - 1.0).abs() < 0.01, "{} is not {scale}", free[12] - known[12]);
    // The center goes where the area goes: 10 px to the right.
    let shift = (share * 10.0 / 40.0).powi(2);
    assert!(((free[0] - known[0]) / shift - 1.0).abs() < 0.01, "{} is not {shift}", free[0] - known[0]);
    assert!((free[6] - known[6]).abs() < 1e-3 * shift, "{} is not 0", free[6] - known[6]);
}

#[test]
fn samples_at_corners_of_a_known_square_miss_nothing() {
    let outline = [[10.0, 10.0], [30.0, 10.0], [30.0, 30.0], [10.0, 30.0], [10.0, 10.0]];
    let near = |v: f64| v.clamp(10.0, 30.0);
    let is_beside = |v: f64| !(10.0..=30.0).contains(&v);
    let places = (0..24).flat_map(|i| (0..24).map(move |j| [8.25 + f64::from(i), 8.25 + f64::from(j)]));
    let outside = places.filter(|p| p.iter().any(|&v| is_beside(v)));
    let samples: Vec<EdgeSample<f64>> = outside
        .map(|point| {
            let distance = (point[0] - near(point[0])).hypot(point[1] - near(point[1]));
            EdgeSample { point, distance, weight: 0.5 }
        })
        .collect();
    let corners = samples.iter().filter(|sample| sample.point.iter().all(|&v| is_beside(v))).count();
    assert!(corners >= 16, "{corners}");
    let of = |samples: &[EdgeSample<f64>], is_free| {
        let object = Outlined { is_free, ..known(&outline, samples) };
        covariance(&object, &mut EdgeLanes::default())
    };
    let (found, iou) = of(&samples, false);
    // What the pixels leave open, and no more: each tells a distance to .003 / .5 px.
    let own = (0.003_f64 / 0.5).powi(2);
    assert!(found[12].sqrt() < 2.0 * (own + SYSTEMATIC_PX * SYSTEMATIC_PX).sqrt() / 10.0, "{}", found[12].sqrt());
    assert!(iou > 0.9985, "{iou}");
    // A shape of its own may have other corners: its place is open, what is seen of it is not, but for what bends within a pixel: .25 pi / 400 of its size.
    let (free, own_iou) = of(&samples, true);
    assert!(free[0] > 4.0 * found[0] && own_iou > 0.9985 - 2e-3, "{} and {}, {own_iou}", free[0], found[0]);
    assert!(of(&[], false).1.abs() < 1e-12);
}

/// Disks whose center and radius are drawn from a covariance, by their quantiles, agree with the one that was found as it expects.
#[test]
fn expected_iou_is_that_of_displaced_disks() {
    let (outline, _) = polygon();
    for [shift_px, log_scale] in [[0.1, 0.0], [0.0, 0.02], [0.4, 0.03], [1.0, 0.05]] {
        let mut block = [0.0; 16];
        (block[0], block[5], block[10]) =
            ((shift_px / 40.0_f64).powi(2), (shift_px / 40.0_f64).powi(2), log_scale * log_scale);
        let displaced = Displaced {
            outline: &outline,
            center: [20.0, 20.0],
            unit_px: 40.0,
            covariance: &block,
            stride: 4,
            own: 0.0,
        };
        let length = core::f64::consts::TAU * 10.0;
        let expected = displaced.expected_iou(|_| true, length, 5.0 * length);
        let iou = |dx: f64, dy: f64, growth: f64| {
            let radius = |k: u32| {
                let angle = f64::from(k) * core::f64::consts::TAU / 90.0;
                10.0 + dx * angle.cos() + dy * angle.sin() + 10.0 * growth
            };
            let sum = |of: fn(f64, f64) -> f64| (0..90).map(|k| of(10.0, radius(k)).powi(2)).sum::<f64>();
            sum(f64::min) / sum(f64::max)
        };
        let fine: Vec<(f64, f64)> =
            (0..21).map(|k| f64::from(k - 10) * 0.4).map(|z| (z, (-0.5 * z * z).exp())).collect();
        let total: f64 = fine.iter().map(|(_, weight)| weight).sum();
        let mut mean = 0.0;
        for &(a, p) in &fine {
            for &(b, q) in &fine {
                for &(c, r) in &fine {
                    mean += p * q * r / total.powi(3) * iou(a * shift_px, b * shift_px, c * log_scale);
                }
            }
        }
        assert!(
            (expected - mean).abs() < 0.1 * (1.0 - mean) + 1e-4,
            "{shift_px}, {log_scale}: {expected} is not {mean}"
        );
        // Half of it is seen: as much is expected of the half.
        let half = displaced.expected_iou(|k| k < 32, 0.5 * length, 2.5 * length);
        assert!((half - expected).abs() < 0.02 * (1.0 - expected), "{half} is not {expected}");
    }
}
