//! What the scene found leaves open: symmetry, what the picture cuts off, what is out of sight, twins.

use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::render::Compositing;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Real, Scene};

use super::run::{Found, FoundObject, Run};
use crate::Ambiguity;
use crate::doubt::{hidden_share, visible_share};
use crate::pose::search::symmetry_order;
use crate::tuning::ALTERNATIVE_RATIO;

/// An object of this confidence hides what is behind it.
const OPAQUE: f64 = 0.99;

impl<T: Real> FoundObject<T> {
    /// Another known shape that explains the object nearly as well, and its squared error over that of the chosen one.
    pub(super) fn alternative(&self) -> Option<(usize, f64)> {
        self.twin.filter(|&(_, ratio)| ratio < ALTERNATIVE_RATIO)
    }
}

impl<T: Real> Run<'_, T> {
    /// The drawing of the scratch must be that of the scene.
    pub(super) fn ambiguities(&self, scene: &Scene<T>, found: &Found<T>) -> Vec<Ambiguity> {
        let mut out = Vec::new();
        let unit = self.unit_px();
        for (object, part) in found.objects.iter().enumerate() {
            let order = match part.object.prototype() {
                Some(k) => self.fitter.prototypes[k].symmetry,
                None => scene.objects[object].shape.efd().map_or(1, symmetry_order),
            };
            if order != 1 {
                out.push(Ambiguity::Symmetry { object, order });
            }
            if self.scratch.segmentation.segments()[part.segment].border > 0 {
                let outline: [[T; 2]; REFERENCE_VERTICES] =
                    core::array::from_fn(|i| self.scratch.drawing.outline(object)[i].map(|x| x * unit));
                out.push(Ambiguity::Cropped { object, visible: visible_share(&outline, self.image.size()) });
            }
            out.extend(self.hidden(scene, found, object));
            out.extend(self.merged(found, object));
            if let Some((prototype, ratio)) = part.alternative() {
                out.push(Ambiguity::Twin { object, prototype, ratio });
            }
        }
        out
    }

    /// The doubt about what of an object lies behind later ones.
    fn hidden(&self, scene: &Scene<T>, found: &Found<T>, object: usize) -> Option<Ambiguity> {
        if scene.compositing != Compositing::Over {
            return None;
        }
        let FoundObject { segment, completion, .. } = found.objects[object];
        // One of its own segment is of its color: that they have run together says it all.
        let hides = |&k: &usize| scene.objects[k].confidence > T::of(OPAQUE) && found.objects[k].segment != segment;
        let drawing = &self.scratch.drawing;
        let covers = (object + 1..scene.objects.len()).filter(hides).map(|k| drawing.outline(k));
        let share = hidden_share(drawing.outline(object), covers, self.image.size());
        (share > 0.0).then_some(Ambiguity::Hidden { object, share, completion })
    }

    /// The doubt about an object that shares its segment with others.
    fn merged(&self, found: &Found<T>, object: usize) -> Option<Ambiguity> {
        let segment = found.objects[object].segment;
        let is_other = |&k: &usize| k != object && found.objects[k].segment == segment;
        let other = (0..found.objects.len()).find(is_other)?;
        let drawing = &self.scratch.drawing;
        let outline = drawing.outline(object);
        let hidden = |&&vertex: &&[T; 2]| {
            (0..found.objects.len()).filter(is_other).any(|k| contains(drawing.outline(k), vertex))
        };
        let visible = T::of_usize(outline.len() - outline.iter().filter(hidden).count());
        Some(Ambiguity::Merged { object, other, visible: (visible / T::of_usize(outline.len().max(1))).as_f64() })
    }
}
