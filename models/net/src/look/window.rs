//! What a second look sees of an object: a window of the picture that moves, turns and grows with it.

use dvp_core::{Image, ImageView, Object, Real};

use super::config::LookConfig;

/// Planes of a window.
pub(crate) const PLANES: usize = 5;
/// Places along a side of every place, over which colors are averaged: large objects are seen coarsely, and what lies between two
/// places must not be lost.
const FINER: usize = 2;
/// Added to the squared length of the color's way: objects of the color of the background are not seen, and never divided by.
const FAINT: f64 = 1e-3;

/// A picture and what was painted of it, to be looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a, T> {
    pub(crate) picture: &'a Image<T>,
    /// The scene so far.
    pub(crate) painted: &'a Image<T>,
    /// Its background.
    pub(crate) background: [T; 3],
}

impl<T: Real> Sight<'_, T> {
    /// Appends the window of `object`: [`PLANES`] x side x side numbers.
    ///
    /// Colors are told from the background, in units of the way from it to the color of the object: how far along that way (1 is
    /// the object, 0 the background) and how far beside it (another object). So objects of all colors, places, sizes and angles
    /// look alike. Planes: along and beside in the picture, along and beside in the painting, the share that lies in the picture.
    pub(crate) fn window(&self, config: &LookConfig, object: &Object<T>, out: &mut Vec<T>) {
        let (side, fine) = (config.side, config.side * FINER);
        let reach = T::of(config.reach);
        let map = object.pose.similarity();
        let size = self.picture.size();
        let unit = T::of_usize(size.unit_px());
        let views = [self.picture.view(), self.painted.view()];
        let way: [T; 3] = core::array::from_fn(|c| object.color()[c] - self.background[c]);
        let square = way.iter().map(|&x| x * x).sum::<T>() + T::of(FAINT);
        let at = |k: usize| (T::of_usize(2 * k + 1) / T::of_usize(fine) - T::one()) * reach;
        let start = out.len();
        out.resize(start + PLANES * side * side, T::zero());
        let share = T::of_usize(FINER * FINER).recip();
        for place in 0..side * side {
            let (mut colors, mut inside) = ([[T::zero(); 3]; 2], T::zero());
            for part in 0..FINER * FINER {
                let (row, column) = (place / side * FINER + part / FINER, place % side * FINER + part % FINER);
                let point = map.point(dvp_core::geometry::Vec2 { x: at(column), y: at(row) });
                let taps = Taps::of([point.x * unit, point.y * unit], [size.width(), size.height()]);
                inside += if taps.inside { share } else { T::zero() };
                for (sums, view) in colors.iter_mut().zip(&views) {
                    for (c, sum) in sums.iter_mut().enumerate() {
                        *sum += share * taps.value(view, c);
                    }
                }
            }
            for (k, color) in colors.iter().enumerate() {
                let off: [T; 3] = core::array::from_fn(|c| color[c] - self.background[c]);
                let along = off.iter().zip(&way).map(|(&a, &b)| a * b).sum::<T>() / square;
                let beside = off.iter().zip(&way).map(|(&a, &b)| (a - along * b).powi(2)).sum::<T>();
                let limit = T::of(3.0);
                out[start + (2 * k) * side * side + place] = along.max(-limit).min(limit);
                out[start + (2 * k + 1) * side * side + place] = (beside / square).sqrt().min(limit);
            }
            out[start + 4 * side * side + place] = inside;
        }
    }
}

/// The four pixels around a point, by how near they are; those beside the picture are its outermost.
struct Taps<T> {
    columns: [usize; 2],
    rows: [usize; 2],
    /// Share of the second column, and of the second row.
    shares: [T; 2],
    inside: bool,
    width: usize,
}

impl<T: Real> Taps<T> {
    /// Of a point in pixels.
    fn of([x, y]: [T; 2], [width, height]: [usize; 2]) -> Self {
        let ([first, second], [right, below]) = ([x, y], [width, height].map(|len| T::of_usize(len)));
        let inside = first >= T::zero() && first < right && second >= T::zero() && second < below;
        let (columns, along) = pair(x, width);
        let (rows, down) = pair(y, height);
        Self { columns, rows, shares: [along, down], inside, width }
    }

    fn value(&self, view: &ImageView<'_, T>, channel: usize) -> T {
        let pixels = view.channel(channel);
        let row = |row: usize| {
            let [left, right] = self.columns.map(|column| pixels[row * self.width + column]);
            left + (right - left) * self.shares[0]
        };
        let [above, below] = self.rows.map(row);
        above + (below - above) * self.shares[1]
    }
}

/// The two of `len` pixels in a line whose middles lie around `place`, and the share of the second.
fn pair<T: Real>(place: T, len: usize) -> ([usize; 2], T) {
    let last = len.saturating_sub(1);
    let place = (place - T::of(0.5)).max(T::zero()).min(T::of_usize(last));
    let first = place.floor().to_usize().unwrap_or(0).min(last);
    ([first, (first + 1).min(last)], place - T::of_usize(first))
}
