//! The angle between the gradients of L_x and L_p.

use anyhow::Result;
use dvp_core::loss::{Loss, SceneLoss, SceneLossScratch, ScenePairs};
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::scene::{DrawingGrad, ObjectGrad, SceneGrad};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize, Scene};

use super::Setting;

/// Harmonics of the scenes of MDS-HR.
pub(super) const HARMONICS: usize = 64;

/// What a scene's numbers are about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aspect {
    Translation,
    Scale,
    Rotation,
    Color,
    Shape,
    Background,
}

impl Aspect {
    pub(super) const ALL: [Self; 6] =
        [Self::Translation, Self::Scale, Self::Rotation, Self::Color, Self::Shape, Self::Background];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Scale => "scale",
            Self::Rotation => "rotation",
            Self::Color => "color",
            Self::Shape => "shape",
            Self::Background => "background",
        }
    }

    /// The numbers of a gradient that are about it, slot by slot; those of the background as of one slot.
    fn of(self, grad: &SceneGrad<f32>) -> Vec<Vec<f64>> {
        let of_slot = |object: &ObjectGrad<f32>| match self {
            Self::Translation => object.translation.to_vec(),
            Self::Scale => vec![object.scale],
            Self::Rotation => vec![object.rotation],
            Self::Color => object.color.to_vec(),
            Self::Shape => object.numbers.clone(),
            Self::Background => Vec::new(),
        };
        let slots: Vec<Vec<f32>> = match self {
            Self::Background => vec![grad.background.to_vec()],
            _ => grad.objects.iter().map(of_slot).collect(),
        };
        slots.into_iter().map(|slot| slot.into_iter().map(f64::from).collect()).collect()
    }
}

/// Works out cosines; keeps its memory.
pub(super) struct Cosines {
    pixel_loss: PixelLoss,
    size: ImageSize,
    scene_loss: SceneLoss<f32>,
    basis: OutlineBasis<f32>,
    match_scratch: SceneLossScratch<f32>,
    drawing: Drawing<f32>,
    drawing_grad: DrawingGrad<f32>,
    grads: [SceneGrad<f32>; 2],
}

impl Cosines {
    /// The one in `place`, made if there is none.
    pub(super) fn in_place(place: &mut Option<Self>, pixel_loss: PixelLoss, size: ImageSize) -> Result<&mut Self> {
        if place.is_none() {
            *place = Some(Self {
                pixel_loss,
                size,
                scene_loss: SceneLoss::reference(REFERENCE_VERTICES, HARMONICS)?,
                basis: OutlineBasis::new(REFERENCE_VERTICES, HARMONICS)?,
                match_scratch: SceneLossScratch::default(),
                drawing: Drawing::default(),
                drawing_grad: DrawingGrad::default(),
                grads: <[SceneGrad<f32>; 2]>::default(),
            });
        }
        place.as_mut().ok_or_else(|| anyhow::anyhow!("just made"))
    }

    /// Cosines at `moved` by aspect; 0 where a gradient is 0. Ours are of all slots' numbers as one vector, the published ones means
    /// over the slots.
    pub(super) fn of(&mut self, truth: &Scene<f32>, moved: &Scene<f32>, setting: Setting) -> Result<[f64; 6]> {
        let renderer = ContourRenderer::new(truth.edge, truth.compositing);
        let mut scratch = Default::default();
        let mut image = Image::zeros(self.size);
        truth.draw(&self.basis, &mut self.drawing)?;
        renderer.render(&self.drawing, self.size, &mut scratch, image.data_mut())?;
        moved.draw(&self.basis, &mut self.drawing)?;
        self.drawing_grad.reset(&self.drawing);
        let grad = &mut self.drawing_grad;
        renderer.loss_and_grad(&self.drawing, image.view(), self.pixel_loss, &mut scratch, grad)?;
        self.grads.iter_mut().for_each(|grad| grad.reset(moved));
        moved.draw_vjp(&self.basis, &self.drawing_grad, &mut self.grads[0])?;
        let pairs = ScenePairs::new(core::slice::from_ref(moved), core::slice::from_ref(truth))?;
        self.scene_loss.vjp(pairs, 1.0, &mut self.match_scratch, &mut self.grads[1..])?;
        Ok(Aspect::ALL.map(|aspect| {
            let [image, scene] = [0, 1].map(|k| aspect.of(&self.grads[k]));
            match setting {
                Setting::Ours => cosine(&image.concat(), &scene.concat()),
                Setting::Published => mean_cosine(&image, &scene),
            }
        }))
    }
}

/// The mean over the slots; in those without an object both gradients, or one of them, are 0.
fn mean_cosine(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| cosine(a, b)).sum::<f64>() / a.len().max(1) as f64
}

fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let lengths = (dot(a, a) * dot(b, b)).sqrt();
    if lengths > 0.0 { dot(a, b) / lengths } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::pairs::pairs;
    use super::*;

    #[test]
    fn cosines_by_hand() {
        assert!((cosine(&[3.0, 0.0], &[1.0, 1.0]) - 0.5_f64.sqrt()).abs() < 1e-12);
        assert!(cosine(&[0.0, 0.0], &[1.0, 1.0]).abs() < 1e-12);
        // One slot agrees, one is turned by an eighth, one has no object.
        let [a, b] = [[1.0, 0.0], [2.0, 0.0]].map(|first| vec![first.to_vec(), vec![3.0, 0.0], vec![0.0, 0.0]]);
        let b = vec![b[0].clone(), vec![1.0, 1.0], b[2].clone()];
        assert!((mean_cosine(&a, &b) - (1.0 + 0.5_f64.sqrt()) / 3.0).abs() < 1e-12);
    }

    #[test]
    fn colors_of_a_scene_that_is_all_but_right_agree() {
        let size = ImageSize::new(64, 64).unwrap();
        let pair = &pairs(1, size, 3)[0];
        let mut wrong = pair.truth.clone();
        wrong.background[0] += 0.05;
        let mut place = None;
        let cosines = Cosines::in_place(&mut place, PixelLoss::Mse, size).unwrap();
        for setting in [Setting::Ours, Setting::Published] {
            let found = cosines.of(&pair.truth, &wrong, setting).unwrap();
            assert!((found[5] - 1.0).abs() < 1e-6, "both losses pull at the background's red alone: {found:?}");
        }
    }
}
