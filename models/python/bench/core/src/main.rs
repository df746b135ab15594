//! The core's own time for what `bench/render.py` measures from Python: 32 scenes of 4 objects, 16 harmonics, 64 vertices, on one thread.
//!
//! Prints a line of JSON: milliseconds per batch, the least of the runs (what else runs on the machine only adds), of painting, of painting and the way back, and of loss and
//! gradient. `scene` is written out here as in `bench/scenes.py`.

use std::io::Write as _;
use std::time::Instant;

use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, Renderer as _};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Efd, Image, ImageSize, Object, Pose, Scene, SceneGrad};

const SIDE: usize = 128;
const SCENES: usize = 32;
const OBJECTS: usize = 4;
const HARMONICS: usize = 16;
const RUNS: usize = 41;

/// Scene number `index`: wobbly disks around the middle.
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "small counts; f32 is what is measured"
)]
fn scene(index: usize) -> Scene<f32> {
    let objects = (0..OBJECTS).map(|k| {
        let at = (index * OBJECTS + k) as f64;
        let rows = (1..=HARMONICS).map(|n| {
            let wobble = 0.1 / (n * n) as f64;
            let wave =
                [(at + n as f64).cos(), (at * n as f64).sin(), (2.0 * at + n as f64).sin(), (at - n as f64).cos()];
            let circle = if n == 1 { [1.0, 0.0, 0.0, 1.0] } else { [0.0; 4] };
            [0, 1, 2, 3].map(|i| (circle[i] + wobble * wave[i]) as f32)
        });
        let translation = [0.5 + 0.25 * (1.7 * at).cos(), 0.5 + 0.25 * (2.3 * at).sin()].map(|x| x as f32);
        let pose = Pose { translation, scale: (0.15 + 0.1 * (0.9 * at).sin().abs()) as f32, rotation: at as f32 };
        let color = [0.0, 1.0, 2.0].map(|c| (0.5 + 0.5 * (at + c).sin()) as f32);
        Object::of_efd(pose, color, 1.0, Efd::new(rows.collect()), None)
    });
    let objects = objects.collect();
    Scene { objects, edge: EdgeProfile::reference(), compositing: Compositing::Blend, ..Scene::empty([0.5; 3]) }
}

/// The least time of `work`, ms; the first run makes memory and does not count.
fn least_ms(
    mut work: impl FnMut() -> Result<(), Box<dyn core::error::Error>>,
) -> Result<f64, Box<dyn core::error::Error>> {
    work()?;
    let mut times = Vec::new();
    for _ in 0..RUNS {
        let start = Instant::now();
        work()?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(times.into_iter().fold(f64::INFINITY, f64::min))
}

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let size = ImageSize::new(SIDE, SIDE)?;
    let basis = OutlineBasis::<f32>::new(64, HARMONICS)?;
    let scenes: Vec<Scene<f32>> = (0..SCENES).map(scene).collect();
    let renderer = ContourRenderer::new(EdgeProfile::reference(), Compositing::Blend);
    let (mut drawing, mut scratch) = (Drawing::default(), Default::default());
    let (mut grad, mut scene_grad) = (DrawingGrad::default(), SceneGrad::default());
    let mut images: Vec<Image<f32>> = scenes.iter().map(|_| Image::zeros(size)).collect();
    let pull = vec![1.0 / (3 * size.pixels()) as f32; 3 * size.pixels()];

    let render = least_ms(|| {
        for (scene, image) in scenes.iter().zip(&mut images) {
            scene.draw(&basis, &mut drawing)?;
            renderer.render(&drawing, size, &mut scratch, image.data_mut())?;
        }
        Ok(())
    })?;
    let both = least_ms(|| {
        for (scene, image) in scenes.iter().zip(&mut images) {
            scene.draw(&basis, &mut drawing)?;
            renderer.render(&drawing, size, &mut scratch, image.data_mut())?;
        }
        for scene in &scenes {
            scene.draw(&basis, &mut drawing)?;
            grad.reset(&drawing);
            renderer.render_vjp(&drawing, size, &mut scratch, &pull, &mut grad)?;
            scene_grad.reset(scene);
            scene.draw_vjp(&basis, &grad, &mut scene_grad)?;
        }
        Ok(())
    })?;
    let targets: Vec<Image<f32>> = scenes.iter().map(|_| Image::zeros(size)).collect();
    let mut sum = 0.0;
    let loss = least_ms(|| {
        for (scene, target) in scenes.iter().zip(&targets) {
            scene.draw(&basis, &mut drawing)?;
            grad.reset(&drawing);
            sum += renderer.loss_and_grad(&drawing, target.view(), PixelLoss::Mae, &mut scratch, &mut grad)?;
            scene_grad.reset(scene);
            scene.draw_vjp(&basis, &grad, &mut scene_grad)?;
        }
        Ok(())
    })?;
    let mean =
        images.iter().flat_map(Image::data).map(|&value| f64::from(value)).sum::<f64>() / (SCENES * pull.len()) as f64;
    let line = format!(
        "{{\"render\": {render}, \"render and back\": {both}, \"loss and gradient\": {loss}, \"mean\": {mean}}}"
    );
    writeln!(std::io::stdout(), "{line}")?;
    Ok(())
}
