//! Scenes in one graph: parameters, activations, prototypes, outlines, images, losses; and a fit by Adam.

use dvp_core::diff_op::Atan2;
use dvp_core::loss::{SceneLoss, SceneLossOp};
use dvp_core::optim::AdamSettings;
use dvp_core::real::DType;
use dvp_core::render::{Compositing, RenderOp};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{EfdModel, MixOp, OutlineBasis, OutlineOp, mdshr_bank};
use dvp_core::tensor::{Adam, Backend, Host, Parameters, ParametersError, Tensor, TensorError};
use dvp_core::{Efd, ImageSize, Object, Pose, Scene};

use crate::check::{Computation, check};
use crate::input::{Domain, inputs};
use crate::network::numbers;
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};
use crate::step::cases::soft;
use crate::step::{Step, step};
use crate::training::same_losses;

const BATCH: usize = 2;
const OBJECTS: usize = 2;
const HARMONICS: usize = 4;
const VERTICES: usize = 12;
const PROTOTYPES: usize = 3;

/// What is learned, before activations, by name and extents; the order is that of the graph's inputs.
const PARAMETERS: [(&str, &[usize]); 7] = [
    ("background", &[BATCH, 3]),
    ("colors", &[BATCH, OBJECTS, 3]),
    ("confidences", &[BATCH, OBJECTS]),
    ("prototypes", &[BATCH, OBJECTS, PROTOTYPES]),
    ("rotations", &[BATCH, OBJECTS, 2]),
    ("scales", &[BATCH, OBJECTS]),
    ("translations", &[BATCH, OBJECTS, 2]),
];

/// Scenes of a batch after activations.
struct Activated<B: Backend> {
    background: Tensor<B>,
    colors: Tensor<B>,
    confidences: Tensor<B>,
    weights: Tensor<B>,
    rotations: Tensor<B>,
    scales: Tensor<B>,
    translations: Tensor<B>,
}

/// The steps of the graph.
#[derive(Debug)]
struct Graph {
    angle: Step,
    mix: Step,
    outline: Step,
    pose: Step,
    render: Step,
    scene_loss: Step,
    /// Images to come near to, batch x 3 x height x width.
    targets: Vec<f64>,
}

fn size() -> ImageSize {
    ImageSize::new(11, 9).unwrap()
}

impl Graph {
    /// Against the scenes that these numbers, as parameters, stand for.
    fn new(truth: &[Vec<f64>]) -> Result<Self, TensorError> {
        let mut graph = Self {
            angle: step!(T => Atan2::new(&[OBJECTS]).unwrap()),
            mix: step!(T => MixOp::<T>::new(mdshr_bank(HARMONICS), OBJECTS).unwrap()),
            outline: step!(T => {
                let basis = OutlineBasis::<T>::new(VERTICES, HARMONICS).unwrap();
                OutlineOp::new(EfdModel::new(basis), OBJECTS).unwrap()
            }),
            pose: step!(T => PoseOp::new(OBJECTS, VERTICES).unwrap()),
            render: step!(T => RenderOp::new(soft::<T>(Compositing::Blend), size(), OBJECTS, VERTICES).unwrap()),
            scene_loss: step!(T => {
                SceneLossOp::new(SceneLoss::<T>::reference(VERTICES, HARMONICS).unwrap(), vec![], OBJECTS, HARMONICS)
                    .unwrap()
            }),
            targets: Vec::new(),
        };
        let mut tensors = Vec::new();
        for (values, (_, extents)) in truth.iter().zip(PARAMETERS) {
            tensors.push(Tensor::<Host>::new(values.clone(), extents, &Host::place())?);
        }
        let activated = graph.activate(&tensors)?;
        let descriptors = graph.mix.apply(&[&activated.weights])?;
        graph.targets = graph.image(&activated, &descriptors)?.to_f64()?;
        let truths = scenes(&activated, &descriptors)?;
        graph.scene_loss = step!(T => {
            let truths = truths.iter().map(dvp_core::Scene::cast).collect();
            SceneLossOp::new(SceneLoss::<T>::reference(VERTICES, HARMONICS).unwrap(), truths, OBJECTS, HARMONICS)
                .unwrap()
        });
        Ok(graph)
    }

    fn activate<B: Backend>(&self, parameters: &[Tensor<B>]) -> Result<Activated<B>, TensorError> {
        let [background, colors, confidences, prototypes, rotations, scales, translations] = parameters else {
            panic!("{} parameters", parameters.len())
        };
        let component = |axis| rotations.slice(2, axis, 1)?.reshape(&[BATCH, OBJECTS]);
        Ok(Activated {
            background: background.sigmoid()?,
            colors: colors.sigmoid()?,
            confidences: confidences.sigmoid()?,
            weights: prototypes.softmax(2)?,
            rotations: self.angle.apply(&[&component(0)?, &component(1)?])?,
            scales: scales.sigmoid()?.affine(0.3, 0.1)?,
            translations: translations.sigmoid()?,
        })
    }

    fn image<B: Backend>(&self, scene: &Activated<B>, descriptors: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        let unit = self.outline.apply(&[&descriptors.reshape(&[BATCH, OBJECTS, 4 * HARMONICS])?])?;
        let posed = self.pose.apply(&[&unit, &scene.translations, &scene.scales, &scene.rotations])?;
        self.render.apply(&[&posed, &scene.colors, &scene.confidences, &scene.background])
    }
}

/// Scenes of what a graph holds.
fn scenes(activated: &Activated<Host>, descriptors: &Tensor<Host>) -> Result<Vec<Scene<f64>>, TensorError> {
    let [background, colors, rotations, scales, translations, rows] = [
        &activated.background,
        &activated.colors,
        &activated.rotations,
        &activated.scales,
        &activated.translations,
        descriptors,
    ]
    .map(Tensor::to_f64);
    let (background, colors, rotations, scales, translations, rows) =
        (background?, colors?, rotations?, scales?, translations?, rows?);
    let object = |k: usize| {
        let pose = Pose { translation: translations.as_chunks().0[k], scale: scales[k], rotation: rotations[k] };
        Object::of_efd(
            pose,
            colors.as_chunks().0[k],
            1.0,
            Efd::new(rows.as_chunks().0[k * HARMONICS..][..HARMONICS].to_vec()),
            None,
        )
    };
    let scene = |item: usize| Scene {
        objects: (item * OBJECTS..(item + 1) * OBJECTS).map(object).collect(),
        ..Scene::empty(background.as_chunks().0[item])
    };
    Ok((0..BATCH).map(scene).collect())
}

impl Computation for Graph {
    /// Mean squared error of each image, plus a part of each L_p.
    fn run<B: Backend>(&self, parameters: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        let scene = self.activate(parameters)?;
        let descriptors = self.mix.apply(&[&scene.weights])?;
        let image = self.image(&scene, &descriptors)?;
        let error = image.sub(&image.like(self.targets.clone(), image.dims().extents())?)?;
        let pixels = error.mul(&error)?.reshape(&[BATCH, 3 * size().pixels()])?.mean(1)?.reshape(&[BATCH])?;
        let predicted = [
            &scene.translations,
            &scene.scales,
            &scene.rotations,
            &scene.colors,
            &scene.confidences,
            &descriptors,
            &scene.background,
        ];
        pixels.add(&self.scene_loss.apply(&predicted)?.affine(0.1, 0.0)?)
    }
}

/// Numbers that stand for a batch of scenes.
fn parameter_values(seed: u64) -> Vec<Vec<f64>> {
    (seed..).zip(PARAMETERS).map(|(seed, (_, extents))| numbers(seed, extents.iter().product())).collect()
}

fn one_graph<B: Tested>(tally: &Tally) -> Outcome {
    let graph = Graph::new(&parameter_values(100))?;
    let cases = inputs(PARAMETERS.map(|(_, extents)| (extents.to_vec(), Domain::Any)).to_vec());
    for_cases(12, cases, |inputs| check::<B>(&graph, &inputs, tally))
}

fn losses<B: Tested>(dtype: DType) -> Result<Vec<f64>, ParametersError> {
    let graph = Graph::new(&parameter_values(100))?;
    let mut parameters = Parameters::<B>::new();
    for (values, (name, extents)) in parameter_values(300).into_iter().zip(PARAMETERS) {
        parameters.insert(name, &Tensor::new(values, extents, &B::place())?.cast(dtype)?)?;
    }
    let mut adam = Adam::new(AdamSettings::default());
    (0..50)
        .map(|_| {
            let inputs: Vec<Tensor<B>> = parameters.iter().map(|(_, parameter)| parameter.clone()).collect();
            let loss = graph.run(&inputs)?.mean_all()?;
            let gradients = parameters.gradients(&loss.backward()?);
            adam.step(&mut parameters, &gradients, 0.1)?;
            Ok(loss.number()?)
        })
        .collect()
}

fn fit<B: Tested>(tally: &Tally) -> Outcome {
    for dtype in [DType::F64, DType::F32] {
        same_losses(tally, dtype, &losses::<B>(dtype)?, &losses::<Host>(dtype)?)?;
    }
    Ok(())
}

#[test]
fn one_graph_everywhere() {
    on_every_backend!(one_graph);
}

#[test]
fn fit_everywhere() {
    on_every_backend!(fit);
}
