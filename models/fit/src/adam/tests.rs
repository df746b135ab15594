use alloc::vec::Vec;

use super::{Adam, AdamSettings};
use dvp_core::optim::{Plateau, PlateauSettings};

#[test]
fn first_steps_by_hand() {
    let mut adam = Adam::new(AdamSettings::default(), 2);
    let mut p = [1.0_f64, 1.0];
    adam.step(&mut p, &[4.0, -0.5], 0.1);
    // Both moments over their corrections are g and g^2: the step is 0.1 g / (|g| + 1e-8).
    assert!((p[0] - 0.9).abs() < 1e-9 && (p[1] - 1.1).abs() < 1e-8, "{p:?}");
    adam.step(&mut p, &[0.0, -0.5], 0.1);
    // m = 0.9 * 0.4 = 0.36, v = 0.999 * 0.016; m / 0.19 = 1.894737, v / 0.001999 = 7.995998, root 2.827720:
    // 0.1 * 1.894737 / 2.827720 = 0.0670058.
    assert!((p[0] - (0.9 - 0.067_005_8)).abs() < 1e-7, "{p:?}");
    assert!((p[1] - 1.2).abs() < 1e-8, "{p:?}");
}

#[test]
fn reset_forgets() {
    let mut adam = Adam::new(AdamSettings::default(), 1);
    let (mut once, mut again) = ([0.0_f32], [0.0_f32]);
    adam.step(&mut once, &[2.0], 0.1);
    adam.reset(1);
    adam.step(&mut again, &[2.0], 0.1);
    assert_eq!(once.map(f32::to_bits), again.map(f32::to_bits));
}

#[test]
fn plateau_waits_cuts_and_cools_down() {
    let mut settings = PlateauSettings::default();
    (settings.patience, settings.cooldown) = (2, 2);
    let mut plateau = Plateau::new(settings, 1.0);
    let mut rates = Vec::new();
    for _ in 0..10 {
        plateau.observe(1.0);
        rates.push(plateau.learning_rate());
    }
    // The first loss is progress; three more without it exceed the patience; two of cooldown; three more.
    assert_eq!(rates, [1.0, 1.0, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5, 0.25, 0.25]);
}
