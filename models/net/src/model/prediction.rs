//! Scenes of a batch.

use dvp_core::real::Real;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::scene::{Object, Pose, Scene};
use dvp_core::shape::{Efd, PrototypeBank};
use dvp_core::tensor::{Backend, Tensor, TensorError};

/// Scenes of a batch as tensors, each of as many objects as the model has slots; units as in
/// [`Scene`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Prediction<B: Backend> {
    /// batch x objects x 2.
    pub translations: Tensor<B>,
    /// batch x objects.
    pub scales: Tensor<B>,
    /// batch x objects, radians.
    pub rotations: Tensor<B>,
    /// batch x objects x 3.
    pub colors: Tensor<B>,
    /// batch x objects.
    pub confidences: Tensor<B>,
    /// batch x objects x harmonics x 4.
    pub descriptors: Tensor<B>,
    /// Weights that descriptors were mixed with, batch x objects x prototypes.
    pub prototypes: Option<Tensor<B>>,
    /// batch x 3.
    pub background: Tensor<B>,
}

impl<B: Backend> Prediction<B> {
    /// The inputs of [`SceneLossOp`](dvp_core::loss::SceneLossOp), in order.
    #[must_use]
    pub fn parts(&self) -> [&Tensor<B>; 7] {
        [
            &self.translations,
            &self.scales,
            &self.rotations,
            &self.colors,
            &self.confidences,
            &self.descriptors,
            &self.background,
        ]
    }

    /// The same numbers as constants, as far as `parts` says: translation, scale, rotation, color, confidence, descriptors,
    /// background.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn detach(&self, parts: [bool; 7]) -> Result<Self, TensorError> {
        let mut all = self.parts().map(Clone::clone);
        for (tensor, _) in all.iter_mut().zip(parts).filter(|(_, detach)| *detach) {
            *tensor = tensor.detach()?;
        }
        let [translations, scales, rotations, colors, confidences, descriptors, background] = all;
        let prototypes = self.prototypes.clone();
        Ok(Self { translations, scales, rotations, colors, confidences, descriptors, prototypes, background })
    }

    /// The scenes of all items, with every slot as an object; `prototype` names the heaviest one. Painted with `edge`,
    /// overlaps blended.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    pub fn scenes<T: Real>(&self, edge: EdgeProfile<T>) -> Result<Vec<Scene<T>>, TensorError> {
        let batch = self.background.dims().get(0).unwrap_or(0);
        let read =
            |tensor: &Tensor<B>| Ok::<_, TensorError>(tensor.to_f64()?.into_iter().map(T::of).collect::<Vec<T>>());
        let [translations, scales, rotations, colors, confidences, descriptors, background] = self.parts().map(read);
        let [translations, scales, rotations, colors] = [translations?, scales?, rotations?, colors?];
        let [confidences, descriptors, background] = [confidences?, descriptors?, background?];
        let weights = self.prototypes.as_ref().map(read).transpose()?.unwrap_or_default();
        let objects = scales.len() / batch.max(1);
        let [rows, choices] = [&descriptors, &weights].map(|values: &Vec<T>| values.len() / scales.len().max(1));
        let object = |k: usize| {
            let pose = Pose {
                translation: [translations[2 * k], translations[2 * k + 1]],
                scale: scales[k],
                rotation: rotations[k],
            };
            Object::of_efd(
                pose,
                [colors[3 * k], colors[3 * k + 1], colors[3 * k + 2]],
                confidences[k],
                Efd::new(descriptors[rows * k..rows * (k + 1)].as_chunks().0.to_vec()),
                PrototypeBank::strongest(&weights[choices * k..choices * (k + 1)]),
            )
        };
        let scene = |item: usize| Scene {
            background: [background[3 * item], background[3 * item + 1], background[3 * item + 2]],
            transparent: false,
            objects: (item * objects..(item + 1) * objects).map(object).collect(),
            edge,
            compositing: Compositing::Blend,
        };
        Ok((0..batch).map(scene).collect())
    }
}
