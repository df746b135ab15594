//! What goes into a computation: extents, values, and the ways in which an array can be a view of another.

use core::f64::consts::PI;

use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, Host, HostDevice, Tensor, TensorError};
use proptest::collection::vec;
use proptest::prelude::*;

/// Most values of a random array: central differences take two runs for each.
const MOST_VALUES: usize = 48;

/// How an input comes out of the array that is uploaded. Frameworks make views of it, with strides of their own.
#[derive(Clone, Debug)]
pub(crate) enum Form {
    /// As it is.
    Plain,
    /// Uploaded with the axes the other way round.
    Reversed,
    /// Uploaded one longer at both ends of an axis.
    Inside(usize),
    /// Uploaded with extent 1 along an axis, and stretched.
    Stretched(usize),
}

/// An input of a computation.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    dims: Vec<usize>,
    form: Form,
    /// Whether gradients are kept for it.
    pub(crate) tracked: bool,
    /// What is uploaded.
    pub(crate) values: Vec<f64>,
}

impl Input {
    /// The uploaded array.
    pub(crate) fn leaf<B: Backend>(
        &self,
        values: &[f64],
        dtype: DType,
        device: &B::Device,
    ) -> Result<Tensor<B>, TensorError> {
        let dims = Dims::new(&uploaded(&self.dims, &self.form))?;
        Tensor::from_values(Values::F64(values.to_vec()).cast(dtype), &dims, device)
    }

    /// The input that is made of it.
    pub(crate) fn view<B: Backend>(&self, leaf: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        match self.form {
            Form::Plain => Ok(leaf.clone()),
            Form::Reversed => leaf.permute(&(0..self.dims.len()).rev().collect::<Vec<_>>()),
            Form::Inside(axis) => leaf.slice(axis, 1, self.dims[axis]),
            Form::Stretched(_) => leaf.expand(&self.dims),
        }
    }
}

fn uploaded(dims: &[usize], form: &Form) -> Vec<usize> {
    let mut dims = dims.to_vec();
    match *form {
        Form::Plain => {}
        Form::Reversed => dims.reverse(),
        Form::Inside(axis) => dims[axis] += 2,
        Form::Stretched(axis) => dims[axis] = 1,
    }
    dims
}

/// Which values an operation is checked on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Domain {
    /// -2 to 2.
    Any,
    /// Between two numbers.
    Between(f64, f64),
    /// As `Any`, but at least 0.1 from 0, where |x| and max(x, 0) have a kink and 1 / x a pole.
    AwayFromZero,
    /// At least 0.05 from each other: a largest number stays the largest when it is moved a little.
    Distinct,
    /// Descriptors, .. x harmonics x 4, that fall as 1 / n^2; the first harmonic is an ellipse far from a circle, whose axes
    /// would have no direction.
    Descriptors,
    /// Outlines, .. x vertices x 2, around the middle of the image: distinct rays, radii 0.1 to 0.4.
    Outlines,
}

impl Domain {
    /// Logarithms and roots.
    pub(crate) const POSITIVE: Self = Self::Between(0.2, 3.0);

    /// Whether values belong together along the axes behind the first.
    fn is_structured(self) -> bool {
        matches!(self, Self::Descriptors | Self::Outlines)
    }
}

/// Values of a domain for these extents.
fn values(domain: Domain, dims: &[usize]) -> BoxedStrategy<Vec<f64>> {
    let len = dims.iter().product();
    let rows = dims.len().checked_sub(2).map_or(1, |axis| dims[axis]);
    match domain {
        Domain::Any => vec(-2.0..2.0, len).boxed(),
        Domain::Between(low, high) => vec(low..high, len).boxed(),
        Domain::AwayFromZero => vec((0.1..2.0, any::<bool>()), len)
            .prop_map(|x: Vec<(f64, bool)>| x.into_iter().map(|(x, negative)| if negative { -x } else { x }).collect())
            .boxed(),
        Domain::Distinct => (Just((0..len).collect::<Vec<_>>()).prop_shuffle(), vec(0.0..0.05, len))
            .prop_map(move |(order, jitter)| {
                let middle = order.len() as f64 / 2.0;
                order.iter().zip(jitter).map(|(&rank, jitter)| (rank as f64 - middle) * 0.1 + jitter).collect()
            })
            .boxed(),
        Domain::Descriptors => vec(prop::array::uniform4(-0.1..0.1), len / 4)
            .prop_map(move |mut shapes| {
                for (k, row) in shapes.iter_mut().enumerate() {
                    let n = (k % rows + 1) as f64;
                    row.iter_mut().for_each(|value| *value *= 3.0 / (n * n));
                    if k % rows == 0 {
                        *row = [0.9 + row[0] / 3.0, row[1] / 3.0, row[2] / 3.0, -0.45 + row[3] / 3.0];
                    }
                }
                shapes.into_flattened()
            })
            .boxed(),
        Domain::Outlines => vec((0.1..0.4, 0.1..0.9), len / 2)
            .prop_map(move |points| {
                let vertex = |(k, (radius, jitter)): (usize, (f64, f64))| {
                    let (sin, cos) = (((k % rows) as f64 + jitter) / rows as f64 * 2.0 * PI).sin_cos();
                    [0.5 + radius * cos, 0.5 + radius * sin]
                };
                points.into_iter().enumerate().flat_map(vertex).collect()
            })
            .boxed(),
    }
}

/// Extents of `rank` axes, 1 and odd ones most often.
pub(crate) fn dims(rank: core::ops::RangeInclusive<usize>) -> impl Strategy<Value = Vec<usize>> {
    let extent = prop_oneof![2 => Just(1_usize), 1 => Just(2), 2 => Just(3), 1 => Just(4), 1 => Just(5), 1 => Just(7)];
    vec(extent, rank).prop_filter("few values", |dims| dims.iter().product::<usize>() <= MOST_VALUES)
}

/// An input of the given extents, tracked, in any form.
pub(crate) fn input(dims: Vec<usize>, domain: Domain) -> impl Strategy<Value = Input> {
    let axes = 0..dims.len().max(1);
    // All items of a batch may be equal; vertices of an outline may not.
    let stretched = if domain.is_structured() { 0..1 } else { axes.clone() };
    let form = prop_oneof![
        2 => Just(Form::Plain),
        2 => Just(Form::Reversed),
        1 => axes.prop_map(Form::Inside),
        1 => stretched.prop_map(Form::Stretched),
    ];
    // A single number has no axes to view.
    let form = if dims.is_empty() { Just(Form::Plain).boxed() } else { form.boxed() };
    (form, values(domain, &dims)).prop_map(move |(form, values)| Input {
        values: stored(&dims, &form, values).unwrap(),
        dims: dims.clone(),
        form,
        tracked: true,
    })
}

/// What must be uploaded for a view to hold `values`; of those that a stretched axis repeats, the first.
fn stored(dims: &[usize], form: &Form, values: Vec<f64>) -> Result<Vec<f64>, TensorError> {
    let view = Tensor::<Host>::new(values, dims, &HostDevice)?;
    match *form {
        Form::Plain => view,
        Form::Reversed => view.permute(&(0..dims.len()).rev().collect::<Vec<_>>())?,
        Form::Inside(axis) => {
            let mut end = dims.to_vec();
            end[axis] = 1;
            // Numbers that nothing may read.
            let end = Tensor::full(1e3, &end, DType::F64, &HostDevice)?;
            Tensor::concat(&[&end, &view, &end], axis)?
        }
        Form::Stretched(axis) => view.slice(axis, 0, 1)?,
    }
    .to_f64()
}

/// Inputs of the given extents; at least one of them is tracked.
pub(crate) fn inputs(all: Vec<(Vec<usize>, Domain)>) -> impl Strategy<Value = Vec<Input>> {
    let count = all.len();
    let each: Vec<_> = all.into_iter().map(|(dims, domain)| input(dims, domain)).collect();
    // Half of the time all, as the bits of a number below 2^count otherwise.
    let tracked = prop_oneof![Just((1_u32 << count) - 1), 1..1_u32 << count];
    (each, tracked).prop_map(|(mut inputs, tracked)| {
        for (bit, input) in inputs.iter_mut().enumerate() {
            input.tracked = tracked >> bit & 1 == 1;
        }
        inputs
    })
}

/// Two extents that broadcast to `dims`: axes shrunk to 1, and leading ones of extent 1 left out.
pub(crate) fn broadcast_pair(rank: core::ops::RangeInclusive<usize>) -> impl Strategy<Value = [Vec<usize>; 2]> {
    let shrunk = vec(prop_oneof![3 => Just(false), 1 => Just(true)], 8);
    (dims(rank), shrunk, 0_usize..3, 0_usize..2).prop_map(|(dims, shrunk, dropped, which)| {
        let mut pair = [dims.clone(), dims.clone()];
        for axis in 0..dims.len() {
            for (side, pair) in pair.iter_mut().enumerate() {
                // Never both: the result keeps the extents.
                if shrunk[2 * axis + side] && !(side == 1 && shrunk[2 * axis]) {
                    pair[axis] = 1;
                }
            }
        }
        let drop = dropped.min(dims.len());
        pair[which].drain(..drop);
        pair
    })
}
