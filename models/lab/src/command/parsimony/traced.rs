//! Drawings as others trace them: paths, coordinates and bytes of SVG files.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use serde::Serialize;

/// What an SVG is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(super) struct Drawn {
    pub(super) paths: usize,
    /// Numbers of all path data.
    pub(super) coordinates: usize,
    pub(super) bytes: usize,
}

impl Drawn {
    pub(super) fn of(svg: &str) -> Self {
        let mut drawn = Self { bytes: svg.len(), ..Self::default() };
        for path in svg.split("<path").skip(1) {
            drawn.paths += 1;
            let element = path.split('>').next().unwrap_or_default();
            let data = element.split(" d=\"").nth(1).and_then(|rest| rest.split('"').next());
            drawn.coordinates += data.map_or(0, count_numbers);
        }
        drawn
    }
}

/// Numbers of path data; a sign or a letter ends the one before it.
fn count_numbers(data: &str) -> usize {
    let is_digit = |c: char| c.is_ascii_digit() || c == '.';
    let before = core::iter::once(' ').chain(data.chars());
    before.zip(data.chars()).filter(|&(before, c)| is_digit(c) && !is_digit(before)).count()
}

/// The drawings of pictures, `NAME.svg` of a folder for each.
///
/// # Errors
/// If a file is missing, or draws nothing.
pub(super) fn read<'a>(folder: &Path, stems: impl Iterator<Item = &'a str>) -> Result<Vec<Drawn>> {
    let one = |stem: &str| {
        let path = folder.join(format!("{stem}.svg"));
        let svg = fs::read_to_string(&path).with_context(|| {
            format!("{}: trace every picture of pictures/, with the same --images and --seed", path.display())
        })?;
        let drawn = Drawn::of(&svg);
        if drawn.paths == 0 {
            bail!("{}: no <path> in it", path.display());
        }
        Ok(drawn)
    };
    stems.map(one).collect()
}
