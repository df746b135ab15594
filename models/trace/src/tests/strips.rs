//! What others hide but for strips so narrow that no window reads their ends.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Object;
use dvp_core::shape::{AnyShape, FillRule, Path, PathRing};

use super::{error, found, object, paint, scene};

const WATER: [f32; 3] = [0.725, 0.982, 0.876];
const BROWN: [f32; 3] = [0.55, 0.35, 0.09];
const GREEN: [f32; 3] = [0.31, 0.67, 0.58];
const BLUE: [f32; 3] = [0.29, 0.51, 0.95];

/// A shape with an opening.
fn pierced(scale: f64, outer: &[[f64; 2]], opening: &[[f64; 2]]) -> AnyShape<f64> {
    let ring = |points: &[[f64; 2]]| PathRing::polygon(points.iter().map(|point| point.map(|c| c * scale)).collect());
    AnyShape::Path(Path { rings: vec![ring(outer), ring(opening)], fill: FillRule::EvenOdd })
}

fn triangle(scale: f64) -> AnyShape<f64> {
    let outer = [[-0.5, -7.5], [0.5, -7.5], [14.0, 6.0], [14.0, 7.5], [-14.0, 7.5], [-14.0, 6.0]];
    pierced(scale, &outer, &[[-0.5, -1.5], [-5.5, 3.5], [5.5, 3.5], [0.5, -1.5]])
}

fn square(scale: f64) -> AnyShape<f64> {
    let corners = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
    pierced(scale, &corners(7.0), &corners(3.0))
}

#[test]
fn what_is_seen_around_and_within_another_thing_is_one() {
    // The green triangle looks out from behind the blue one by four rows below it and by a corner in its opening.
    let made = scene(
        WATER,
        vec![
            object(square(1.2175), [51.523, 21.523], 0.0, BROWN),
            object(triangle(1.033), [29.462, 22.748], 0.0, GREEN),
            object(triangle(1.3331), [29.663, 13.998], 0.0, BLUE),
        ],
    );
    let picture = paint(&made);
    let found = found(&picture);
    let colors: Vec<[f32; 3]> = found.objects.iter().map(Object::color).collect();
    assert_eq!(colors.len(), 3, "{colors:?}");
    for wanted in [BROWN, GREEN, BLUE] {
        assert!(colors.iter().any(|color| color.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.02)), "{colors:?}");
    }
    assert!(error(&picture, &found) < 2e-3);
}
