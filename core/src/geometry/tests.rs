#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use super::Vec2;

#[test]
fn turning_multiplies_complex_numbers() {
    let (a, b) = (Vec2::new(3.0, 4.0), Vec2::new(0.0, 2.0));
    // (3 + 4i) 2i = -8 + 6i.
    assert_eq!(a.turned(b), Vec2::new(-8.0, 6.0));
    assert_eq!(a.perp(), Vec2::new(-4.0, 3.0));
    assert_eq!((a.length(), a.dot(b), a.cross(b)), (5.0, 8.0, 6.0));
    assert_eq!(Vec2::<f64>::default().normalized(), None);
    assert_eq!(a.normalized(), Some(Vec2::new(0.6, 0.8)));
    assert_eq!(a.lerp(b, 0.5).to_array(), [1.5, 3.0]);
}
