//! Features to one latent per slot.

use dvp_core::tensor::{Backend, Tensor};

use super::config::{ModelConfig, Slots};
use crate::detr::{ConditionalDetr, DetrEncoder};
use crate::error::{NetError, require};
use crate::layers::LayerNorm;
use crate::weights::Weights;

/// Added to variances: PyTorch's default.
const NORM_EPSILON: f64 = 1e-5;

/// What fills the slots.
#[derive(Clone, Debug)]
pub(super) enum SlotReader<B: Backend> {
    /// Queries that look around in the image: the paper's decoder.
    Queries(ConditionalDetr<B>),
    /// The places of the grid themselves, each with the objects whose center it holds.
    Cells { encoder: DetrEncoder<B>, norm: LayerNorm<B>, grid: [usize; 2] },
}

impl<B: Backend> SlotReader<B> {
    pub(super) fn load(config: &ModelConfig, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        let transformer = &config.transformer;
        match config.slots {
            Slots::Queries => Ok(Self::Queries(ConditionalDetr::load(transformer, weights)?)),
            Slots::Cells { rows, columns } => {
                let count = rows * columns;
                require(count > 0, "slots.cells", format!("{rows} x {columns}"), "must be at least 1 x 1")?;
                let encoder = DetrEncoder::load(transformer, &weights.under("encoder"))?;
                let norm = LayerNorm::load(&weights.under("norm"), transformer.d_model, NORM_EPSILON)?;
                Ok(Self::Cells { encoder, norm, grid: [rows, columns] })
            }
        }
    }

    /// batch x slots x width.
    pub(super) fn forward(&self, features: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        match self {
            Self::Queries(transformer) => Ok(transformer.forward(features)?.latents),
            Self::Cells { encoder, norm, grid } => {
                if features.dims().extents().get(2..) != Some(&grid[..]) {
                    let must = "the grid must be that of slots.cells in the sizes; resize the image";
                    return Err(NetError::Input { input: "features", dims: *features.dims(), must });
                }
                let [tokens, _] = encoder.forward(features)?;
                Ok(norm.forward(&tokens)?)
            }
        }
    }
}

/// Centers of the cells of a grid, scene units of a square image: x, y, row by row.
pub(super) fn centers(rows: usize, columns: usize) -> Vec<f64> {
    let center = |k: usize, count: usize| (k as f64 + 0.5) / count as f64;
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells.flat_map(|(row, column)| [center(column, columns), center(row, rows)]).collect()
}
