//! Every differentiable step of the core: host = framework = central differences, as one node of the graph.

pub(crate) mod cases;

use alloc::sync::Arc;
use std::fs;
use std::path::Path;

use dvp_core::diff_op::HostOp;
use dvp_core::real::DType;
use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, check};
use crate::input::{Domain, Input, inputs};
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};

/// The types that are steps, as they are called in the core. [`every_step_of_the_core_is_listed`] fails if one is missing.
const STEPS: [&str; 10] = [
    "Atan2",
    "ImageLossOp",
    "MixOp",
    "NormalizeOp",
    "OutlineOp",
    "PoseOp",
    "RenderLossOp",
    "RenderOp",
    "SceneLossOp",
    "Unfold",
];

/// A step made for some extents, in both number types.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pub(crate) f32: Arc<dyn HostOp>,
    pub(crate) f64: Arc<dyn HostOp>,
}

/// A step from an expression in terms of a number type.
macro_rules! step {
    ($number:ident => $op:expr) => {
        crate::step::Step {
            f32: {
                #[allow(dead_code, reason = "not every step holds numbers of its own")]
                type $number = f32;
                alloc::sync::Arc::new(dvp_core::diff_op::Batched::<f32, _>::new($op))
            },
            f64: {
                #[allow(dead_code, reason = "not every step holds numbers of its own")]
                type $number = f64;
                alloc::sync::Arc::new(dvp_core::diff_op::Batched::<f64, _>::new($op))
            },
        }
    };
}

pub(crate) use step;

impl Step {
    /// With a batch of inputs, each of a domain.
    pub(crate) fn with_inputs(
        self,
        batch: usize,
        domains: &[Domain],
    ) -> impl Strategy<Value = (Self, Vec<Input>)> + use<> {
        let signature = self.f64.signature();
        let inputs_of_batch = signature.batched_inputs(batch).unwrap();
        assert_eq!(domains.len(), inputs_of_batch.len(), "a domain for each input of {}", signature.name());
        let all = inputs_of_batch.iter().zip(domains);
        let all = all.map(|(dims, &domain)| (dims.extents().to_vec(), domain)).collect();
        (Just(self), inputs(all))
    }
}

impl Step {
    /// The step in the number type of its inputs.
    pub(crate) fn apply<B: Backend>(&self, inputs: &[&Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        let op = match inputs[0].dtype() {
            DType::F32 => &self.f32,
            DType::F64 => &self.f64,
        };
        Tensor::apply_shared(op, inputs)
    }
}

impl Computation for Step {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        self.apply(&inputs.iter().collect::<Vec<_>>())
    }

    /// Normal forms and renderings cancel digits: angles of small axes, distances that are differences of positions.
    fn rounding(&self) -> f64 {
        1e-3
    }
}

fn steps<B: Tested>(tally: &Tally) -> Outcome {
    for step in STEPS {
        for_cases(16, cases::of(step), |(step, inputs)| check::<B>(&step, &inputs, tally))?;
    }
    Ok(())
}

#[test]
fn steps_everywhere() {
    on_every_backend!(steps);
}

/// The types for which a file implements `DiffOp`.
fn implementors(text: &str) -> impl Iterator<Item = &str> {
    let impls = text.lines().filter(|line| line.starts_with("impl"));
    impls.filter_map(|line| {
        let (head, name) = line.split_once(" for ")?;
        let end = name.find(|c: char| !c.is_alphanumeric()).unwrap_or(name.len());
        head.ends_with('>').then(|| head.contains(" DiffOp<").then_some(&name[..end])).flatten()
    })
}

fn collect(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.extend(implementors(&fs::read_to_string(path).unwrap()).map(str::to_owned));
        }
    }
}

#[test]
fn every_step_of_the_core_is_listed() {
    let mut found = Vec::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src"), &mut found);
    found.sort();
    assert_eq!(found, STEPS, "steps of the core, and the list of this suite in the order of names");
    assert_eq!(implementors("impl<T: Real, R: Renderer<T>> DiffOp<T> for Render<T, R> {").next(), Some("Render"));
    assert_eq!(implementors("impl<T: Real> HostOp for Batched<T> {\n/// impl DiffOp<T> for X").next(), None);
}
