//! Renderers: time against error, as vertices, harmonics and the band change; all of them beside each other, the one of
//! tensor operations on every backend.
//!
//! The error is the mean absolute difference from the contour renderer with [`FINE`] vertices, all harmonics and a band
//! without a cut, in f64.

use anyhow::{Context, Result};
use cpu_time::ProcessTime;
use dvp_core::render::{
    Compositing, ContourDistance, ContourRenderer, EdgeProfile, ExactRenderer, HardRenderer, PixelLoss, Renderer,
    TileRenderer, TriangleRenderer,
};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Image, Real, Scene, SceneGrad};

use super::dense;
use crate::command::pictures::Picture;
use dvp_cli::method::Precision;
use dvp_cli::statistics::{Quartiles, mean};

/// Vertices and harmonics of the image that others are held against.
const FINE: (usize, usize) = (1024, 64);
/// What does not change in a sweep: the reference's vertices, every harmonic of the data.
const USUAL: (usize, usize) = (64, 64);
const VERTICES: [usize; 9] = [16, 24, 32, 48, 64, 96, 128, 192, 256];
const HARMONICS: [usize; 7] = [1, 2, 4, 8, 16, 31, 64];
/// How far from an outline soft edges are looked at, on both sides, px; the profile itself ends 1.94 outside.
const BANDS_PX: [f64; 6] = [1.0, 1.3, 1.5, 1.7, 1.94, 2.5];
/// ln(1e6 - 1): at so many sigmas beyond the offset coverage is 1e-6.
const WIDE_SIGMAS: f64 = 13.815_5;
/// Calls that are timed together: the clock itself takes a part of a microsecond.
const CALLS: u32 = 4;

/// A renderer with its setting.
pub(super) struct Rendered {
    /// What is changed.
    pub(super) sweep: &'static str,
    /// Its value.
    pub(super) value: String,
    pub(super) precision: Precision,
    /// Mean absolute error of all images.
    pub(super) mae: f64,
    /// Scene to image.
    pub(super) forward_ms: Quartiles,
    /// Scene to mean absolute error, and the gradient of all its parameters.
    pub(super) backward_ms: Quartiles,
    /// Images.
    pub(super) n: usize,
}

/// A scene painted and timed.
pub(super) struct Sample {
    pub(super) image: Vec<f64>,
    pub(super) forward_ms: f64,
    pub(super) backward_ms: f64,
}

/// What paints scenes; some keep memory.
pub(super) trait Paints {
    /// Paints a scene, and pulls the error against an image back to it.
    fn paint(&mut self, picture: &Picture) -> Result<Sample>;
}

/// What is swept: its name and value, its precision, and what paints.
pub(super) type Candidate = (&'static str, String, Precision, Box<dyn Paints>);

/// Paints the scenes of all pictures with every renderer, by turns; those of tensor operations, which take a thousand times
/// as long, apart from the others.
pub(super) fn run(pictures: &[Picture]) -> Result<Vec<Rendered>> {
    let fine = pictures.iter().map(fine).collect::<Result<Vec<_>>>()?;
    let mut all = sweep(candidates()?, pictures, &fine)?;
    all.extend(sweep(dense::candidates(), pictures, &fine)?);
    Ok(all)
}

fn sweep(mut candidates: Vec<Candidate>, pictures: &[Picture], fine: &[Vec<f64>]) -> Result<Vec<Rendered>> {
    let mut samples: Vec<Vec<[f64; 3]>> = candidates.iter().map(|_| Vec::new()).collect();
    if let Some(first) = pictures.first() {
        for (.., paints) in &mut candidates {
            // Memory is made here.
            paints.paint(first)?;
        }
    }
    for (turn, (picture, fine)) in pictures.iter().zip(fine).enumerate() {
        for k in 0..candidates.len() {
            let k = (k + turn) % candidates.len();
            let Sample { image, forward_ms, backward_ms } = candidates[k].3.paint(picture)?;
            let apart = image.iter().zip(fine).map(|(a, b)| (a - b).abs());
            samples[k].push([mean(apart).unwrap_or(f64::NAN), forward_ms, backward_ms]);
        }
    }
    let rows = candidates.into_iter().zip(samples).map(|((sweep, value, precision, _), samples)| {
        let of = |k: usize| samples.iter().map(move |sample| sample[k]);
        Rendered {
            sweep,
            value,
            precision,
            mae: mean(of(0)).unwrap_or(f64::NAN),
            forward_ms: Quartiles::of(of(1).collect()),
            backward_ms: Quartiles::of(of(2).collect()),
            n: samples.len(),
        }
    });
    Ok(rows.collect())
}

fn candidates() -> Result<Vec<Candidate>> {
    let edge = EdgeProfile::reference();
    let contour = |edge| ContourRenderer::new(edge, Compositing::default());
    let (vertices, harmonics) = USUAL;
    let mut all: Vec<Candidate> = Vec::new();
    for k in VERTICES {
        all.push(candidate("vertices", k.to_string(), contour(edge), (k, harmonics))?);
    }
    for n in HARMONICS {
        all.push(candidate("harmonics", n.to_string(), contour(edge), (vertices, n))?);
    }
    for px in BANDS_PX {
        all.push(candidate("band", format!("{px} px"), band(px), USUAL)?);
    }
    all.push(candidate("renderer", "contour".into(), contour(edge), USUAL)?);
    all.push(candidate("renderer", "exact".into(), ExactRenderer::default(), USUAL)?);
    all.push(candidate("renderer", "hard".into(), HardRenderer::default(), USUAL)?);
    all.push(candidate("renderer", "triangles".into(), TriangleRenderer::<f32>::default(), USUAL)?);
    let double = ContourRenderer::<f64>::default();
    all.push(("renderer", "contour".into(), Precision::F64, Box::new(Tiles::new(double, USUAL)?)));
    Ok(all)
}

/// The reference's profile, looked at so many pixels of 1/128 on both sides of an outline.
#[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
fn band(px: f64) -> ContourRenderer<f32> {
    let EdgeProfile { offset, sigma, .. } = EdgeProfile::<f64>::reference();
    // In the doubled frame.
    let squared = (px * 2.0 / 128.0).powi(2);
    let saturation = ((offset + squared) / sigma).exp().recip().clamp(f64::from(f32::MIN_POSITIVE), 0.5) as f32;
    let edge = EdgeProfile { cut: squared as f32, ..EdgeProfile::reference() };
    TileRenderer { coverage: ContourDistance { edge, saturation }, compositing: Compositing::default() }
}

fn candidate<R: Renderer<f32> + 'static>(
    sweep: &'static str,
    value: String,
    renderer: R,
    counts: (usize, usize),
) -> Result<Candidate> {
    Ok((sweep, value, Precision::F32, Box::new(Tiles::new(renderer, counts)?)))
}

/// The image that others are held against.
fn fine(picture: &Picture) -> Result<Vec<f64>> {
    let reference = EdgeProfile::<f64>::reference();
    let edge = EdgeProfile { cut: reference.offset + WIDE_SIGMAS * reference.sigma, ..reference };
    let mut tiles = Tiles::new(ContourRenderer::new(edge, picture.truth.compositing), FINE)?;
    let scene = tiles.scene(picture);
    tiles.forward(&scene, picture)?;
    Ok(tiles.image.data().to_vec())
}

/// A renderer of the core, with its memory.
struct Tiles<T: Real, R: Renderer<T>> {
    renderer: R,
    basis: OutlineBasis<T>,
    scratch: R::Scratch,
    drawing: Drawing<T>,
    drawing_grad: DrawingGrad<T>,
    scene_grad: SceneGrad<T>,
    image: Image<T>,
}

impl<T: Real, R: Renderer<T>> Tiles<T, R> {
    fn new(renderer: R, (vertices, harmonics): (usize, usize)) -> Result<Self> {
        Ok(Self {
            renderer,
            basis: OutlineBasis::new(vertices, harmonics)?,
            scratch: R::Scratch::default(),
            drawing: Drawing::default(),
            drawing_grad: DrawingGrad::default(),
            scene_grad: SceneGrad::default(),
            image: Image::zeros(dvp_cli::command::options::square(1)?),
        })
    }

    /// The scene with as many harmonics as there are.
    fn scene(&self, picture: &Picture) -> Scene<T> {
        let mut scene = picture.truth.cast();
        for object in &mut scene.objects {
            if let Some(efd) = object.shape.efd_mut() {
                *efd = efd.resized(self.basis.harmonic_count());
            }
        }
        scene
    }

    fn forward(&mut self, scene: &Scene<T>, picture: &Picture) -> Result<()> {
        let size = picture.image.size();
        if self.image.size() != size {
            self.image = Image::zeros(size);
        }
        scene.draw(&self.basis, &mut self.drawing)?;
        Ok(self.renderer.render(&self.drawing, size, &mut self.scratch, self.image.data_mut())?)
    }

    fn backward(&mut self, scene: &Scene<T>, target: &Image<T>) -> Result<()> {
        scene.draw(&self.basis, &mut self.drawing)?;
        self.drawing_grad.reset(&self.drawing);
        self.scene_grad.reset(scene);
        let (drawing, grad) = (&self.drawing, &mut self.drawing_grad);
        self.renderer.loss_and_grad(drawing, target.view(), PixelLoss::Mae, &mut self.scratch, grad)?;
        Ok(scene.draw_vjp(&self.basis, &self.drawing_grad, &mut self.scene_grad)?)
    }
}

impl<T: Real, R: Renderer<T>> Paints for Tiles<T, R> {
    fn paint(&mut self, picture: &Picture) -> Result<Sample> {
        let scene = self.scene(picture);
        let values = picture.image.data().iter().map(|value| T::of(value.as_f64())).collect();
        let target = Image::from_planar(picture.image.size(), values)?;
        let forward_ms = timed_ms(CALLS, || self.forward(&scene, picture))?;
        let backward_ms = timed_ms(CALLS, || self.backward(&scene, &target))?;
        let image = self.image.data().iter().map(|value| value.as_f64()).collect();
        Ok(Sample { image, forward_ms, backward_ms })
    }
}

/// Processor time of all threads per call, in ms; nothing else may run in the process.
pub(super) fn timed_ms(calls: u32, mut work: impl FnMut() -> Result<()>) -> Result<f64> {
    const NO_CLOCK: &str = "the system has no clock of processor time";
    let clock = ProcessTime::try_now().context(NO_CLOCK)?;
    (0..calls).try_for_each(|_| work())?;
    Ok(clock.try_elapsed().context(NO_CLOCK)?.as_secs_f64() * 1e3 / f64::from(calls))
}
