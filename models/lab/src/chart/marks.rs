//! The shapes of marks, painted.

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A disk.
    Circle,
    /// A square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle on its side.
    Triangle,
}

/// A mark of a color, `radius` px large; hollow marks show their rim.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stamp {
    pub(super) shape: Shape,
    pub(super) radius: i32,
    pub(super) color: RGBAColor,
    pub(super) hollow: bool,
}

impl Stamp {
    /// Paints the mark around a pixel.
    pub(super) fn paint(self, area: &DrawingArea<SVGBackend<'_>, Shift>, (x, y): (i32, i32)) -> Result<()> {
        let r = self.radius;
        let style = if self.hollow { self.color.stroke_width(self.rim()) } else { self.color.filled() };
        let corners = match self.shape {
            Shape::Circle => {
                area.draw(&Circle::new((x, y), r, style))?;
                return Ok(());
            }
            Shape::Square => vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
            Shape::Diamond => {
                let r = r + r / 3;
                vec![(x - r, y), (x, y - r), (x + r, y), (x, y + r)]
            }
            Shape::Triangle => vec![(x - r, y + r), (x + r, y + r), (x, y - r)],
        };
        if self.hollow {
            let closed: Vec<_> = corners.iter().chain(corners.first()).copied().collect();
            area.draw(&PathElement::new(closed, style))?;
        } else {
            area.draw(&Polygon::new(corners, style))?;
        }
        Ok(())
    }

    fn rim(self) -> u32 {
        u32::try_from(self.radius / 3).unwrap_or(1).max(1)
    }
}
