//! What frameworks cost: one optimization step on the core alone, on the host backend, on burn and on candle.
//!
//! | id | a step of |
//! |---|---|
//! | `optp/<backend>` | OptP on 32 images of 128 x 128, 4 objects, 64 vertices, 16 harmonics, a bank of 3, f32: activations, the core's outlines, poses and MAE, gradients of all parameters, Adam; `core` does it on slices in kept memory, without tensors |
//! | `optp_dense/<backend>` | the same on one image, painted by tensor operations alone |
//! | `network/<backend>` | three convolutions (3, 16, 32, 64 channels, 3 x 3, steps of 2) of 32 images of 128 x 128 and attention over the 256 positions left, forward and backward |
//!
//! Times are processor time, with `RAYON_NUM_THREADS=1` that of one thread. All `optp` start from the same parameters; losses of the tenth step are compared before anything is timed.

#![expect(clippy::expect_used, reason = "a bench that cannot set up its work must stop")]

extern crate alloc;

mod slices;

use alloc::sync::Arc;
use core::error::Error;
use core::hint::black_box;

use cpu_time::ProcessTime;
use criterion::{Criterion, criterion_group, criterion_main};
use dvp_burn::Burn;
use dvp_candle::{Candle, CandleDevice};
use dvp_core::ImageSize;
use dvp_core::diff_op::{Batched, HostOp};
use dvp_core::optim::AdamSettings;
use dvp_core::render::{
    Compositing, ContourRenderer, DenseRenderer, EdgeProfile, PixelLoss, RenderLossOp, TensorDrawing,
};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{OutlineBasis, OutlineOp, PrototypeModel, mdshr_bank};
use dvp_core::tensor::{Adam, Backend, Host, HostDevice, Parameters, Stride, Tensor};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use slices::{Batch, LossOp, Slices};

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
fn parameters(seed: u64, batch: usize) -> Batch {
    core::array::from_fn(|k| numbers(10 * seed + k as u64, batch * width(k)))
}

/// The steps of a batch and where it starts.
struct Work {
    batch: usize,
    start: Batch,
    outline: Arc<dyn HostOp>,
    pose: Arc<dyn HostOp>,
    loss: Arc<dyn HostOp>,
    /// The same steps for slices.
    slices: Slices,
    slices_loss: LossOp,
    targets: Vec<f32>,
}

impl Work {
    fn new(batch: usize) -> Outcome<Self> {
        let (bank, basis) = (mdshr_bank::<f32>(16), OutlineBasis::new(VERTICES, 16)?);
        let renderer = ContourRenderer::<f32>::new(EdgeProfile::reference(), Compositing::default());
        let outline = OutlineOp::new(PrototypeModel::new(&bank, &basis)?, OBJECTS)?;
        let pose = PoseOp::new(OBJECTS, VERTICES)?;
        let mut slices = Slices::new(outline.clone(), pose.clone(), batch);
        let images = slices.paint(&parameters(0, batch), renderer)?;
        let targets = images.iter().flat_map(|image| image.data()).copied().collect();
        let loss = RenderLossOp::new(renderer, PixelLoss::Mae, images, OBJECTS, VERTICES)?;
        Ok(Self {
            batch,
            start: parameters(1, batch),
            outline: Arc::new(Batched::<f32, _>::new(outline)),
            pose: Arc::new(Batched::<f32, _>::new(pose)),
            loss: Arc::new(Batched::<f32, _>::new(loss.clone())),
            slices,
            slices_loss: loss,
            targets,
        })
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

fn core_alone(criterion: &mut Criterion, work: &mut Work) -> f64 {
    let Work { start, slices, slices_loss, .. } = work;
    let mut raw = start.clone();
    let mut adam = raw.each_ref().map(|values| dvp_fit::adam::Adam::new(AdamSettings::default(), values.len()));
    let mut step = || slices.step(slices_loss, &mut raw, &mut adam);
    let tenth = (0..10).map(|_| step().expect("a step")).fold(0.0, |_, loss| loss);
    time(criterion, "optp/core", step);
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
    let [mut work, one] = [BATCH, 1].map(|batch| Work::new(batch).expect("work"));
    let tenth = core_alone(criterion, &mut work);
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
