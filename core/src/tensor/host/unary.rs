//! Functions of one number and their derivatives.

use crate::real::Real;
use crate::tensor::backend::Unary;

pub(super) fn value<T: Real>(function: Unary, x: T) -> T {
    match function {
        Unary::Abs => x.abs(),
        Unary::Cos => x.cos(),
        Unary::Erf => T::of(libm::erf(x.as_f64())),
        Unary::Exp => x.exp(),
        Unary::Log => x.ln(),
        // `max` would make a number of NaN.
        Unary::Relu if x < T::zero() => T::zero(),
        Unary::Relu => x,
        Unary::Sin => x.sin(),
        Unary::Sqrt => x.sqrt(),
        Unary::Tanh => x.tanh(),
    }
}

pub(super) fn derivative<T: Real>(function: Unary, x: T) -> T {
    let [zero, one] = [T::zero(), T::one()];
    match function {
        Unary::Abs if x > zero => one,
        Unary::Abs if x < zero => -one,
        Unary::Relu if x > zero => one,
        Unary::Abs | Unary::Relu => zero,
        Unary::Cos => -x.sin(),
        // 2 / sqrt(pi) e^(-x^2)
        Unary::Erf => T::of(core::f64::consts::FRAC_2_SQRT_PI) * (-x * x).exp(),
        Unary::Exp => x.exp(),
        Unary::Log => x.recip(),
        Unary::Sin => x.cos(),
        Unary::Sqrt => (x.sqrt() + x.sqrt()).recip(),
        Unary::Tanh => one - x.tanh() * x.tanh(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_stays_nan() {
        assert!(Unary::ALL.into_iter().all(|function| value(function, f64::NAN).is_nan()));
    }
}
