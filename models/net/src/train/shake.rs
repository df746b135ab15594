//! Scenes as a network might see them: true ones, shaken.

use core::f64::consts::TAU;

use dvp_core::shape::PrototypeBank;
use dvp_core::{AnyShape, Object, Real, Scene};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

use crate::initial::normal;

/// By how much an object is off, as the power of 10 of a deviation in its scales: from what a second look leaves to what a first look
/// misses by at most.
const LEVELS: [f64; 2] = [-2.5, -0.55];
/// Deviation of the logarithm of its scale, and of its angle in radians, in units of that of its place.
const SCALES: f64 = 0.8;
const TURNS: f64 = 1.5;
/// Share of objects that are turned anyhow, and of those whose shape is drawn anew.
const TURNED: f64 = 0.2;
const RESHAPED: f64 = 0.3;
/// The largest deviation of the colors of an object, and that of the background.
const COLORED: f64 = 0.06;
const GROUND: f64 = 0.01;
/// Share of objects that are not seen, and of scenes in which one is seen that is not there.
const MISSED: f64 = 0.05;
const INVENTED: f64 = 0.1;

/// A scene as it might be seen, and for each of its first objects which one of the truth it is; those after them are not there.
///
/// Rationale: what first looks get wrong depends on the network and on how long it learned; a second look that has seen errors of all
/// sizes can be used after any of them, and again after itself.
pub(super) fn shaken<T: Real>(
    truth: &Scene<T>,
    bank: &PrototypeBank<T>,
    rng: &mut ChaCha8Rng,
) -> (Scene<T>, Vec<usize>) {
    let mut seen = Scene { objects: Vec::with_capacity(truth.objects.len() + 1), ..truth.clone() };
    let mut which = Vec::with_capacity(truth.objects.len());
    tint(&mut seen.background, GROUND, rng);
    for (k, object) in truth.objects.iter().enumerate() {
        // The last one is seen if no other is: there is always something to learn from.
        let last = which.is_empty() && k + 1 == truth.objects.len();
        if rng.random_bool(MISSED) && !last {
            continue;
        }
        seen.objects.push(misread(object, bank, rng));
        which.push(k);
    }
    if rng.random_bool(INVENTED)
        && let Some(object) = truth.objects.first()
    {
        let mut other = misread(object, bank, rng);
        other.pose.translation = [(); 2].map(|()| T::of(rng.random_range(0.0..1.0)));
        let color = [(); 3].map(|()| T::of(rng.random_range(0.0..1.0)));
        other = Object { paint: dvp_core::Paint::Flat(color), ..other };
        seen.objects.push(other);
    }
    (seen, which)
}

/// An object, off by some amount.
fn misread<T: Real>(object: &Object<T>, bank: &PrototypeBank<T>, rng: &mut ChaCha8Rng) -> Object<T> {
    let level = 10.0_f64.powf(rng.random_range(LEVELS[0]..LEVELS[1]));
    let mut seen = object.clone();
    let scale = object.pose.scale.as_f64();
    for place in &mut seen.pose.translation {
        *place += T::of(scale * level * normal(rng));
    }
    let larger = (SCALES * level * normal(rng)).clamp(-0.6, 0.6);
    seen.pose.scale *= T::of(larger.exp());
    let turn = if rng.random_bool(TURNED) { rng.random_range(0.0..TAU) } else { TURNS * level * normal(rng) };
    seen.pose.rotation += T::of(turn);
    if rng.random_bool(RESHAPED) {
        let k = rng.random_range(0..bank.prototypes().len().max(1));
        if let Some(efd) = bank.prototypes().get(k) {
            seen.shape = AnyShape::of_efd(efd.clone(), Some(k));
        }
    }
    let mut color = object.color();
    let deviation = rng.random_range(0.0..COLORED);
    tint(&mut color, deviation, rng);
    Object { paint: dvp_core::Paint::Flat(color), ..seen }
}

fn tint<T: Real>(color: &mut [T; 3], deviation: f64, rng: &mut ChaCha8Rng) {
    for value in color {
        *value = (*value + T::of(deviation * normal(rng))).max(T::zero()).min(T::one());
    }
}
