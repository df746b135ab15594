//! Pictures on the squares that models were trained on, and what is found there back on the picture.

use dvp_core::{Image, ImageSize, ImageView, Real, Scene};

use crate::error::NetError;
use crate::layers::{Taps, taps};

/// Where a picture lies on its square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square {
    /// Side of the square in units of the picture, the shorter side of which is 1.
    side: f32,
    /// Left and upper corner of the picture, in its units from that of the square.
    corner: [f32; 2],
    /// The size of the picture.
    size: ImageSize,
    /// Columns and rows of border on the left of it and above.
    before: [usize; 2],
}

impl Square {
    /// The place of a picture, and the square with `side` pixels per side.
    ///
    /// # Errors
    /// [`NetError::Image`] for a picture with NaN or infinity.
    pub(crate) fn of(image: ImageView<'_, f32>, side: usize) -> Result<(Self, Image<f32>), NetError> {
        let size = image.size();
        let (long, unit) = (size.width().max(size.height()), size.unit_px() as f32);
        let before = [size.width(), size.height()].map(|extent| (long - extent) / 2);
        let corner = before.map(|px| px as f32 / unit);
        let square = Self { side: long as f32 / unit, corner, size, before };
        // Checked here: a view may be made of an image that was written to since it was.
        let own = Image::from_planar(size, image.data().to_vec())?;
        let (Ok(target), false) = (ImageSize::new(side, side), (size.width(), size.height()) == (side, side)) else {
            return Ok((square, own));
        };
        let mut data = Vec::with_capacity(3 * target.pixels());
        for channel in 0..3 {
            data.extend(resampled(own.view().channel(channel), size, before, &taps(long, side)));
        }
        Ok((square, Image::from_planar(target, data)?))
    }

    /// A plane of the square, `side` x `side` numbers in \[0, 1\], as one of the picture.
    pub(crate) fn plane_to_picture(&self, plane: &[f32], side: usize) -> Vec<f32> {
        let (width, height) = (self.size.width(), self.size.height());
        if [width, height] == [side; 2] {
            return plane.to_vec();
        }
        let (Ok(square), taps) = (ImageSize::new(side, side), taps(side, width.max(height))) else {
            return vec![0.0; self.size.pixels()];
        };
        let whole = resampled(plane, square, [0; 2], &taps);
        let [left, above] = self.before;
        let rows = whole.chunks_exact(taps.len().max(1)).skip(above).take(height);
        rows.flat_map(|row| &row[left..left + width]).copied().collect()
    }

    /// A scene in units of the square, in those of the picture.
    pub(crate) fn to_picture(self, mut scene: Scene<f32>) -> Scene<f32> {
        for pose in scene.objects.iter_mut().map(|object| &mut object.pose) {
            for (place, corner) in pose.translation.iter_mut().zip(self.corner) {
                *place = *place * self.side - corner;
            }
            pose.scale *= self.side;
        }
        scene
    }
}

/// A channel on the square: the same taps along both axes. `before`: columns and rows of border on the left and above.
fn resampled(channel: &[f32], size: ImageSize, before: [usize; 2], taps: &[Taps]) -> Vec<f32> {
    let (width, height) = (size.width(), size.height());
    let border = f64::from(border_median(channel, width, height));
    let rows: Vec<f64> = channel
        .chunks_exact(width)
        .flat_map(|row| line(|x| f64::from(row[x]), width, before[0], border, taps))
        .collect();
    let side = taps.len();
    let columns: Vec<Vec<f64>> =
        (0..side).map(|x| line(|y| rows[y * side + x], height, before[1], border, taps).collect()).collect();
    // A cubic kernel overshoots beside edges.
    let pixel = |x: usize, y: usize| f32::of(columns[x][y].clamp(0.0, 1.0));
    (0..side).flat_map(|y| (0..side).map(move |x| pixel(x, y)).collect::<Vec<_>>()).collect()
}

/// A line of `len` values with `border` around it, resampled.
fn line(
    value: impl Fn(usize) -> f64,
    len: usize,
    before: usize,
    border: f64,
    taps: &[Taps],
) -> impl Iterator<Item = f64> {
    let at = move |place: usize| match place.checked_sub(before) {
        Some(inside) if inside < len => value(inside),
        _ => border,
    };
    taps.iter().map(move |tap| (tap.start..).zip(&tap.weights).map(|(place, weight)| weight * at(place)).sum())
}

/// The middle value of the outermost pixels, the lower one of two.
fn border_median(channel: &[f32], width: usize, height: usize) -> f32 {
    let outermost = |k: usize| {
        let (x, y) = (k % width, k / width);
        x == 0 || y == 0 || x + 1 == width || y + 1 == height
    };
    let mut values: Vec<f32> = (0..channel.len()).filter(|&k| outermost(k)).map(|k| channel[k]).collect();
    let middle = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}
