//! What a person kept exact across a whole drawing: equal coordinates, radii and widths, and a grid that they lie on.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `numbers` | layers | coordinates, radii and widths, with the doubt of each |
//! | `classes` | numbers of one kind | which of them are equal |
//! | `grid` | classes | the step of the grid that most of them lie on |
//! | `places` | classes, a grid | where a number may go, and what saying so costs |
//! | `figure` | circles, ellipses, rectangles | the same at those places |
//! | `circle` | arcs | circles at those places |
//! | `ring` | a row of lines, arcs and cubics | the same at those places: a dynamic programme |
//! | `border` | an outline | the same, on the border of the picture where it lies along it |
//!
//! *Why*: a number that is on a grid needs the bits of one of the grid's places, fewer than one that is told to the precision of
//! the picture. A number only moves while what is drawn stays where it was within the doubt of its position, so a tie that is true
//! takes a drawing nearer to the artist's, and one that is not costs no more than what cannot be seen.

mod border;
mod circle;
mod classes;
mod figure;
mod grid;
mod numbers;
mod places;
mod ring;
#[cfg(test)]
mod tests;

use crate::layers::{Form, Layers};
use crate::outline::OutlineShape;
use crate::ruler::Ruler;
use grid::Grid;
use numbers::Kind;
use places::Places;

/// Moves the numbers of layers to where a person has put them. `size`: width and height of the picture, pixels.
///
/// Returns the step of the grid that the drawing lies on, pixels, if it has one; numbers lie on halves and quarters of it as well.
pub fn tie(layers: &mut Layers, size: [usize; 2]) -> Option<f64> {
    let [width, height] = size.map(|side| side as f64);
    let ruler = Ruler { extent: width.max(height) };
    let classes = numbers::of(layers).map(|numbers| classes::classes(numbers, &ruler));
    let grid = Grid::infer(&classes, &ruler);
    let places = Places::new(&classes, grid, &ruler);
    for layer in &mut layers.layers {
        match &mut layer.form {
            Form::Stroked(stroke) => {
                stroke.width = places.cheapest(Kind::Length, stroke.width, places::LIMIT);
                stroke.rings.iter_mut().for_each(|line| ring::tie(line, &places));
            }
            Form::Filled(outlines) => {
                for outline in outlines {
                    match &mut outline.shape {
                        OutlineShape::Path(path) => ring::tie(path, &places),
                        shape => figure::tie(shape, &places),
                    }
                    border::tie(outline, [width, height]);
                }
            }
        }
    }
    grid.map(|grid| grid.step)
}
