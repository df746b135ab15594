//! Invariants of hard coverage.

use dvp_core::ImageSize;
use dvp_core::render::HardMask;
use dvp_tests::coverage::coverage;
use dvp_tests::strategy;
use proptest::prelude::*;

const SIDE: usize = 24;

fn mask(outline: &[[f64; 2]]) -> Vec<f64> {
    coverage(HardMask, outline, ImageSize::new(SIDE, SIDE).unwrap()).unwrap()
}

/// Even-odd by the sum of angles to a point: the winding number, without rays.
fn winding(outline: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let turns = outline.iter().zip(next).map(|(a, b)| {
        let (ax, ay, bx, by) = (a[0] - x, a[1] - y, b[0] - x, b[1] - y);
        (ax * by - ay * bx).atan2(ax * bx + ay * by)
    });
    turns.sum::<f64>() / core::f64::consts::TAU
}

proptest! {
    #[test]
    fn agrees_with_the_winding_number(outline in prop::collection::vec(prop::array::uniform2(-6.0..30.0), 3..12)) {
        for (i, &inside) in mask(&outline).iter().enumerate() {
            let center = [i % SIDE, i / SIDE].map(|at| f64::from(u32::try_from(at).unwrap()) + 0.5);
            let turns = winding(&outline, center).round();
            let odd = turns.rem_euclid(2.0);
            prop_assert!((odd - inside).abs() < 1e-6, "pixel {i}: winding {odd}, coverage {inside}");
        }
    }

    #[test]
    fn neighbors_share_no_pixel(cut in prop::collection::vec(0_u8..48, 2..12)) {
        // Two halves of the image on either side of a polyline, whose corners are often pixel centers.
        let rows = f64::from(u32::try_from(cut.len() - 1).unwrap());
        let polyline: Vec<_> =
            (0_u32..).zip(&cut).map(|(i, &x)| [f64::from(x) / 2.0, f64::from(i) * 24.0 / rows]).collect();
        let mut left = polyline.clone();
        left.extend([[0.0, 24.0], [0.0, 0.0]]);
        let mut right = polyline;
        right.extend([[24.0, 24.0], [24.0, 0.0]]);
        for (l, r) in mask(&left).iter().zip(mask(&right)) {
            prop_assert!((l + r - 1.0).abs() < 1e-12, "{l} and {r}");
        }
    }

    #[test]
    fn is_zero_or_one(outline in strategy::wild_outline()) {
        prop_assert!(mask(&outline).iter().all(|&p| [0.0, 1.0].contains(&p)));
    }
}
