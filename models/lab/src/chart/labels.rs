//! Where labels find room: beside what they name, over nothing that is already there.

/// Directions in which a label may stand from its mark, in the order in which they are tried.
const DIRECTIONS: [(f64, f64); 12] = [
    (1.0, 0.0),
    (0.9, -0.7),
    (0.9, 0.7),
    (0.0, -1.0),
    (0.0, 1.0),
    (-0.9, -0.7),
    (-0.9, 0.7),
    (-1.0, 0.0),
    (0.5, -1.0),
    (0.5, 1.0),
    (-0.5, -1.0),
    (-0.5, 1.0),
];

/// Distances from the mark that are tried, of the smallest one.
const RINGS: [f64; 7] = [1.0, 2.0, 3.2, 4.6, 6.4, 8.6, 11.0];

/// A rectangle of pixels: left, top, right, bottom.
pub(super) type Frame = [f64; 4];

/// What is taken of a plot.
#[derive(Debug)]
pub(super) struct Room {
    bounds: Frame,
    taken: Vec<Frame>,
}

/// Where a label stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Its frame.
    pub(super) frame: Frame,
    /// Whether it is so far from its mark that a line should lead there.
    pub(super) far: bool,
}

impl Room {
    pub(super) fn new(bounds: Frame) -> Self {
        Self { bounds, taken: Vec::new() }
    }

    /// Keeps labels off a frame.
    pub(super) fn take(&mut self, frame: Frame) {
        self.taken.push(frame);
    }

    /// Finds room for a label of some width and height beside a mark, `gap` px off at least, and takes it; `None` where
    /// there is none.
    pub(super) fn place(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), gap: f64) -> Option<Place> {
        for ring in RINGS {
            for (right, down) in DIRECTIONS {
                let center_x = x + right * (ring * gap + 0.5 * width);
                let center_y = y + down * (ring * gap + 0.5 * height);
                let (left, top) = (center_x - 0.5 * width, center_y - 0.5 * height);
                let frame = [left, top, left + width, top + height];
                if inside(frame, self.bounds) && !self.taken.iter().any(|&other| overlap(frame, other)) {
                    self.take(frame);
                    return Some(Place { frame, far: ring > 1.0 });
                }
            }
        }
        None
    }
}

fn inside(frame: Frame, bounds: Frame) -> bool {
    frame[0] >= bounds[0] && frame[1] >= bounds[1] && frame[2] <= bounds[2] && frame[3] <= bounds[3]
}

fn overlap(a: Frame, b: Frame) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
