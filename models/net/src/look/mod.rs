//! A second look: objects that were found, looked at again one by one and put right.
//!
//! ```text
//! picture, scene -> painting -> window per object -> convolutions -> where it stands in its window, which shape it has -> scene
//! ```
//!
//! Rationale: a network that looks at the whole picture knows objects to some hundredths of their size. In a window that moves, turns and
//! grows with the object all objects look alike, so that little has to be learned, from as many examples as there are objects; and
//! what is off is seen as a difference between the picture and its painting. The second time less is off, and it is seen better.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Look`]: the network |
//! | `config` | [`LookConfig`]: its sizes |
//! | `window` | what it sees of an object |
//! | `correction` | what it says, applied to an object; and what it should say |
//!
//! *Source*: windows that follow what was found: Dai et al.: Instance-aware semantic segmentation via multi-task network cascades (2016);
//! looking again: Carreira et al.: Human pose estimation with iterative error feedback (2016).

mod config;
mod correction;
#[cfg(test)]
mod tests;
mod window;

use dvp_core::real::Real;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Stride, Tensor};
use dvp_core::{ImageSize, Scene};

pub use config::LookConfig;
pub(crate) use correction::{Aim, Layout};
pub(crate) use window::{PLANES, Sight};

use crate::error::{NetError, require};
use crate::layers::{Convolution, Mlp};
use crate::scene_steps::SceneSteps;
use crate::weights::Weights;

/// Side of the patches that the first layer takes, without overlap.
const PATCH: usize = 4;

/// The network: a window of an object to what is off.
#[derive(Clone, Debug)]
pub struct Look<B: Backend> {
    config: LookConfig,
    patches: Convolution<B>,
    first: Convolution<B>,
    halve: Convolution<B>,
    second: Convolution<B>,
    read: Mlp<B>,
}

impl<B: Backend> Look<B> {
    /// Takes `patches`, `first`, `halve`, `second`, each a `weight` and a `bias`, and `read`. `prototypes`: how many shapes it tells apart.
    ///
    /// # Errors
    /// [`NetError::Config`]; as [`Weights::get`].
    pub fn load(config: &LookConfig, prototypes: usize, weights: &Weights<'_, B>) -> Result<Self, NetError> {
        config.validate()?;
        require(prototypes > 0, "prototypes", prototypes, "the bank must hold at least one prototype")?;
        let [some, more] = config.channels;
        let kernels = |name: &str, channels, side, step| {
            let stride = Stride { step, padding: if side == PATCH { 0 } else { 1 } };
            Convolution::load(&weights.under(name), channels, side, stride)
        };
        let cells = config.side / PATCH / 2;
        let widths = [more * cells * cells, config.width, Layout::new(prototypes).len()];
        Ok(Self {
            config: config.clone(),
            patches: kernels("patches", [PLANES, some], PATCH, PATCH)?,
            first: kernels("first", [some, some], 3, 1)?,
            halve: kernels("halve", [some, more], 3, 2)?,
            second: kernels("second", [more, more], 3, 1)?,
            read: Mlp::load(&weights.under("read"), &widths)?,
        })
    }

    /// What is off in each window. Of every object: where its center is, in the frame of the window and in its scales (2), the logarithm of
    /// how many times as large it is (1), a logit per prototype, and the sines and then the cosines of k times the angle by which it is turned,
    /// one per prototype, k being the order of its symmetry.
    ///
    /// *Dimensions*: windows are objects x planes x side x side; the answer is objects x (3 + 3 prototypes).
    ///
    /// # Errors
    /// [`NetError::Input`] for other windows; [`NetError::Tensor`] if they are of another number type or device than the weights.
    pub fn forward(&self, windows: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        let side = self.config.side;
        let &[objects, PLANES, rows, columns] = windows.dims().extents() else {
            let must = "must be objects x 5 x side x side";
            return Err(NetError::Input { input: "windows", dims: *windows.dims(), must });
        };
        if rows != side || columns != side {
            let must = "must have as many rows and columns as the sizes say";
            return Err(NetError::Input { input: "windows", dims: *windows.dims(), must });
        }
        let mut x = self.patches.forward(windows)?.relu()?;
        x = x.add(&self.first.forward(&x)?.relu()?)?;
        x = self.halve.forward(&x)?.relu()?;
        x = x.add(&self.second.forward(&x)?.relu()?)?;
        let cells = side / PATCH / 2;
        Ok(self.read.forward(&x.reshape(&[objects, self.config.channels[1] * cells * cells])?)?)
    }

    /// Looks at every object of `scene` and puts it right: place, size, angle, shape. Colors, confidences and the background stay.
    ///
    /// # Errors
    /// As [`SceneSteps::paint`] and [`Self::forward`].
    pub fn correct<T: Real>(
        &self,
        scene: &mut Scene<T>,
        picture: &dvp_core::Image<T>,
        bank: &PrototypeBank<T>,
        painter: &SceneSteps<T>,
        device: &B::Device,
    ) -> Result<(), NetError> {
        if scene.objects.is_empty() {
            return Ok(());
        }
        let size: ImageSize = picture.size();
        let painted = painter.paint(scene, size)?;
        let sight = Sight { picture, painted: &painted, background: scene.background };
        let mut windows = Vec::new();
        for object in &scene.objects {
            sight.window(&self.config, object, &mut windows);
        }
        let side = self.config.side;
        let windows = Tensor::new(windows, &[scene.objects.len(), PLANES, side, side], device)?;
        let layout = Layout::of(bank);
        let said = self.forward(&windows)?.to_f64()?;
        for (object, said) in scene.objects.iter_mut().zip(said.chunks_exact(layout.len())) {
            layout.apply(said, object, bank);
        }
        Ok(())
    }
}
