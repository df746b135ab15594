//! A small network with what real ones are made of: convolution, pooling, attention, layer norm, MLP.

use dvp_core::real::DType;
use dvp_core::tensor::{Parameters, ParametersError, Stride, Tensor, TensorError};

use crate::registry::Tested;

/// Pixels along a side of its images: odd, so that steps of two leave a remainder.
const SIDE: usize = 9;
/// Channels of the convolution.
const CHANNELS: usize = 6;
/// Numbers per token.
const WIDTH: usize = 8;
/// Heads of attention.
const HEADS: usize = 2;
/// Classes told apart.
const CLASSES: usize = 3;

/// Images with classes.
pub(crate) struct Data<B: Tested> {
    images: Tensor<B>,
    /// 1 for the class of an image, 0 elsewhere.
    classes: Tensor<B>,
}

/// Numbers without a pattern, -1 to 1: a linear congruential sequence with the constants of Knuth's MMIX.
pub(crate) fn numbers(seed: u64, len: usize) -> Vec<f64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 23) - 1.0
    };
    (0..8).for_each(|_| {
        next();
    });
    (0..len).map(|_| next()).collect()
}

impl<B: Tested> Data<B> {
    /// `count` images: stripes of three widths, by class, with noise.
    pub(crate) fn new(count: usize, dtype: DType) -> Result<Self, TensorError> {
        let noise = numbers(7, count * SIDE * SIDE);
        let pixel = |k: usize| {
            let (image, x) = (k / (SIDE * SIDE), k % SIDE);
            let phase = 0.7 * image as f64;
            (x as f64 * (0.6 + 0.5 * (image % CLASSES) as f64) + phase).sin() + 0.3 * noise[k]
        };
        let images = (0..count * SIDE * SIDE).map(pixel).collect();
        let classes =
            (0..count * CLASSES).map(|k| if k % CLASSES == k / CLASSES % CLASSES { 1.0 } else { 0.0 }).collect();
        let device = B::place();
        Ok(Self {
            images: Tensor::new::<f64>(images, &[count, 1, SIDE, SIDE], &device)?.cast(dtype)?,
            classes: Tensor::new::<f64>(classes, &[count, CLASSES], &device)?.cast(dtype)?,
        })
    }

    /// A part of the images.
    pub(crate) fn part(&self, start: usize, len: usize) -> Result<Self, TensorError> {
        Ok(Self { images: self.images.slice(0, start, len)?, classes: self.classes.slice(0, start, len)? })
    }
}

/// The weights at the start. Keys have no bias: softmax takes it out again, so that its gradient is rounding, which Adam
/// would blow up to full steps.
pub(crate) fn weights<B: Tested>(dtype: DType) -> Result<Parameters<B>, ParametersError> {
    let mut parameters = Parameters::new();
    let matrices: [(&str, &[usize], usize); 9] = [
        ("stem.weight", &[CHANNELS, 1, 3, 3], 9),
        ("embed.weight", &[CHANNELS, WIDTH], CHANNELS),
        ("query.weight", &[WIDTH, WIDTH], WIDTH),
        ("key.weight", &[WIDTH, WIDTH], WIDTH),
        ("value.weight", &[WIDTH, WIDTH], WIDTH),
        ("mix.weight", &[WIDTH, WIDTH], WIDTH),
        ("mlp.up.weight", &[WIDTH, 2 * WIDTH], WIDTH),
        ("mlp.down.weight", &[2 * WIDTH, WIDTH], 2 * WIDTH),
        ("head.weight", &[WIDTH, CLASSES], WIDTH),
    ];
    for (seed, (name, extents, fan)) in (1..).zip(matrices) {
        let scale = (fan as f64).sqrt().recip();
        let values: Vec<f64> = numbers(seed, extents.iter().product()).iter().map(|x| scale * x).collect();
        parameters.insert(name, &Tensor::new(values, extents, &B::place())?.cast(dtype)?)?;
    }
    let vectors = [
        ("stem.bias", CHANNELS),
        ("embed.bias", WIDTH),
        ("query.bias", WIDTH),
        ("mlp.up.bias", 2 * WIDTH),
        ("mlp.down.bias", WIDTH),
        ("head.bias", CLASSES),
    ];
    for (name, len) in vectors {
        parameters.insert(name, &Tensor::full(0.0, &[len], dtype, &B::place())?)?;
    }
    parameters.insert("norm.weight", &Tensor::full(1.0, &[WIDTH], dtype, &B::place())?)?;
    Ok(parameters)
}

/// Mean cross-entropy of the classes of `data`.
pub(crate) fn loss<B: Tested>(parameters: &Parameters<B>, data: &Data<B>) -> Result<Tensor<B>, ParametersError> {
    let get = |name: &str| parameters.get(name);
    let count = data.images.dims().extents()[0];
    let stem = data.images.conv2d(get("stem.weight")?, Stride { step: 1, padding: 1 })?;
    let stem = stem.add(&get("stem.bias")?.reshape(&[CHANNELS, 1, 1])?)?.gelu()?;
    let stem = stem.max_pool2d(3, Stride { step: 2, padding: 1 })?;
    let tokens = stem.dims().extents()[2] * stem.dims().extents()[3];
    let x = stem.reshape(&[count, CHANNELS, tokens])?.transpose()?;
    let x = x.linear(get("embed.weight")?, get("embed.bias")?)?;

    let normed = x.layer_norm(1e-5)?.mul(get("norm.weight")?)?;
    let heads = |x: Tensor<B>| x.reshape(&[count, tokens, HEADS, WIDTH / HEADS])?.permute(&[0, 2, 1, 3]);
    let query = heads(normed.linear(get("query.weight")?, get("query.bias")?)?)?;
    let key = heads(normed.matmul(get("key.weight")?)?)?;
    let value = heads(normed.matmul(get("value.weight")?)?)?;
    let scale = ((WIDTH / HEADS) as f64).sqrt().recip();
    let attention = query.matmul(&key.transpose()?)?.affine(scale, 0.0)?.softmax(3)?;
    let mixed = attention.matmul(&value)?.permute(&[0, 2, 1, 3])?.reshape(&[count, tokens, WIDTH])?;
    let x = x.add(&mixed.matmul(get("mix.weight")?)?)?;

    let up = x.linear(get("mlp.up.weight")?, get("mlp.up.bias")?)?.gelu()?;
    let x = x.add(&up.linear(get("mlp.down.weight")?, get("mlp.down.bias")?)?)?;
    let pooled = x.mean(1)?.reshape(&[count, WIDTH])?;
    let logits = pooled.linear(get("head.weight")?, get("head.bias")?)?;
    let entropy = logits.log_softmax(1)?.mul(&data.classes)?.sum(1)?;
    Ok(entropy.mean_all()?.affine(-1.0, 0.0)?)
}
