//! Renderers: one image of 128 x 128, 4 objects like those of MDS-HR, 64 vertices, 16 harmonics.
//!
//! `forward/<renderer>/4x64` is scene to drawing to image; `forward_backward/<renderer>/4x64` is scene to drawing to MAE
//! against another image, and the gradient back to every parameter of the scene, descriptors included. The `_f64` ids
//! are the same in f64.

#![expect(clippy::expect_used, reason = "a bench that cannot set up its work must stop")]

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use dvp_core::render::{ContourRenderer, ExactRenderer, HardRenderer, PixelLoss, Renderer, TriangleRenderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Efd, Image, ImageSize, Object, Pose, Real, Scene, SceneGrad};

/// Harmonics per shape, as the paper's prototypes have.
const HARMONICS: u32 = 16;

/// A heart, a square, an ellipse and another heart, sizes and overlap as in an average scene of MDS-HR.
fn scene<T: Real>(jitter: f64) -> Scene<T> {
    let heart = |n: u32| [0.6, -0.1, 0.3, -0.8].map(|v| v / f64::from(n * n));
    let square = |n: u32| [0.9, 0.0, 0.0, -0.9].map(|v| if n % 4 == 1 { v / f64::from(n * n) } else { 0.0 });
    let ellipse = |n: u32| [1.0, 0.0, 0.0, -0.5].map(|v| if n == 1 { v } else { 0.0 });
    let objects = [
        ([0.30, 0.35], 0.22, 0.4, [0.9, 0.2, 0.3], &heart as &dyn Fn(u32) -> [f64; 4]),
        ([0.70, 0.30], 0.18, 1.1, [0.1, 0.7, 0.4], &square),
        ([0.35, 0.72], 0.25, 2.0, [0.3, 0.3, 0.9], &ellipse),
        ([0.68, 0.62], 0.16, -0.7, [0.8, 0.8, 0.1], &heart),
    ];
    let objects = objects.map(|([x, y], scale, rotation, color, shape)| {
        let pose = Pose {
            translation: [T::of(x + jitter), T::of(y - jitter)],
            scale: T::of(scale * (1.0 + jitter)),
            rotation: T::of(rotation + jitter),
        };
        Object::of_efd(
            pose,
            color.map(|c| T::of(c - jitter)),
            T::one(),
            Efd::new((1..=HARMONICS).map(|n| shape(n).map(T::of)).collect()),
            None,
        )
    });
    Scene { objects: objects.into(), ..Scene::empty([T::of(0.4); 3]) }
}

/// Adds the two benches of a renderer.
fn bench<T: Real, R: Renderer<T>>(criterion: &mut Criterion, name: &str, renderer: &R) {
    let size = ImageSize::new(128, 128).expect("a size");
    let basis = OutlineBasis::new(64, HARMONICS as usize).expect("a basis");
    let (scene, start) = (scene::<T>(0.0), scene::<T>(0.02));
    let mut drawing = Drawing::default();
    let mut scratch = R::Scratch::default();
    let mut target = Image::zeros(size);
    scene.draw(&basis, &mut drawing).expect("drawn");
    renderer.render(&drawing, size, &mut scratch, target.data_mut()).expect("rendered");

    let mut image = Image::<T>::zeros(size);
    criterion.bench_function(&format!("forward/{name}/4x64"), |bencher| {
        bencher.iter(|| {
            black_box(&start).draw(&basis, &mut drawing).expect("drawn");
            renderer.render(&drawing, size, &mut scratch, image.data_mut()).expect("rendered");
            black_box(image.data()[0])
        });
    });
    let (mut grad, mut grad_drawing) = (SceneGrad::default(), DrawingGrad::default());
    criterion.bench_function(&format!("forward_backward/{name}/4x64"), |bencher| {
        bencher.iter(|| {
            black_box(&start).draw(&basis, &mut drawing).expect("drawn");
            grad_drawing.reset(&drawing);
            grad.reset(&start);
            let loss = renderer
                .loss_and_grad(&drawing, target.view(), PixelLoss::Mae, &mut scratch, &mut grad_drawing)
                .expect("rendered");
            start.draw_vjp(&basis, &grad_drawing, &mut grad).expect("pulled back");
            black_box((loss, grad.background[0]))
        });
    });
}

/// All renderers.
fn renderers(criterion: &mut Criterion) {
    bench::<f32, _>(criterion, "contour", &ContourRenderer::default());
    bench::<f64, _>(criterion, "contour_f64", &ContourRenderer::default());
    bench::<f32, _>(criterion, "triangles", &TriangleRenderer::default());
    bench::<f32, _>(criterion, "exact", &ExactRenderer::default());
    bench::<f32, _>(criterion, "hard", &HardRenderer::default());
}

criterion_group!(benches, renderers);
criterion_main!(benches);
