//! The price on cubics that turn back on themselves: LIVE's self-crossing (Xing) loss.
//!
//! In: paths. Out: a number and its gradient by the numbers of the paths. A cubic with the points A, B, C, D does not cross
//! itself if its last leg CD leaves on the side to which the first two, AB and BC, turn: within half a turn of AB. By
//! how much it does not is the sine of the angle from AB to CD, taken with the sign of that turn.

use dvp_core::geometry::Vec2;
use dvp_core::shape::{Path, PathRing, Segment};
use dvp_core::{AnyShape, Object, Real, SceneGrad};

/// `weight` times the mean over all cubics of the paths among `objects` of max(0, -s sin), s = 1 where AB turns to BC from +x to +y,
/// else -1, sin that of the angle from AB to CD; adds its gradient to `grad`. 0 without a cubic.
///
/// *Dimensions*: `grad` in the layout of a scene of `objects`; objects beyond the shortest are left out. *Derivative*:
/// 0 at the kinks, and for cubics whose first or last leg has no length, which cost nothing.
///
/// *Source*: Ma et al., Towards Layer-wise Image Vectorization, CVPR 2022, the Xing loss; there a sum per path, here a mean,
/// so that its weight means the same for any number of shapes.
pub fn crossing_and_grad<T: Real>(objects: &[Object<T>], weight: T, grad: &mut SceneGrad<T>) -> T {
    let count: usize = rings(objects).map(|ring| cubics(ring).count()).sum();
    let share = weight / T::of_usize(count.max(1));
    let mut sum = T::zero();
    for (object, grad) in objects.iter().zip(&mut grad.objects) {
        let AnyShape::Path(Path { rings, .. }) = &object.shape else { continue };
        let mut rest = &mut grad.numbers[..];
        for ring in rings {
            let (own, others) = rest.split_at_mut(ring.number_count().min(rest.len()));
            rest = others;
            for cubic in cubics(ring) {
                let (price, slopes) = price_and_slopes(cubic.points);
                sum += price;
                for (at, slope) in cubic.numbers.into_iter().zip(slopes) {
                    for (grad, slope) in own.iter_mut().skip(at).zip(slope.to_array()) {
                        *grad += slope * share;
                    }
                }
            }
        }
    }
    sum * share
}

fn rings<T: Real>(objects: &[Object<T>]) -> impl Iterator<Item = &PathRing<T>> {
    objects.iter().flat_map(|object| match &object.shape {
        AnyShape::Path(Path { rings, .. }) => &rings[..],
        _ => &[],
    })
}

/// A cubic of a ring.
struct Cubic<T> {
    points: [Vec2<T>; 4],
    /// Where the coordinates of each point stand among the numbers of the ring.
    numbers: [usize; 4],
}

fn cubics<T: Real>(ring: &PathRing<T>) -> impl Iterator<Item = Cubic<T>> {
    let mut controls_at = 2 * ring.points.len();
    ring.segments.iter().enumerate().filter_map(move |(k, segment)| {
        let at = controls_at;
        controls_at += segment.number_count();
        let Segment::Cubic { controls } = *segment else { return None };
        let next = if k + 1 < ring.points.len() { k + 1 } else { 0 };
        let points = [ring.points[k], controls[0], controls[1], ring.points[next]].map(Vec2::from);
        Some(Cubic { points, numbers: [2 * k, at, at + 2, 2 * next] })
    })
}

/// max(0, -s sin) of a cubic, and its gradient by the four points.
fn price_and_slopes<T: Real>([a, b, c, d]: [Vec2<T>; 4]) -> (T, [Vec2<T>; 4]) {
    let (first, last) = (b - a, d - c);
    let none = (T::zero(), [Vec2::default(); 4]);
    let lengths = first.length() * last.length();
    if lengths <= T::min_positive_value() {
        return none;
    }
    let sign = if first.cross(c - b) > T::zero() { T::one() } else { -T::one() };
    let sine = first.cross(last) / lengths;
    if sign * sine >= T::zero() {
        return none;
    }
    // d (u x v) / |u||v|: by u it is (v_y, -v_x) / |u||v| - sin u / |u|^2, by v the same turned round.
    let by_first = -last.perp() / lengths - first * (sine / first.length_squared());
    let by_last = first.perp() / lengths - last * (sine / last.length_squared());
    let (by_first, by_last) = (by_first * -sign, by_last * -sign);
    (-sign * sine, [-by_first, by_first, -by_last, by_last])
}
