//! What a second look says of an object.

use dvp_core::shape::{PrototypeBank, SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{AnyShape, Object, Real};

/// The farthest that an object is moved, in its scales, and the most by which the logarithm of its scale changes.
const FARTHEST: f64 = 1.0;

/// The numbers that are said of an object, in this order: where its center is, in the frame of the window and in scales of the object (2);
/// the logarithm of how many times as large it is (1); a logit for every prototype; the sine and then the cosine of k times the angle by which
/// it is turned in the window, for every prototype, k being the order of its symmetry.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    /// The order of each prototype's symmetry; 1 where every angle is the same.
    orders: Vec<f64>,
}

/// What should be said of an object, and how much each number matters.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Aim {
    /// Center and logarithm of the scale.
    pub(crate) moves: Vec<f64>,
    /// 1 for the true prototype.
    pub(crate) shapes: Vec<f64>,
    /// The sine and cosine of the true prototype.
    pub(crate) turns: Vec<f64>,
    /// 1 where there is one.
    pub(crate) turned: Vec<f64>,
}

impl Layout {
    /// For so many prototypes, whatever their symmetry.
    pub(crate) fn new(prototypes: usize) -> Self {
        Self { orders: vec![1.0; prototypes] }
    }

    /// For the prototypes of a bank.
    pub(crate) fn of<T: Real>(bank: &PrototypeBank<T>) -> Self {
        let order = |efd: &dvp_core::shape::Efd<T>| match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
            Symmetry::Finite(order) => order.max(1) as f64,
            Symmetry::Continuous => 1.0,
        };
        Self { orders: bank.prototypes().iter().map(order).collect() }
    }

    /// Numbers per object.
    pub(crate) fn len(&self) -> usize {
        3 + 3 * self.orders.len()
    }

    /// Prototypes.
    pub(crate) fn prototypes(&self) -> usize {
        self.orders.len()
    }

    /// Moves, scales and turns an object as was said, and gives it the likeliest shape.
    pub(crate) fn apply<T: Real>(&self, said: &[f64], object: &mut Object<T>, bank: &PrototypeBank<T>) {
        let count = self.orders.len();
        let (&[x, y, larger], shapes, turns) = (&[said[0], said[1], said[2]], &said[3..3 + count], &said[3 + count..]);
        let shape = (0..count).max_by(|&a, &b| shapes[a].total_cmp(&shapes[b])).unwrap_or(0);
        let within = |number: f64| if number.is_finite() { number.clamp(-FARTHEST, FARTHEST) } else { 0.0 };
        let (sin, cos) = object.pose.rotation.as_f64().sin_cos();
        let (scale, [x, y]) = (object.pose.scale.as_f64(), [within(x), within(y)]);
        let turn = turns[shape].atan2(turns[count + shape]) / self.orders[shape];
        let pose = &mut object.pose;
        pose.translation[0] += T::of(scale * (cos * x - sin * y));
        pose.translation[1] += T::of(scale * (sin * x + cos * y));
        pose.scale *= T::of(within(larger).exp());
        pose.rotation += T::of(if turn.is_finite() { turn } else { 0.0 });
        object.shape = AnyShape::of_efd(bank.prototypes()[shape].clone(), Some(shape));
    }

    /// Adds what should be said of `seen`, which is `truth`, to `aim`. `prototype`: that of the truth.
    pub(crate) fn aim<T: Real>(&self, seen: &Object<T>, truth: &Object<T>, prototype: usize, aim: &mut Aim) {
        let scale = seen.pose.scale.as_f64();
        let (sin, cos) = seen.pose.rotation.as_f64().sin_cos();
        let [x, y] = [0, 1].map(|axis| (truth.pose.translation[axis] - seen.pose.translation[axis]).as_f64() / scale);
        aim.moves.extend([cos * x + sin * y, cos * y - sin * x, (truth.pose.scale.as_f64() / scale).ln()]);
        let turn = (truth.pose.rotation - seen.pose.rotation).as_f64();
        let is = |k: usize| if k == prototype { 1.0 } else { 0.0 };
        let count = self.orders.len();
        aim.shapes.extend((0..count).map(is));
        aim.turned.extend((0..2 * count).map(|k| is(k % count)));
        aim.turns.extend((0..count).map(|k| is(k) * (self.orders[k] * turn).sin()));
        aim.turns.extend((0..count).map(|k| is(k) * (self.orders[k] * turn).cos()));
    }
}
