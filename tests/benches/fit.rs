//! Segment-and-fit: the mean time per image over 8 images like those of MDS-HR, 128 x 128, rounded to 8 bits.
//!
//! `fit/bank` knows the three shapes, `fit/free` does not. An iteration is one image; the images take turns. Fitter and
//! scratch are kept.

#![expect(clippy::expect_used, reason = "a bench that cannot set up its work must stop")]

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use dvp::format::mdshr_bank;
use dvp::generate::{SceneSettings, sample_scene};
use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize};
use dvp_fit::{FitOptions, FitScratch, Fitter};

const IMAGES: u64 = 8;

fn images() -> Vec<Image<f32>> {
    let size = ImageSize::new(128, 128).expect("a size");
    let basis = OutlineBasis::new(REFERENCE_VERTICES, 64).expect("a basis");
    let mut drawing = Drawing::default();
    let image = |index| {
        let scene = sample_scene(&SceneSettings::mds_hr(), &mdshr_bank(), size, 1, index);
        scene.draw(&basis, &mut drawing).expect("drawn");
        let mut image = Image::zeros(size);
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        renderer.render(&drawing, size, &mut Default::default(), image.data_mut()).expect("rendered");
        image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
        image
    };
    (0..IMAGES).map(image).collect()
}

fn bench(criterion: &mut Criterion, id: &str, options: FitOptions<f32>) {
    let (images, fitter) = (images(), Fitter::new(options).expect("a fitter"));
    let mut scratch = FitScratch::default();
    let mut turns = images.iter().cycle();
    criterion.bench_function(id, |bencher| {
        bencher.iter(|| {
            let image = turns.next().expect("an image");
            black_box(fitter.fit(black_box(image.view()), &mut scratch).expect("a fit").loss)
        });
    });
}

fn fits(criterion: &mut Criterion) {
    bench(criterion, "fit/bank", FitOptions::default().with_bank(Some(mdshr_bank())));
    bench(criterion, "fit/free", FitOptions::default());
}

criterion_group!(benches, fits);
criterion_main!(benches);
