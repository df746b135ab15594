//! What pixels leave open of an object: its angle, and what of it is hidden or outside of the picture.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use super::Found;
use super::flat::FlatPicture;
use super::search::Shapes;
use crate::pose::gauss_newton::Frame;
use crate::{Ambiguity, Completion};

/// What is open of objects that are painted in `order`; they are called by their places in it.
pub(super) fn doubts(picture: &FlatPicture, found: &[Found], order: &[usize], shapes: &Shapes) -> Vec<Ambiguity> {
    let mut owner = vec![None; picture.color_of.len()];
    for (object, &at) in order.iter().enumerate() {
        found[at].pixels.iter().for_each(|&pixel| owner[pixel] = Some(object));
    }
    let mut open = Vec::new();
    for (object, &at) in order.iter().enumerate() {
        let posed = &found[at].posed;
        let symmetry = shapes.symmetry(posed.prototype);
        if symmetry != 1 {
            open.push(Ambiguity::Symmetry { object, order: symmetry });
        }
        let frame = Frame::new(&posed.pose);
        let (mut hidden, mut outside, mut all) = (0.0, 0.0, 0.0);
        for &vertex in shapes.outline(posed.prototype) {
            all += 1.0;
            match picture.pixel_at(frame.to_pixels(vertex)) {
                None => outside += 1.0,
                Some(pixel) if owner[pixel].is_some_and(|other| other > object) => hidden += 1.0,
                Some(_) => (),
            }
        }
        if hidden > 0.0 {
            open.push(Ambiguity::Hidden { object, share: hidden / all, completion: Completion::Prototype });
        }
        if outside > 0.0 {
            open.push(Ambiguity::Cropped { object, visible: 1.0 - outside / all });
        }
    }
    open
}

impl FlatPicture {
    /// The pixel that a point (px) lies in; none outside of the picture.
    fn pixel_at(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let (width, height) = (self.size.width(), self.size.height());
        let is_inside = x >= 0.0 && y >= 0.0 && x < f64::of_usize(width) && y < f64::of_usize(height);
        is_inside.then(|| y.to_count() * width + x.to_count())
    }
}
