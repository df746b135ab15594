//! Sheets of sample pictures.

use anyhow::{Context, Result};
use dvp_core::{Image, ImageSize};
use dvp_net::decompose::PartsOf;

/// Pixels between pictures.
const GAP: usize = 2;

/// Pictures in rows, each row from the left, on white. All have the size of the first.
pub(super) fn sheet(rows: &[Vec<Image<f32>>]) -> Result<Image<f32>> {
    let tile = rows.iter().flatten().next().context("no sample to draw")?.size();
    let (width, height) = (tile.width() + GAP, tile.height() + GAP);
    let longest = rows.iter().map(Vec::len).max().unwrap_or(1);
    let size = ImageSize::new(longest * width - GAP, rows.len() * height - GAP)?;
    let mut sheet = Image::zeros(size);
    sheet.data_mut().fill(1.0);
    for (row, pictures) in rows.iter().enumerate() {
        for (column, picture) in pictures.iter().enumerate() {
            for channel in 0..3 {
                let view = picture.view();
                for (y, pixels) in view.channel(channel).chunks_exact(tile.width()).enumerate() {
                    let start = channel * size.pixels() + (row * height + y) * size.width() + column * width;
                    sheet.data_mut()[start..start + pixels.len()].copy_from_slice(pixels);
                }
            }
        }
    }
    Ok(sheet)
}

/// What a decomposer makes of a picture, as a row: the picture, all parts together, then the mask of every part, then what every
/// part shows where its mask is, on white.
pub(super) fn of_parts(picture: &Image<f32>, parts: &PartsOf) -> Result<Vec<Image<f32>>> {
    let mut row = vec![picture.clone(), parts.reconstruction()];
    for mask in parts.masks() {
        row.push(Image::from_planar(parts.size(), mask.repeat(3))?);
    }
    for (mask, colors) in parts.masks().zip(parts.colors()) {
        let shown = colors.iter().zip(mask.iter().cycle()).map(|(color, share)| share * color + (1.0 - share));
        row.push(Image::from_planar(parts.size(), shown.collect())?);
    }
    Ok(row)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_in_rows() {
        let one = |value: f32| {
            let mut image = Image::zeros(ImageSize::new(2, 1).unwrap());
            image.data_mut().fill(value);
            image
        };
        let grid = sheet(&[vec![one(0.1), one(0.2)], vec![one(0.3), one(0.4)]]).unwrap();
        assert_eq!((grid.size().width(), grid.size().height()), (6, 4));
        let view = grid.view();
        let row = |y: usize| &view.channel(1)[6 * y..6 * (y + 1)];
        assert_eq!(row(0), [0.1, 0.1, 1.0, 1.0, 0.2, 0.2]);
        assert_eq!(row(1), [1.0; 6]);
        assert_eq!(row(3), [0.3, 0.3, 1.0, 1.0, 0.4, 0.4]);
    }
}
