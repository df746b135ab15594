//! Walks along the cracks between the pixels inside and outside, inside on the right hand.

use alloc::vec;

use super::Connectivity;
use crate::dims::ImageSize;

/// Directions of travel in the order of right turns: +x, +y, -x, -y. The right hand of +x is +y, since y is down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// To the right.
    PlusX,
    /// Down.
    PlusY,
    /// To the left.
    MinusX,
    /// Up.
    MinusY,
}

/// One edge between a pixel inside, on the right hand, and a pixel outside or the end of the image, on the left hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crack {
    /// Column and row of the pixel corner where it starts.
    pub start: [usize; 2],
    /// Where it leads to, one pixel on.
    pub heading: Heading,
}

impl Heading {
    fn right(self) -> Self {
        match self {
            Self::PlusX => Self::PlusY,
            Self::PlusY => Self::MinusX,
            Self::MinusX => Self::MinusY,
            Self::MinusY => Self::PlusX,
        }
    }

    fn left(self) -> Self {
        self.right().right().right()
    }
}

impl Crack {
    /// Column and row of the pixel inside and of the pixel outside. Outside the image an index is `usize::MAX` or too large.
    #[must_use]
    pub fn sides(self) -> [[usize; 2]; 2] {
        let [x, y] = self.start;
        let (west, north) = (x.wrapping_sub(1), y.wrapping_sub(1));
        match self.heading {
            Heading::PlusX => [[x, y], [x, north]],
            Heading::PlusY => [[west, y], [x, y]],
            Heading::MinusX => [[west, north], [west, y]],
            Heading::MinusY => [[x, north], [west, north]],
        }
    }

    /// The corner where it ends.
    #[must_use]
    pub fn end(self) -> [usize; 2] {
        let [x, y] = self.start;
        match self.heading {
            Heading::PlusX => [x + 1, y],
            Heading::PlusY => [x, y + 1],
            Heading::MinusX => [x - 1, y],
            Heading::MinusY => [x, y - 1],
        }
    }

    /// The crack that follows; `connectivity` is what holds at the corner where this one ends.
    #[must_use]
    pub fn next(self, inside: impl Fn([usize; 2]) -> bool, connectivity: Connectivity) -> Self {
        let start = self.end();
        // The pixels ahead are those beside a crack straight on.
        let [ahead_right, ahead_left] = Self { start, heading: self.heading }.sides().map(inside);
        let heading = match (ahead_left, ahead_right, connectivity) {
            (true, true, _) | (true, false, Connectivity::Eight) => self.heading.left(),
            (false, true, _) => self.heading,
            (false, false, _) | (true, false, Connectivity::Four) => self.heading.right(),
        };
        Self { start, heading }
    }
}

/// Calls `visit` for every crack, loop after loop; the second argument says that a loop begins.
///
/// Each crack has one follower and is the follower of one, so that a loop ends where it began. Each loop heads +x
/// somewhere, so that the tops of pixels find all of them; a loop begins at the first of them in the order of the scan.
pub(super) fn walk(
    inside: impl Fn(usize) -> bool,
    size: ImageSize,
    connectivity: Connectivity,
    mut visit: impl FnMut(Crack, bool),
) {
    let (width, height) = (size.width(), size.height());
    let inside = |[x, y]: [usize; 2]| x < width && y < height && inside(y * width + x);
    let mut visited = vec![false; size.pixels()];
    for y in 0..height {
        for x in 0..width {
            let first = Crack { start: [x, y], heading: Heading::PlusX };
            let [below, above] = first.sides();
            if visited[y * width + x] || !inside(below) || inside(above) {
                continue;
            }
            let mut crack = first;
            loop {
                visit(crack, crack == first);
                if crack.heading == Heading::PlusX {
                    visited[crack.start[1] * width + crack.start[0]] = true;
                }
                crack = crack.next(inside, connectivity);
                if crack == first {
                    break;
                }
            }
        }
    }
}
