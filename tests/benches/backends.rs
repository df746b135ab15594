//! What frameworks cost: one optimization step on the core alone, on the host backend, on burn and on candle.
//!
//! | id | a step of |
//! |---|---|
//! | `optp/<backend>` | OptP on 32 images of 128 x 128, 4 objects, 64 vertices, 16 harmonics, a bank of 3, f32: activations, the core's outlines, poses and MAE, gradients of all parameters, Adam; `core` does it on slices, without tensors |
//! | `optp_dense/<backend>` | the same on one image, painted by tensor operations alone |
//! | `network/<backend>` | three convolutions (3, 16, 32, 64 channels, 3 x 3, steps of 2) of 32 images of 128 x 128 and attention over the 256 positions left, forward and backward |
//!
//! Times are processor time, with `RAYON_NUM_THREADS=1` that of one thread. All `optp` start from the same parameters; losses of the tenth step are compared before anything is timed.

#![expect(clippy::expect_used, reason = "a bench that cannot set up its work must stop")]

extern crate alloc;

use alloc::sync::Arc;
use core::error::Error;
use core::hint::black_box;

use cpu_time::ProcessTime;
use criterion::{Criterion, criterion_group, criterion_main};
use dvp_burn::Burn;
use dvp_candle::{Candle, CandleDevice};
use dvp_core::diff_op::{Batched, HostOp};
use dvp_core::optim::AdamSettings;
use dvp_core::real::{Real, Values, ValuesRef};
use dvp_core::render::{
    Compositing, ContourRenderer, DenseRenderer, EdgeProfile, PixelLoss, RenderLossOp, RenderOp, TensorDrawing,
};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{OutlineBasis, OutlineOp, PrototypeModel, mdshr_bank};
use dvp_core::tensor::{Adam, Backend, Host, HostDevice, Parameters, Stride, Tensor};
use dvp_core::{Image, ImageSize};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

type Outcome<T> = Result<T, Box<dyn Error>>;

const BATCH: usize = 32;
const OBJECTS: usize = 4;
const VERTICES: usize = 64;
const PROTOTYPES: usize = 3;
/// Small: the scenes timed last are still those timed first.
const LEARNING_RATE: f64 = 1e-4;
/// Scales are 0.05 to 0.35.
const SCALES: [f64; 2] = [0.3, 0.05];

/// What is optimized, by name and extents per item, before activations; in the order of names.
const PARAMETERS: [(&str, &[usize]); 7] = [
    ("background", &[3]),
    ("colors", &[OBJECTS, 3]),
    ("confidences", &[OBJECTS]),
    ("prototypes", &[OBJECTS, PROTOTYPES]),
    ("rotations", &[OBJECTS]),
    ("scales", &[OBJECTS]),
    ("translations", &[OBJECTS, 2]),
];

/// Numbers of -1 to 1.
fn numbers(seed: u64, len: usize) -> Vec<f32> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..len).map(|_| rng.random_range(-1.0..1.0)).collect()
}

/// Numbers per item of parameter `k`.
fn width(k: usize) -> usize {
    PARAMETERS[k].1.iter().product()
}

/// Parameters of scenes, `seed` for each of `batch` items.
fn parameters(seed: u64, batch: usize) -> [Vec<f32>; 7] {
    core::array::from_fn(|k| numbers(10 * seed + k as u64, batch * width(k)))
}

/// The steps of a batch and where it starts.
struct Work {
    batch: usize,
    start: [Vec<f32>; 7],
    outline: Arc<dyn HostOp>,
    pose: Arc<dyn HostOp>,
    loss: Arc<dyn HostOp>,
    targets: Vec<f32>,
}

impl Work {
    fn new(batch: usize) -> Outcome<Self> {
        let (bank, basis) = (mdshr_bank::<f32>(16), OutlineBasis::new(VERTICES, 16)?);
        let renderer = ContourRenderer::<f32>::new(EdgeProfile::reference(), Compositing::default());
        let outline = Arc::new(Batched::new(OutlineOp::new(PrototypeModel::new(&bank, &basis)?, OBJECTS)?));
        let pose: Arc<dyn HostOp> = Arc::new(Batched::<f32, _>::new(PoseOp::new(OBJECTS, VERTICES)?));
        let render = Batched::<f32, _>::new(RenderOp::new(renderer, size(), OBJECTS, VERTICES)?);
        let mut work =
            Self { batch, start: parameters(1, batch), outline, loss: pose.clone(), pose, targets: Vec::new() };
        let truth = work.activate(&parameters(0, batch));
        let [_, _, drawing] = work.rows(&truth)?;
        work.targets = taken(render.forward(batch, ValuesRef::F32(&drawing), false)?.0)?;
        let images = work.targets.chunks_exact(3 * size().pixels());
        let images = images.map(|image| Image::from_planar(size(), image.to_vec())).collect::<Result<_, _>>()?;
        let loss = RenderLossOp::new(renderer, PixelLoss::Mae, images, OBJECTS, VERTICES)?;
        work.loss = Arc::new(Batched::<f32, _>::new(loss));
        Ok(work)
    }

    /// Parameters in the units of scenes.
    fn activate(&self, raw: &[Vec<f32>; 7]) -> [Vec<f32>; 7] {
        let mut scenes = raw.clone();
        for k in [0, 1, 2, 5, 6] {
            scenes[k].iter_mut().for_each(|x| *x = 1.0 / (1.0 + (-*x).exp()));
        }
        for weights in scenes[3].chunks_exact_mut(PROTOTYPES) {
            let most = weights.iter().copied().fold(f32::MIN, f32::max);
            weights.iter_mut().for_each(|x| *x = (*x - most).exp());
            let sum: f32 = weights.iter().sum();
            weights.iter_mut().for_each(|x| *x /= sum);
        }
        scenes[5].iter_mut().for_each(|x| *x = f32::of(SCALES[0]) * *x + f32::of(SCALES[1]));
        scenes
    }

    /// Inputs of the steps, item by item: of outlines, poses and the loss.
    fn rows(&self, scenes: &[Vec<f32>; 7]) -> Outcome<[Vec<f32>; 3]> {
        let [background, colors, confidences, weights, rotations, scales, translations] = scenes;
        let units = taken(self.outline.forward(self.batch, ValuesRef::F32(weights), true)?.0)?;
        let units = self.join(&[&units, translations, scales, rotations]);
        let posed = taken(self.pose.forward(self.batch, ValuesRef::F32(&units), true)?.0)?;
        Ok([weights.clone(), units, self.join(&[&posed, colors, confidences, background])])
    }

    /// Items of several inputs, side by side.
    fn join(&self, parts: &[&[f32]]) -> Vec<f32> {
        let item = |item: usize| {
            parts.iter().flat_map(move |part| &part[item * (part.len() / self.batch)..][..part.len() / self.batch])
        };
        (0..self.batch).flat_map(item).copied().collect()
    }

    /// Undoes [`Self::join`].
    fn cut<const N: usize>(&self, rows: &[f32], widths: [usize; N]) -> [Vec<f32>; N] {
        let total = rows.len() / self.batch;
        let mut start = 0;
        widths.map(|width| {
            start += width;
            rows.chunks_exact(total).flat_map(|row| &row[start - width..start]).copied().collect()
        })
    }

    /// A step on slices; the loss before it.
    fn core(&self, raw: &mut [Vec<f32>; 7], adam: &mut [dvp_fit::adam::Adam<f32>; 7]) -> Outcome<f64> {
        let scenes = self.activate(raw);
        let [weights, units, drawing] = self.rows(&scenes)?;
        let (losses, saved) = self.loss.forward(self.batch, ValuesRef::F32(&drawing), true)?;
        let share = vec![f32::of(1.0 / self.batch as f64); self.batch];
        let back = |op: &Arc<dyn HostOp>, input: &[f32], saved: ValuesRef<'_>, grad: &[f32]| {
            taken(op.vjp(self.batch, ValuesRef::F32(input), saved, ValuesRef::F32(grad))?)
        };
        let (nothing, outline) = (ValuesRef::F32(&[]), OBJECTS * VERTICES * 2);
        let grad = back(&self.loss, &drawing, saved.as_ref(), &share)?;
        let [posed, colors, confidences, background] = self.cut(&grad, [outline, width(1), width(2), width(0)]);
        let grad = back(&self.pose, &units, nothing, &posed)?;
        let [unit, translations, scales, rotations] = self.cut(&grad, [outline, width(6), width(5), width(4)]);
        let weights_grad = back(&self.outline, &weights, nothing, &unit)?;
        let mut grads = [background, colors, confidences, weights_grad, rotations, scales, translations];
        for (k, factor) in [(0, 1.0), (1, 1.0), (2, 1.0), (5, SCALES[0]), (6, 1.0)] {
            let offset = if k == 5 { SCALES[1] } else { 0.0 };
            for (slope, &value) in grads[k].iter_mut().zip(&scenes[k]) {
                let unit = (value - f32::of(offset)) / f32::of(factor);
                *slope *= f32::of(factor) * unit * (1.0 - unit);
            }
        }
        for (slopes, weights) in grads[3].chunks_exact_mut(PROTOTYPES).zip(weights.chunks_exact(PROTOTYPES)) {
            let mean: f32 = slopes.iter().zip(weights).map(|(slope, weight)| slope * weight).sum();
            slopes.iter_mut().zip(weights).for_each(|(slope, weight)| *slope = weight * (*slope - mean));
        }
        for ((values, grad), adam) in raw.iter_mut().zip(&grads).zip(adam) {
            adam.step(values, grad, LEARNING_RATE);
        }
        Ok(losses.to_f64().iter().sum::<f64>() / self.batch as f64)
    }

    /// The start as named parameters.
    fn parameters<B: Backend>(&self, device: &B::Device) -> Outcome<Parameters<B>> {
        let mut parameters = Parameters::new();
        for ((name, extents), values) in PARAMETERS.into_iter().zip(&self.start) {
            let extents = [&[self.batch], extents].concat();
            parameters.insert(name, &Tensor::new(values.clone(), &extents, device)?)?;
        }
        Ok(parameters)
    }

    /// A step on tensors; the loss before it. With `dense`, painted by tensor operations against these targets.
    fn step<B: Backend>(
        &self,
        parameters: &mut Parameters<B>,
        adam: &mut Adam<B>,
        dense: Option<&(DenseRenderer, Tensor<B>)>,
    ) -> Outcome<f64> {
        let get = |name: &str| parameters.get(name);
        let unit = Tensor::apply_shared(&self.outline, &[&get("prototypes")?.softmax(2)?])?;
        let scales = get("scales")?.sigmoid()?.affine(SCALES[0], SCALES[1])?;
        let outlines = [&unit, &get("translations")?.sigmoid()?, &scales, get("rotations")?];
        let outlines = Tensor::apply_shared(&self.pose, &outlines)?;
        let [colors, confidences, background] =
            ["colors", "confidences", "background"].map(|name| Ok::<_, Box<dyn Error>>(get(name)?.sigmoid()?));
        let drawing = TensorDrawing { outlines, colors: colors?, confidences: confidences?, background: background? };
        let losses = if let Some((renderer, targets)) = dense {
            renderer.pixel_loss(&drawing, targets, PixelLoss::Mae)?
        } else {
            let TensorDrawing { outlines, colors, confidences, background } = &drawing;
            Tensor::apply_shared(&self.loss, &[outlines, colors, confidences, background])?
        };
        let loss = losses.mean_all()?;
        let gradients = parameters.gradients(&loss.backward()?);
        adam.step(parameters, &gradients, LEARNING_RATE)?;
        Ok(loss.number()?)
    }
}

fn size() -> ImageSize {
    ImageSize::new(128, 128).expect("a size")
}

fn taken(values: Values) -> Outcome<Vec<f32>> {
    f32::from_values(values).ok_or_else(|| "f32 expected".into())
}

/// Times steps, in processor time of all threads: what else runs on the machine counts little.
fn time<T>(criterion: &mut Criterion, id: &str, mut step: impl FnMut() -> Outcome<T>) {
    criterion.bench_function(id, |bencher| {
        bencher.iter_custom(|count| {
            let start = ProcessTime::now();
            (0..count).for_each(|_| drop(black_box(step().expect("a step"))));
            start.elapsed()
        });
    });
}

fn core_alone(criterion: &mut Criterion, work: &Work) -> f64 {
    let mut raw = work.start.clone();
    let mut adam = raw.each_ref().map(|values| dvp_fit::adam::Adam::new(AdamSettings::default(), values.len()));
    let tenth = (0..10).map(|_| work.core(&mut raw, &mut adam).expect("a step")).fold(0.0, |_, loss| loss);
    time(criterion, "optp/core", || work.core(&mut raw, &mut adam));
    tenth
}

/// Times steps on a backend, the tenth of which has the loss `tenth`; none: painted by tensor operations.
fn optp<B: Backend>(criterion: &mut Criterion, id: &str, device: &B::Device, work: &Work, tenth: Option<f64>) {
    let dense = tenth.is_none().then(|| {
        let targets = Tensor::new(work.targets.clone(), &[work.batch, 3, 128, 128], device).expect("targets");
        (DenseRenderer::new(EdgeProfile::reference(), Compositing::default(), size()).expect("a renderer"), targets)
    });
    let mut parameters = work.parameters::<B>(device).expect("parameters");
    let mut adam = Adam::new(AdamSettings::default());
    if let Some(tenth) = tenth {
        let own = (0..10).map(|_| work.step(&mut parameters, &mut adam, None).expect("a step")).fold(0.0, |_, x| x);
        assert!((own - tenth).abs() < 1e-6, "{}: {own}, not {tenth}", B::NAME);
    }
    time(criterion, &format!("{id}/{}", B::NAME), || work.step(&mut parameters, &mut adam, dense.as_ref()));
}

/// Forward and backward of a small network.
fn network<B: Backend>(criterion: &mut Criterion, device: &B::Device) {
    let images = Tensor::<B>::new(numbers(0, BATCH * 3 * 128 * 128), &[BATCH, 3, 128, 128], device).expect("images");
    let weights: [&[usize]; 7] =
        [&[16, 3, 3, 3], &[32, 16, 3, 3], &[64, 32, 3, 3], &[64, 64], &[64, 64], &[64, 64], &[64, 64]];
    let weights = weights.map(|extents| {
        let weight = Tensor::<B>::new(numbers(1, extents.iter().product()), extents, device);
        weight.and_then(|weight| weight.affine(0.1, 0.0)?.parameter()).expect("weights")
    });
    let step = || -> Outcome<_> {
        let [first, second, third, query, key, value, mix] = &weights;
        let mut x = images.clone();
        for kernels in [first, second, third] {
            x = x.conv2d(kernels, Stride { step: 2, padding: 1 })?.relu()?;
        }
        let x = x.reshape(&[BATCH, 64, 256])?.transpose()?;
        let scores = x.matmul(query)?.matmul(&x.matmul(key)?.transpose()?)?.affine(0.125, 0.0)?;
        let mixed = scores.softmax(2)?.matmul(&x.matmul(value)?)?.matmul(mix)?;
        let gradients = x.add(&mixed)?.abs()?.mean_all()?.backward()?;
        Ok(weights.each_ref().map(|weight| gradients.of(weight)))
    };
    time(criterion, &format!("network/{}", B::NAME), step);
}

fn backends(criterion: &mut Criterion) {
    let [work, one] = [BATCH, 1].map(|batch| Work::new(batch).expect("work"));
    let tenth = core_alone(criterion, &work);
    let (host, burn, candle) = (HostDevice, <Burn as Backend>::Device::flex(), CandleDevice::CPU);
    optp::<Host>(criterion, "optp", &host, &work, Some(tenth));
    optp::<Burn>(criterion, "optp", &burn, &work, Some(tenth));
    optp::<Candle>(criterion, "optp", &candle, &work, Some(tenth));
    optp::<Host>(criterion, "optp_dense", &host, &one, None);
    optp::<Burn>(criterion, "optp_dense", &burn, &one, None);
    optp::<Candle>(criterion, "optp_dense", &candle, &one, None);
    network::<Host>(criterion, &host);
    network::<Burn>(criterion, &burn);
    network::<Candle>(criterion, &candle);
}

criterion_group!(name = benches; config = Criterion::default().sample_size(10); targets = backends);
criterion_main!(benches);
