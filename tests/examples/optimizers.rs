//! Scores optimizers on a data set: OptP and Levenberg-Marquardt from a perturbed truth, Rand-OptP, Opt-Iter.
//!
//! `cargo run --release -p dvp-tests --example optimizers -- DATA [IMAGES]` prints the paper's columns and the thread-CPU
//! time per image. Targets are float images: those of `val_first32_f32.npy` beside DATA where it exists, for the
//! other scenes images of the soft-triangle renderer (8-bit pictures would hide errors below 1/255).

use core::error::Error;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

use cpu_time::ThreadTime;
use dvp::format::DataSet;
use dvp::method::perturbed;
use dvp_core::loss::ImagePair;
use dvp_core::metric::{Ownership, Tally};
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::triangles::TriangleRenderer;
use dvp_core::render::{Compositing, EdgeProfile, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Efd, Image, ImageSize, ImageView, Scene};
use dvp_fit::Fit;
use dvp_fit::adam::descent::Descent;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::rand_opt_p::{RandOptP, random_scene};
use dvp_fit::refine::{Refine, RefineScratch};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

type Failure = Box<dyn Error>;

const SIDE: usize = 128;
const HARMONICS: usize = 16;
const MOST_HARMONICS: usize = 64;

/// Means of a method over the images, with the times.
struct Row {
    name: &'static str,
    tally: Tally<f32>,
    mae: Vec<f64>,
    milliseconds: Vec<f64>,
}

/// Draws, masks and scores scenes.
struct Judge {
    renderer: ContourRenderer<f32>,
    basis: OutlineBasis<f32>,
    size: ImageSize,
}

impl Judge {
    fn draw(&self, scene: &Scene<f32>) -> Result<Drawing<f32>, Failure> {
        let mut drawing = Drawing::default();
        scene.draw(&self.basis, &mut drawing)?;
        Ok(drawing)
    }

    fn ownership(&self, scene: &Scene<f32>) -> Result<Ownership, Failure> {
        let drawing = self.draw(scene)?;
        let mut coverage = vec![0.0; drawing.object_count() * self.size.pixels()];
        self.renderer.object_coverage(&drawing, self.size, &mut Default::default(), &mut coverage)?;
        let mut owned = Ownership::default();
        owned.fill(self.size.pixels(), &coverage, &drawing.confidences)?;
        Ok(owned)
    }

    fn score<E>(
        &self,
        row: &mut Row,
        image: ImageView<'_, f32>,
        truth: &Scene<f32>,
        fit: impl FnOnce() -> Result<Fit<f32>, E>,
    ) -> Result<(), Failure>
    where
        E: Error + 'static,
    {
        let start = ThreadTime::now();
        let fit = fit()?;
        row.milliseconds.push(1e3 * start.elapsed().as_secs_f64());
        let mut painted = Image::zeros(self.size);
        self.renderer.render(&self.draw(&fit.scene)?, self.size, &mut Default::default(), painted.data_mut())?;
        let pair = ImagePair::new(painted.view(), image)?;
        let scores = row.tally.add(pair, &self.ownership(&fit.scene)?, &self.ownership(truth)?)?;
        row.mae.push(scores.mae);
        Ok(())
    }
}

/// The float images beside the data set, if they are there.
fn float_images(folder: &Path, size: ImageSize) -> Result<Vec<Image<f32>>, Failure> {
    let path = folder.join("../val_first32_f32.npy");
    if !path.exists() || !folder.ends_with("val") {
        return Ok(Vec::new());
    }
    let numbers = npyz::NpyFile::new(File::open(path)?)?.into_vec::<f32>()?;
    let images = numbers.chunks_exact(3 * size.pixels()).map(|pixels| Image::from_interleaved(size, pixels));
    Ok(images.collect::<Result<_, _>>()?)
}

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "an index"
    )]
    let index = (share * values.len().saturating_sub(1) as f64).round() as usize;
    values.get(index).copied().unwrap_or(f64::NAN)
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("usage: optimizers DATA [IMAGES]")?;
    let folder = Path::new(&folder);
    let count = arguments.next().map_or(Ok(64), |count| count.parse::<usize>())?;

    let data = DataSet::<f32>::open(folder)?;
    let size = ImageSize::new(SIDE, SIDE)?;
    let floats = float_images(folder, size)?;
    let renderer = ContourRenderer::new(EdgeProfile::reference(), Compositing::Blend);
    let triangles = TriangleRenderer::<f32>::default();
    let basis = OutlineBasis::new(REFERENCE_VERTICES, MOST_HARMONICS)?;
    let judge = Judge { renderer, basis, size };
    let shapes: Vec<Efd<f32>> = data.bank.prototypes.iter().map(|(_, efd)| efd.resized(HARMONICS)).collect();
    let mut known = Descent::new(&renderer, REFERENCE_VERTICES, MOST_HARMONICS)?;
    let mut free = Descent::new(&renderer, REFERENCE_VERTICES, HARMONICS)?;

    let mut refining = RefineScratch::default();

    let mut rows = ["OptP", "LM with sigma continuation", "Rand-OptP", "Opt-Iter", "Opt-Iter, as published"]
        .map(|name| Row { name, tally: Tally::default(), mae: Vec::new(), milliseconds: Vec::new() });
    for (i, sample) in (0_u32..).zip(data.samples.iter().take(count)) {
        let Some((scene, place)) = &sample.scene else { continue };
        let truth: Scene<f32> = scene.to_scene(Some(&data.bank), place)?;
        let mut target = Image::zeros(size);
        match floats.get(i as usize) {
            Some(image) => target.clone_from(image),
            None => triangles.render(&judge.draw(&truth)?, size, &mut Default::default(), target.data_mut())?,
        }
        let (image, seed) = (target.view(), u64::from(i));
        let [opt_p, refine, rand_opt_p, opt_iter, published] = &mut rows;
        let start = perturbed(&truth, &mut ChaCha8Rng::seed_from_u64(seed));
        judge.score(opt_p, image, &truth, || OptP::default().fit(&mut known, image, &start))?;
        judge.score(refine, image, &truth, || Refine::default().fit(image, &start, &mut refining))?;
        let start = random_scene(truth.objects.len(), &shapes, seed);
        judge.score(rand_opt_p, image, &truth, || RandOptP::default().fit(&mut free, image, &start))?;
        judge.score(opt_iter, image, &truth, || OptIter::default().fit(&mut free, image))?;
        judge.score(published, image, &truth, || OptIter::published().fit(&mut free, image))?;
    }

    let mut out = std::io::stdout().lock();
    writeln!(out, "| method | images | MAE mean, p95 | MSE | SSIM | IoU | ARI | ms/image median, p95 |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    for Row { name, tally, mae, milliseconds } in &mut rows {
        let scores = tally.scores().ok_or("no image with a scene")?;
        let (p95, median, slow) = (quantile(mae, 0.95), quantile(milliseconds, 0.5), quantile(milliseconds, 0.95));
        write!(out, "| {name} | {} | {:.2e}, {p95:.1e} | {:.2e} ", tally.images(), scores.mae, scores.mse)?;
        writeln!(out, "| {:.4} | {:.4} | {:.4} | {median:.1}, {slow:.1} |", scores.ssim, scores.iou, scores.ari)?;
    }
    Ok(())
}
