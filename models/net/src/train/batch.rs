//! What a step learns from.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use dvp_core::{Image, Real, Scene};

/// Images of one size and, where they are known, their scenes and what a frozen encoder makes of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch<T> {
    /// What the network sees; at least one.
    pub images: Vec<Image<T>>,
    /// What it should see, where that is something else: images without the noise, say. One per image, or none at all: the images
    /// themselves.
    pub clean: Vec<Image<T>>,
    /// One per image, or none at all.
    pub scenes: Vec<Scene<T>>,
    /// One per image, or none at all: the encoder is then not asked again.
    pub features: Vec<Features<T>>,
}

/// What an encoder makes of an image: numbers at the places of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Features<T> {
    /// Channels, rows, columns.
    pub extents: [usize; 3],
    /// Their values, in that order.
    pub values: Vec<T>,
}

impl<T: Clone> Batch<T> {
    /// Images with their scenes, or with none.
    #[must_use]
    pub fn new(images: Vec<Image<T>>, scenes: Vec<Scene<T>>) -> Self {
        Self { images, clean: Vec::new(), scenes, features: Vec::new() }
    }

    /// What the network should see: the clean images or, if there are none, the images.
    #[must_use]
    pub fn targets(&self) -> &[Image<T>] {
        if self.clean.is_empty() { &self.images } else { &self.clean }
    }

    /// Items `start..start + len`, as far as there are.
    #[must_use]
    pub fn part(&self, start: usize, len: usize) -> Self {
        Self {
            images: self.images.iter().skip(start).take(len).cloned().collect(),
            clean: self.clean.iter().skip(start).take(len).cloned().collect(),
            scenes: self.scenes.iter().skip(start).take(len).cloned().collect(),
            features: self.features.iter().skip(start).take(len).cloned().collect(),
        }
    }
}

impl<T: Real> Features<T> {
    /// Those of each image of a batch, batch x channels x rows x columns.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn of_batch<B: Backend>(features: &Tensor<B>) -> Result<Vec<Self>, TensorError> {
        let extents = match *features.dims().extents() {
            [_, channels, rows, columns] => [channels, rows, columns],
            _ => [features.dims().len(), 1, 1],
        };
        let values: Vec<T> = features.to_f64()?.into_iter().map(T::of).collect();
        let len = extents.iter().product::<usize>().max(1);
        Ok(values.chunks_exact(len).map(|values| Self { extents, values: values.to_vec() }).collect())
    }

    /// Those of several images as one array, batch x channels x rows x columns.
    ///
    /// # Errors
    /// [`TensorError::Values`] if their extents differ.
    pub fn stack<B: Backend>(items: &[Self], device: &B::Device) -> Result<Tensor<B>, TensorError> {
        let [channels, rows, columns] = items.first().map_or([0; 3], |first| first.extents);
        let values = items.iter().flat_map(|item| item.values.iter().copied()).collect();
        Tensor::new(values, &[items.len(), channels, rows, columns], device)
    }
}
