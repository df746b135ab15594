//! From a scene to a drawing: every object's outline, posed.

use super::{Drawing, Scene};
use crate::real::Real;
use crate::shape::{OutlineBasis, ShapeError};

impl<T: Real> Scene<T> {
    /// Writes the drawing of the scene; allocates nothing once `drawing` has held one of this size.
    ///
    /// Objects may have different numbers of harmonics, up to that of `basis`. *Derivative*: [`Self::draw_vjp`].
    ///
    /// # Errors
    /// [`ShapeError::TooManyHarmonics`] if an object has more harmonics than `basis`; `drawing` is then incomplete.
    ///
    /// # Examples
    /// ```
    /// use dvp_core::{Drawing, Efd, Object, Pose, Scene, shape::OutlineBasis};
    /// let pose = Pose { translation: [0.5, 0.5], scale: 0.2, rotation: 0.0 };
    /// let circle = Efd::new(vec![[1.0_f32, 0.0, 0.0, -1.0]]);
    /// let object = Object { pose, color: [1.0, 0.0, 0.0], confidence: 1.0, efd: circle, prototype: None };
    /// let scene = Scene { objects: vec![object], ..Scene::empty([1.0; 3]) };
    /// let mut drawing = Drawing::default();
    /// scene.draw(&OutlineBasis::new(64, 16)?, &mut drawing)?;
    /// assert_eq!(drawing.outline(0)[0], [0.7, 0.5]);
    /// # Ok::<(), dvp_core::shape::ShapeError>(())
    /// ```
    pub fn draw(&self, basis: &OutlineBasis<T>, drawing: &mut Drawing<T>) -> Result<(), ShapeError> {
        drawing.clear();
        drawing.background = self.background;
        for object in &self.objects {
            let first = drawing.vertices.len();
            drawing.vertices.resize(first + basis.vertex_count(), [T::zero(); 2]);
            let outline = &mut drawing.vertices[first..];
            basis.outline(object.efd.rows(), outline)?;
            object.pose.transform(outline);
            drawing.starts.push(drawing.vertices.len());
            drawing.colors.push(object.color);
            drawing.confidences.push(object.confidence);
        }
        Ok(())
    }
}
