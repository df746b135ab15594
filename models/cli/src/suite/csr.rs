//! Arrays of the compositional-scene-representation suites to scenes.

use std::path::Path;

use dvp_core::ImageSize;

use super::SuiteScene;
use crate::format::{ByteArray, FormatError, Place, read_npz};

/// The arrays that are read, where they are there.
const ARRAYS: [&str; 4] = ["image", "segment", "layers", "masks"];

/// The first `count` scenes of an archive with `image` (number x height x width x 3, or x 1), `segment` (number x height x width)
/// and `layers` (number x layers x height x width x channels, the last one the mask) or `masks` (the same of one channel).
///
/// The first layer is in front of all others, the last one is the background; `segment` tells the layer that each pixel shows.
///
/// # Errors
/// [`FormatError`] if the file is no such archive.
pub(super) fn read(path: &Path, count: usize) -> Result<Vec<SuiteScene>, FormatError> {
    let arrays = read_npz(path, &ARRAYS)?;
    let find = |name: &str| arrays.iter().find(|(own, _)| own == name).map(|(_, array)| array);
    let wrong = |field: &str, problem: String| FormatError::Field {
        place: Place::file(path),
        field: format!("array '{field}'"),
        problem,
    };
    let missing = |name| wrong(name, "is missing; save image, segment and layers of one group".to_owned());
    let image = find("image").ok_or_else(|| missing("image"))?;
    let segment = find("segment").ok_or_else(|| missing("segment"))?;
    let layers = find("layers").or_else(|| find("masks")).ok_or_else(|| missing("layers"))?;
    let &[number, height, width, channels @ (1 | 3)] = &image.shape[..] else {
        let problem = format!("has the extents {:?}, must be number x height x width x 3 (or 1)", image.shape);
        return Err(wrong("image", problem));
    };
    if segment.shape != [number, height, width] {
        let problem = format!("has the extents {:?}, must be {number} x {height} x {width}", segment.shape);
        return Err(wrong("segment", problem));
    }
    let &[own_number, layer_count @ (1..), own_height, own_width, layer_channels @ (1..)] = &layers.shape[..] else {
        let problem =
            format!("has the extents {:?}, must be number x layers x height x width x channels", layers.shape);
        return Err(wrong("layers", problem));
    };
    if [own_number, own_height, own_width] != [number, height, width] {
        let problem = format!("has the extents {:?}, those of the images are {:?}", layers.shape, image.shape);
        return Err(wrong("layers", problem));
    }
    let size = ImageSize::new(width, height).map_err(|error| wrong("image", error.to_string()))?;
    let extents = Extents { size, channels, layer_count, layer_channels };
    Ok((0..number.min(count)).map(|index| extents.scene(index, image, segment, layers)).collect())
}

/// What all scenes of an archive have alike.
struct Extents {
    size: ImageSize,
    channels: usize,
    layer_count: usize,
    layer_channels: usize,
}

impl Extents {
    fn scene(&self, index: usize, image: &ByteArray, segment: &ByteArray, layers: &ByteArray) -> SuiteScene {
        let pixels = self.size.pixels();
        let colors = &image.values[index * pixels * self.channels..][..pixels * self.channels];
        let colors = colors.chunks_exact(self.channels).flat_map(|color| match *color {
            [red, green, blue] => [red, green, blue],
            _ => [color[0]; 3],
        });
        let mask = |layer: usize| {
            let start = (index * self.layer_count + layer) * pixels * self.layer_channels;
            layers.values[start..][..pixels * self.layer_channels]
                .chunks_exact(self.layer_channels)
                .map(|c| c[c.len() - 1])
        };
        // From the one behind all others to the one in front; layers of fewer objects than there is room for are empty.
        let objects = (0..self.layer_count - 1).rev().filter(|&layer| mask(layer).any(|value| value > 0));
        let objects: Vec<usize> = objects.collect();
        let label =
            |&layer: &u8| (1..).zip(&objects).find(|&(_, &own)| own == usize::from(layer)).map_or(0, |(k, _)| k);
        SuiteScene {
            size: self.size,
            pixels: colors.collect(),
            labels: segment.values[index * pixels..][..pixels].iter().map(label).collect(),
            whole: objects.iter().flat_map(|&layer| mask(layer)).collect(),
            classes: Vec::new(),
        }
    }
}
