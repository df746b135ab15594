//! Path data: the text of lines, circular arcs and cubics.

use dvp_core::geometry::Vec2;
use dvp_core::shape::Piece;

use super::number::{push, rounded};

/// How far the middle of an arc may be off because its radius is rounded, pixels.
const ARC_TOLERANCE: f64 = 5e-4;

/// Most decimals that are spent on a radius.
const MOST_DECIMALS: usize = 9;

/// Path data under way.
pub(super) struct PathData {
    text: String,
    decimals: usize,
    /// Where the pen is, as it is read back.
    pen: Vec2<f64>,
}

impl PathData {
    /// Nothing yet; numbers of pixels are going to be rounded to `decimals`.
    pub(super) fn new(decimals: usize) -> Self {
        Self { text: String::new(), decimals, pen: Vec2::default() }
    }

    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// Appends the pieces of a ring, one beginning where the one before it ends; `is_closed` if the last ends where the first
    /// begins.
    pub(super) fn ring(&mut self, pieces: &[Piece<f64>], is_closed: bool) {
        let Some(first) = pieces.first() else { return };
        self.command('M');
        self.point(first.from());
        for (k, piece) in pieces.iter().enumerate() {
            match *piece {
                // The last side of a closed ring comes with the Z.
                Piece::Line { .. } if is_closed && k + 1 == pieces.len() => (),
                Piece::Line { to, .. } => self.line(to),
                Piece::Arc { to, bulge, .. } => self.arc(to, bulge),
                Piece::Cubic([_, first, second, to]) => {
                    self.command('C');
                    for point in [first, second] {
                        self.point(point);
                        self.text.push(' ');
                    }
                    self.point(to);
                }
                Piece::Ellipse { center, axes } => self.ellipse(center, axes),
            }
        }
        if is_closed {
            self.command('Z');
        }
    }

    fn command(&mut self, letter: char) {
        self.text.push(letter);
    }

    fn point(&mut self, point: Vec2<f64>) {
        push(&mut self.text, point.x, self.decimals);
        self.text.push(',');
        push(&mut self.text, point.y, self.decimals);
        self.pen = self.rounded(point);
    }

    fn rounded(&self, point: Vec2<f64>) -> Vec2<f64> {
        Vec2::new(rounded(point.x, self.decimals), rounded(point.y, self.decimals))
    }

    /// A straight line; one along an axis needs one number.
    #[expect(clippy::float_cmp, reason = "equal as they are written")]
    fn line(&mut self, to: Vec2<f64>) {
        let end = self.rounded(to);
        let (letter, value) = match (end.x == self.pen.x, end.y == self.pen.y) {
            (true, false) => ('V', to.y),
            (false, true) => ('H', to.x),
            _ => {
                self.command('L');
                return self.point(to);
            }
        };
        self.command(letter);
        push(&mut self.text, value, self.decimals);
        self.pen = end;
    }

    fn arc(&mut self, to: Vec2<f64>, bulge: f64) {
        let chord = (self.rounded(to) - self.pen).length();
        let height = bulge.abs() * chord * 0.5;
        if height < ARC_TOLERANCE {
            return self.line(to);
        }
        let (radius, decimals) = written_radius(chord, bulge.abs(), self.decimals);
        self.command('A');
        for side in [" ", " 0 "] {
            push(&mut self.text, radius, decimals);
            self.text.push_str(side);
        }
        self.text.push_str(if bulge.abs() > 1.0 { "1 " } else { "0 " });
        self.text.push_str(if bulge > 0.0 { "1 " } else { "0 " });
        self.point(to);
    }

    /// A whole ellipse, as two halves.
    fn ellipse(&mut self, center: Vec2<f64>, axes: [Vec2<f64>; 2]) {
        let turn = axes[0].angle().to_degrees();
        let sweep = if axes[0].cross(axes[1]) > 0.0 { '1' } else { '0' };
        for end in [center - axes[0], center + axes[0]] {
            self.command('A');
            for (number, decimals) in [(axes[0].length(), self.decimals), (axes[1].length(), self.decimals), (turn, 3)]
            {
                push(&mut self.text, number, decimals);
                self.text.push(' ');
            }
            self.text.push_str("0 ");
            self.text.push(sweep);
            self.text.push(' ');
            self.point(end);
        }
    }
}

/// A radius with so many decimals that an arc over the chord, as it is read back, has the height of the bulge.
///
/// Next to a half circle the height follows the radius steeply: half a thousandth of a pixel more radius lowers an arc of radius 10 by
/// a tenth of a pixel. A radius that is too small for the chord is read as a half circle, so rounding down is tried, too.
fn written_radius(chord: f64, bulge: f64, decimals: usize) -> (f64, usize) {
    let radius = chord * (1.0 + bulge * bulge) / (4.0 * bulge);
    let off = |radius: f64| (arc_height(chord, radius, bulge > 1.0) - bulge * chord * 0.5).abs();
    for decimals in decimals..MOST_DECIMALS {
        let below = radius - 0.5 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(0));
        for candidate in [radius, below].map(|value| rounded(value, decimals)) {
            if candidate > 0.0 && off(candidate) <= ARC_TOLERANCE {
                return (candidate, decimals);
            }
        }
    }
    (radius, MOST_DECIMALS)
}

/// How far the middle of an arc is from its chord.
fn arc_height(chord: f64, radius: f64, is_large: bool) -> f64 {
    let radius = radius.max(chord * 0.5);
    let below = (radius * radius - chord * chord * 0.25).max(0.0).sqrt();
    if is_large { radius + below } else { radius - below }
}
