//! Images over their reconstructions.

use anyhow::{Context, Result};
use dvp_core::{Image, ImageSize};

/// Pixels between pictures.
const GAP: usize = 2;

/// The pictures of `above` in a row, those of `below` under them, on white. All have the size of the first.
pub(super) fn grid(above: &[Image<f32>], below: &[Image<f32>]) -> Result<Image<f32>> {
    let tile = above.first().context("no sample to draw")?.size();
    let (width, height) = (tile.width() + GAP, tile.height() + GAP);
    let size = ImageSize::new(above.len() * width - GAP, 2 * height - GAP)?;
    let mut grid = Image::zeros(size);
    grid.data_mut().fill(1.0);
    for (row, pictures) in [above, below].into_iter().enumerate() {
        for (column, picture) in pictures.iter().enumerate() {
            for channel in 0..3 {
                let view = picture.view();
                for (y, pixels) in view.channel(channel).chunks_exact(tile.width()).enumerate() {
                    let start = channel * size.pixels() + (row * height + y) * size.width() + column * width;
                    grid.data_mut()[start..start + pixels.len()].copy_from_slice(pixels);
                }
            }
        }
    }
    Ok(grid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_in_two_rows() {
        let one = |value: f32| {
            let mut image = Image::zeros(ImageSize::new(2, 1).unwrap());
            image.data_mut().fill(value);
            image
        };
        let grid = grid(&[one(0.1), one(0.2)], &[one(0.3), one(0.4)]).unwrap();
        assert_eq!((grid.size().width(), grid.size().height()), (6, 4));
        let view = grid.view();
        let row = |y: usize| &view.channel(1)[6 * y..6 * (y + 1)];
        assert_eq!(row(0), [0.1, 0.1, 1.0, 1.0, 0.2, 0.2]);
        assert_eq!(row(1), [1.0; 6]);
        assert_eq!(row(3), [0.3, 0.3, 1.0, 1.0, 0.4, 0.4]);
    }
}
