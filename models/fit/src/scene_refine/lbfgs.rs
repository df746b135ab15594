//! Limited-memory BFGS within bounds: descent for hundreds of numbers whose Hessian nobody wants to write down.
//!
//! *Source*: J. Nocedal, "Updating quasi-Newton matrices with limited storage", 1980; steps are projected on the bounds, and
//! a number that a bound holds back takes no part in the direction.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use dvp_core::Real;

/// Pairs of steps and changes of the gradient that are remembered.
const MEMORY: usize = 12;
/// Part of the predicted decrease that a step must bring.
const SUFFICIENT: f64 = 1e-4;
/// Most times that a step is shortened.
const SHORTENED: usize = 12;
/// Steps in a row that bring next to nothing, after which the descent is over.
const PATIENCE: usize = 4;

/// A function to be made small.
pub(super) trait Objective<T> {
    /// The value at `point`; its gradient goes to `gradient`. None where the function is not defined.
    fn evaluate(&mut self, point: &[T], gradient: &mut [T]) -> Option<T>;

    /// Told of every step that is taken: to the point that was evaluated last, with its value.
    fn stepped(&mut self, value: T);
}

/// Where a descent ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Descended<T> {
    /// The value there.
    pub(super) value: T,
    /// Steps taken.
    pub(super) steps: usize,
    /// Whether it ended because nothing was left to gain, not because the steps were used up.
    pub(super) converged: bool,
}

/// Settings of a descent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lbfgs {
    /// Most steps.
    pub(super) max_steps: usize,
    /// A step that lowers the value by a smaller share of it brings next to nothing.
    pub(super) least_gain: f64,
}

/// A step and the change of the gradient along it.
struct Pair<T> {
    step: Vec<T>,
    change: Vec<T>,
    /// 1 / (step . change).
    inverse: T,
}

impl Lbfgs {
    /// Moves `point` downhill, within `bounds`; none if the function is not defined at the start. The value never rises.
    pub(super) fn descend<T: Real>(
        &self,
        objective: &mut impl Objective<T>,
        bounds: &[[T; 2]],
        point: &mut Vec<T>,
    ) -> Option<Descended<T>> {
        let mut gradient = alloc::vec![T::zero(); point.len()];
        let mut value = objective.evaluate(point, &mut gradient)?;
        let mut memory: VecDeque<Pair<T>> = VecDeque::with_capacity(MEMORY);
        let (mut next, mut next_gradient) = (point.clone(), gradient.clone());
        let mut idle = 0;
        for steps in 0..self.max_steps {
            let mut direction = direction(&memory, &gradient, point, bounds);
            let mut slope = dot(&direction, &gradient);
            if slope >= T::zero() {
                // What is remembered misleads: begin again with the gradient.
                memory.clear();
                direction = self::direction(&memory, &gradient, point, bounds);
                slope = dot(&direction, &gradient);
            }
            if slope >= T::zero() {
                return Some(Descended { value, steps, converged: true });
            }
            // The function is nowhere below 0: no step brings more than its value.
            let mut length = (T::of(2.0) * value / -slope).min(T::one());
            let mut found = None;
            for _ in 0..=SHORTENED {
                for (((next, &at), &along), &[low, high]) in next.iter_mut().zip(&*point).zip(&direction).zip(bounds) {
                    *next = (at + length * along).max(low).min(high);
                }
                let predicted: T =
                    next.iter().zip(&*point).zip(&gradient).map(|((&to, &from), &g)| (to - from) * g).sum();
                match objective.evaluate(&next, &mut next_gradient) {
                    // At the bounds a step may be cut to one uphill.
                    Some(new) if new <= value + T::of(SUFFICIENT) * predicted.min(T::zero()) => {
                        found = Some(new);
                        break;
                    }
                    // The least value of the parabola through what is known, but not too small a part.
                    Some(new) if new.is_finite() => {
                        let least = -slope * length / (T::of(2.0) * (new - value - slope * length));
                        length *= least.max(T::of(0.1)).min(T::of(0.5));
                    }
                    _ => length *= T::of(0.25),
                }
            }
            let Some(new) = found else {
                if memory.is_empty() {
                    return Some(Descended { value, steps, converged: true });
                }
                memory.clear();
                continue;
            };
            remember(&mut memory, &next, point, &next_gradient, &gradient);
            idle = if value - new > T::of(self.least_gain) * value { 0 } else { idle + 1 };
            value = new;
            objective.stepped(value);
            core::mem::swap(point, &mut next);
            core::mem::swap(&mut gradient, &mut next_gradient);
            if idle >= PATIENCE {
                return Some(Descended { value, steps: steps + 1, converged: true });
            }
        }
        Some(Descended { value, steps: self.max_steps, converged: false })
    }
}

/// Minus the gradient times the approximate inverse Hessian; 0 for numbers that a bound holds back.
fn direction<T: Real>(memory: &VecDeque<Pair<T>>, gradient: &[T], point: &[T], bounds: &[[T; 2]]) -> Vec<T> {
    let is_held = |i: usize| {
        let [low, high] = bounds[i];
        point[i] <= low && gradient[i] > T::zero() || point[i] >= high && gradient[i] < T::zero()
    };
    let held: Vec<bool> = (0..point.len()).map(is_held).collect();
    let mut direction: Vec<T> =
        gradient.iter().zip(&held).map(|(&g, &held)| if held { T::zero() } else { -g }).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for pair in memory.iter().rev() {
        let share = pair.inverse * dot(&pair.step, &direction);
        add(&mut direction, -share, &pair.change);
        shares.push(share);
    }
    if let Some(last) = memory.back() {
        let factor = (last.inverse * dot(&last.change, &last.change)).recip();
        direction.iter_mut().for_each(|value| *value *= factor);
    }
    for (pair, share) in memory.iter().zip(shares.into_iter().rev()) {
        let other = pair.inverse * dot(&pair.change, &direction);
        add(&mut direction, share - other, &pair.step);
    }
    for (value, held) in direction.iter_mut().zip(held) {
        if held {
            *value = T::zero();
        }
    }
    direction
}

/// Takes a step into memory, if the gradient rose along it as it does in a bowl.
fn remember<T: Real>(memory: &mut VecDeque<Pair<T>>, next: &[T], point: &[T], next_gradient: &[T], gradient: &[T]) {
    let step: Vec<T> = next.iter().zip(point).map(|(&a, &b)| a - b).collect();
    let change: Vec<T> = next_gradient.iter().zip(gradient).map(|(&a, &b)| a - b).collect();
    let curvature = dot(&step, &change);
    if curvature > T::of(1e-10) * dot(&change, &change) && curvature > T::zero() {
        if memory.len() == MEMORY {
            memory.pop_front();
        }
        memory.push_back(Pair { inverse: curvature.recip(), step, change });
    }
}

fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).map(|(&a, &b)| a * b).sum()
}

fn add<T: Real>(to: &mut [T], factor: T, values: &[T]) {
    to.iter_mut().zip(values).for_each(|(to, &value)| *to += factor * value);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 - x)^2 + 100 (y - x^2)^2, Rosenbrock's valley: every value that was asked for, and those of steps.
    #[derive(Default)]
    struct Valley {
        asked: Vec<f64>,
        stepped: Vec<f64>,
    }

    impl Objective<f64> for Valley {
        fn evaluate(&mut self, point: &[f64], gradient: &mut [f64]) -> Option<f64> {
            let [x, y] = [point[0], point[1]];
            gradient.copy_from_slice(&[-2.0 * (1.0 - x) - 400.0 * x * (y - x * x), 200.0 * (y - x * x)]);
            let value = (1.0 - x).powi(2) + 100.0 * (y - x * x).powi(2);
            self.asked.push(value);
            Some(value)
        }

        fn stepped(&mut self, value: f64) {
            assert_eq!(self.asked.last(), Some(&value), "the last point asked for is the one that was taken");
            self.stepped.push(value);
        }
    }

    #[test]
    fn the_least_value_within_bounds_is_found_and_no_step_goes_uphill() {
        let anything = [f64::NEG_INFINITY, f64::INFINITY];
        for (bounds, expected) in [([anything; 2], [1.0, 1.0]), ([[-2.0, 0.5], anything], [0.5, 0.25])] {
            for steps in 0..200 {
                let mut point = alloc::vec![-1.2, 1.0];
                let mut valley = Valley::default();
                let settings = Lbfgs { max_steps: steps, least_gain: 0.0 };
                let ended = settings.descend(&mut valley, &bounds, &mut point).unwrap();
                assert!(ended.value <= valley.asked[0]);
                assert!(valley.stepped.is_sorted_by(|a, b| a >= b) && valley.stepped.len() <= steps);
                assert!(valley.stepped.last().is_none_or(|last| last.to_bits() == ended.value.to_bits()));
                if steps == 199 {
                    let off = point.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(off < 1e-4, "{point:?} in place of {expected:?}");
                }
            }
        }
    }
}
