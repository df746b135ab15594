//! The memory of a refinement, scenes to pixels and back, and what a rendering tells.

use alloc::vec::Vec;

use dvp_core::contour::signed_area;
use dvp_core::render::Renderer;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::scene::Pose;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Efd, ImageSize, ImageView, Object, Real, Scene};

use crate::covariance::Displaced;
use crate::doubt::visible_share;
use crate::joint::{JointObject, JointScene, JointScratch};
use crate::pose::gauss_newton::PosePx;
use crate::pose::search::Prototype;
use crate::residual::Residual;
use crate::{Ambiguity, FitError};

/// Different shapes that a scratch remembers the distance fields of; beyond them it starts afresh.
const REMEMBERED_SHAPES: usize = 64;

/// Memory of [`Refine`](super::Refine), kept between images; it remembers the shapes it has met.
#[derive(Debug, Default)]
pub struct RefineScratch<T: Real> {
    basis: Option<OutlineBasis<T>>,
    efds: Vec<Efd<T>>,
    /// One per descriptor of `efds`.
    pub(super) shapes: Vec<Prototype<T>>,
    pub(super) joint: JointScratch<T>,
    pub(super) drawing: Drawing<T>,
    render: <ContourRenderer<T> as Renderer<T>>::Scratch,
    pub(super) pixels: Vec<T>,
    pub(super) residual: Residual<T>,
    pub(super) differences: Vec<T>,
}

impl<T: Real> RefineScratch<T> {
    /// Draws `scene` and keeps the residual of its rendering; returns the mean absolute error.
    pub(super) fn compare(&mut self, scene: &Scene<T>, image: ImageView<'_, T>) -> Result<T, FitError> {
        let harmonics = scene.harmonic_count().max(1);
        let basis = match self.basis.take() {
            Some(basis) if basis.harmonic_count() >= harmonics => basis,
            _ => OutlineBasis::new(REFERENCE_VERTICES, harmonics)?,
        };
        scene.draw(&*self.basis.insert(basis), &mut self.drawing)?;
        self.pixels.resize(image.data().len(), T::zero());
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        renderer.render(&self.drawing, image.size(), &mut self.render, &mut self.pixels)?;
        Ok(self.residual.measure(&image, &self.pixels))
    }

    /// The scene in pixels, with the index of each object's shape among the remembered ones.
    pub(super) fn posed(&mut self, scene: &Scene<T>, unit_px: T) -> Result<JointScene<T>, FitError> {
        if self.efds.len() + scene.objects.len() > REMEMBERED_SHAPES {
            self.efds.clear();
            self.shapes.clear();
        }
        let mut objects = Vec::with_capacity(scene.objects.len());
        for (index, object) in scene.objects.iter().enumerate() {
            let Pose { translation, scale, rotation } = object.pose;
            if scale <= T::zero() {
                return Err(FitError::Scale { index });
            }
            objects.push(JointObject {
                shape: self.shape_of(object.shape.descriptors()?, index)?,
                pose: PosePx {
                    translation: translation.map(|v| v * unit_px),
                    log_scale: (scale * unit_px).ln(),
                    rotation,
                },
                color: object.color(),
                confidence: object.confidence,
            });
        }
        Ok(JointScene { background: scene.background, objects })
    }

    fn shape_of(&mut self, efd: &Efd<T>, index: usize) -> Result<usize, FitError> {
        if let Some(known) = self.efds.iter().position(|other| other == efd) {
            return Ok(known);
        }
        let shape = self.basis.as_ref().map_or(Ok(None), |basis| Prototype::new(efd, basis))?;
        self.shapes.push(shape.ok_or(FitError::FlatObject { index })?);
        self.efds.push(efd.clone());
        Ok(self.efds.len() - 1)
    }

    /// The IoU to expect of what the image shows of the objects of the scene drawn last, whose poses have these covariances.
    pub(super) fn expected_iou(&self, posed: &JointScene<T>, covariance: &[[T; 25]], size: ImageSize) -> Vec<T> {
        let unit_px = T::of_usize(size.unit_px());
        let limits = [size.width(), size.height()].map(T::of_usize);
        let objects = posed.objects.iter().zip(covariance).enumerate();
        let expected = objects.map(|(object, (part, covariance))| {
            let outline: Vec<[T; 2]> = self.drawing.outline(object).iter().map(|v| v.map(|x| x * unit_px)).collect();
            let is_seen = |edge: usize| (0..2).all(|c| outline[edge][c] >= T::zero() && outline[edge][c] < limits[c]);
            let length = |edge: usize| {
                let [a, b] = [outline[edge], outline[edge + 1]];
                (b[0] - a[0]).hypot(b[1] - a[1])
            };
            let edges = || 0..outline.len().saturating_sub(1);
            let (all, seen): (T, T) = (edges().map(length).sum(), edges().filter(|&k| is_seen(k)).map(length).sum());
            // As much of the area as of the outline.
            let area = signed_area(&outline).abs() * seen / all.max(T::of(1e-3));
            let center = part.pose.translation;
            let displaced = Displaced { outline: &outline, center, unit_px, covariance, stride: 5, own: T::zero() };
            displaced.expected_iou(is_seen, seen, area)
        });
        expected.collect()
    }

    /// Symmetry and crop of the objects of the scene drawn last.
    pub(super) fn ambiguities(&self, posed: &JointScene<T>, image: ImageView<'_, T>, unit_px: T) -> Vec<Ambiguity> {
        let mut out = Vec::new();
        for (object, part) in posed.objects.iter().enumerate() {
            let order = self.shapes[part.shape].symmetry;
            if order != 1 {
                out.push(Ambiguity::Symmetry { object, order });
            }
            let outline: Vec<[T; 2]> = self.drawing.outline(object).iter().map(|v| v.map(|x| x * unit_px)).collect();
            let visible = visible_share(&outline, image.size());
            if visible < 1.0 {
                out.push(Ambiguity::Cropped { object, visible });
            }
        }
        out
    }
}

/// `start` with the poses and colors of `moved`.
pub(super) fn to_scene<T: Real>(start: &Scene<T>, moved: &JointScene<T>, unit_px: T) -> Scene<T> {
    let objects = start.objects.iter().zip(&moved.objects).map(|(object, part)| Object {
        pose: part.pose.in_scene(unit_px),
        paint: part.color.into(),
        ..object.clone()
    });
    Scene { background: moved.background, objects: objects.collect(), ..*start }
}
