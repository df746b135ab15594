//! From a scene to a drawing: every object's outline, posed.

use super::{ColorRamp, Drawing, Scene};
use crate::real::Real;
use crate::shape::{Flattening, Outline, Shape as _, ShapeError};

impl<T: Real> Scene<T> {
    /// Writes the drawing of the scene; allocates nothing once `drawing` has held one of this size.
    ///
    /// `how` is a table of cosines for scenes of descriptors, or a [`Flattening`] that also says how closely the polygons
    /// of other shapes follow their curves. Objects may have different numbers of harmonics, up to that of the table.
    /// *Derivative*: [`Self::draw_vjp`].
    ///
    /// # Errors
    /// [`ShapeError::TooManyHarmonics`] if an object has more harmonics than the table, others if the numbers of an object
    /// describe no shape; `drawing` is then incomplete.
    ///
    /// # Examples
    /// ```
    /// use dvp_core::{Drawing, Efd, Object, Pose, Scene, shape::OutlineBasis};
    /// let pose = Pose { translation: [0.5, 0.5], scale: 0.2, rotation: 0.0 };
    /// let circle = Efd::new(vec![[1.0_f32, 0.0, 0.0, -1.0]]);
    /// let object = Object::of_efd(pose, [1.0, 0.0, 0.0], 1.0, circle, None);
    /// let scene = Scene { objects: vec![object], ..Scene::empty([1.0; 3]) };
    /// let mut drawing = Drawing::default();
    /// scene.draw(&OutlineBasis::new(64, 16)?, &mut drawing)?;
    /// assert_eq!(drawing.outline(0)[0], [0.7, 0.5]);
    /// # Ok::<(), dvp_core::shape::ShapeError>(())
    /// ```
    pub fn draw<'a>(&self, how: impl Into<Flattening<'a, T>>, drawing: &mut Drawing<T>) -> Result<(), ShapeError> {
        self.draw_flattened(how.into(), drawing)
    }

    #[inline(never)]
    pub(crate) fn draw_flattened(&self, how: Flattening<'_, T>, drawing: &mut Drawing<T>) -> Result<(), ShapeError> {
        drawing.clear();
        drawing.background = self.background;
        for object in &self.objects {
            let first = drawing.vertices.len();
            // The rings are appended in place.
            let mut outline = Outline {
                vertices: core::mem::take(&mut drawing.vertices),
                breaks: core::mem::take(&mut drawing.breaks),
            };
            let breaks = outline.breaks.len();
            let flattened = object.shape.flatten(&how.magnified(object.pose.scale), &mut outline);
            (drawing.vertices, drawing.breaks) = (outline.vertices, outline.breaks);
            flattened?;
            // An outline that was not empty begins a ring: here it is the first of an object.
            if drawing.breaks.get(breaks) == Some(&first) {
                drawing.breaks.remove(breaks);
            }
            object.pose.transform(&mut drawing.vertices[first..]);
            drawing.starts.push(drawing.vertices.len());
            drawing.colors.push(object.color());
            drawing.confidences.push(object.confidence);
            if let Some(ColorRamp { kind, stops }) = object.paint.ramp() {
                drawing.paint_last(kind.posed(&object.pose), stops);
            }
        }
        Ok(())
    }
}
