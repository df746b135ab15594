//! Second looks at what a proposer found.

use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Host, HostDevice, Parameters};
use dvp_core::{Image, Real, Scene};

use crate::error::NetError;
use crate::look::{Layout, Look};
use crate::scene_steps::SceneSteps;
use crate::there::keep_there;
use crate::train::LookFile;
use crate::weights::Weights;

/// A network for second looks, and how often it looks.
#[derive(Clone, Debug)]
pub(super) struct Second {
    look: Look<Host>,
    looks: usize,
}

impl Second {
    pub(super) fn new(file: &LookFile, looks: usize) -> Result<Self, NetError> {
        let mut weights = Parameters::<Host>::new();
        for (name, tensor) in file.weights::<Host>(&HostDevice)?.iter() {
            weights.insert(name, &tensor.cast(f32::DTYPE)?)?;
        }
        let prototypes = Layout::of(&file.bank::<f32>()?).prototypes();
        Ok(Self { look: Look::load(file.config(), prototypes, &Weights::new(&weights).frozen())?, looks })
    }

    /// Of candidates, which keep the confidences of the first look, those that are there, with confidence 1, put right.
    ///
    /// Rationale: what is in doubt is decided by how well it is painted, and so after it was put right: the count is right in 1 picture of
    /// 100 more than if it is decided before (`tests/report/training.md`). The last look sees what is there and nothing else.
    pub(super) fn settle(
        &self,
        scene: &mut Scene<f32>,
        target: &Image<f32>,
        bank: &PrototypeBank<f32>,
        painter: &SceneSteps<f32>,
    ) -> Result<(), NetError> {
        for _ in 1..self.looks {
            self.look.correct(scene, target, bank, painter, &HostDevice)?;
        }
        keep_there(scene, target, painter)?;
        self.look.correct(scene, target, bank, painter, &HostDevice)
    }
}
