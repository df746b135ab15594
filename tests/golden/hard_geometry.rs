//! Hard geometry: twins of one color are told apart, objects that leave the image are found.

use dvp::format::mdshr_bank;
use dvp_core::Scene;
use dvp_core::loss::ImagePair;
use dvp_core::metric::Tally;
use dvp_fit::{FitOptions, FitScratch, Fitter};
use dvp_lab::hard::{cropped, twins};
use dvp_tests::hard_geometry::{all_found, ownership, paint, rounded};

const PICTURES: u64 = 24;
/// Mask IoU at which an object is found.
const FOUND: f64 = 0.9;

fn known() -> FitOptions<f32> {
    FitOptions::default().with_bank(Some(mdshr_bank()))
}

/// Pictures whose objects are all found, and the ARI over all.
fn score(options: FitOptions<f32>, scene: impl Fn(u64) -> Scene<f32>) -> (usize, f64) {
    let fitter = Fitter::new(options).unwrap();
    let (mut scratch, mut tally, mut found) = (FitScratch::default(), Tally::default(), 0);
    for index in 0..PICTURES {
        let truth = scene(index);
        let image = rounded(&paint(&truth));
        let fit = fitter.fit(image.view(), &mut scratch).unwrap();
        found += usize::from(all_found(&truth, &fit.scene, FOUND));
        let painted = paint(&fit.scene);
        let pair = ImagePair::new(painted.view(), image.view()).unwrap();
        tally.add(pair, &ownership(&fit.scene), &ownership(&truth)).unwrap();
    }
    let ari = tally.scores().unwrap().ari;
    eprintln!("{found} of {PICTURES} pictures found, ARI {ari:.4}");
    (found, ari)
}

#[test]
fn twins_with_a_bank() {
    // 0.95, 0.85 and 0.85 of 24.
    for (gap, least) in [(0.15, 23), (0.1, 21), (0.075, 21)] {
        let (found, _) = score(known(), |index| twins(gap, index));
        assert!(found >= least, "gap {gap}: {found}");
    }
}

#[test]
fn twins_without_a_bank() {
    // Measured. One and three more are found if the heart, of which half of the pictures have two, is a shape to look for; but
    // nobody has told of it.
    for (gap, least) in [(0.15, 22), (0.1, 18)] {
        let (found, _) = score(FitOptions::default(), |index| twins(gap, index));
        assert!(found >= least, "gap {gap}: {found}");
    }
}

#[test]
fn cropped_objects() {
    for hidden in [0.3, 0.5, 0.7] {
        for options in [known(), FitOptions::default()] {
            let (_, ari) = score(options, |index| cropped(hidden, index).unwrap());
            assert!(ari >= 0.98, "{hidden} hidden: {ari}");
        }
    }
}
