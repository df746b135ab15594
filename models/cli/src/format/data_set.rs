//! Data sets: a folder of images, with the scenes they were drawn from or label maps where known.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use dvp_core::Real;
use dvp_fit::Bank;

use super::labels::{is_truth, labels_beside};
use super::{FormatError, MAX_TEXT, Place, SceneJson, mdshr_bank, read_bank};

/// The file of a data set that holds its scenes, one per line.
pub const SCENES_FILE: &str = "scenes.jsonl";

/// Endings of the pictures that are read.
const PICTURE_ENDINGS: [&str; 14] =
    ["png", "jpg", "jpeg", "bmp", "gif", "webp", "pnm", "pbm", "pgm", "ppm", "pam", "tif", "tiff", "jfif"];

/// Banks that may lie beside the scenes, or one folder up.
const BANK_FILES: [&str; 2] = ["bank.json", "efd_tables.json"];

/// An image of a data set.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Name without ending; predictions are called `{stem}.json`.
    pub stem: String,
    /// The picture; may be missing where the scene is known.
    pub image: PathBuf,
    /// The scene it was drawn from, and where that stands.
    pub scene: Option<(SceneJson, Place)>,
    /// Its label map, `{stem}.labels.png`, if there is one.
    pub labels: Option<PathBuf>,
}

/// A folder of images.
#[derive(Clone, Debug)]
pub struct DataSet<T> {
    /// In the order of the scenes, or of the names.
    pub samples: Vec<Sample>,
    /// What scenes without descriptors refer to.
    pub bank: Bank<T>,
}

impl<T: Real> DataSet<T> {
    /// Reads a folder: `scenes.jsonl` with `00000.png`, ... or, without that file, all pictures by name. The bank is
    /// `bank.json` or `efd_tables.json` in the folder or the one above, or else the built-in one of MDS-HR.
    ///
    /// # Errors
    /// [`FormatError`] if the folder cannot be read, holds nothing, or a line is bad.
    pub fn open(folder: &Path) -> Result<Self, FormatError> {
        let scenes = folder.join(SCENES_FILE);
        let samples = if scenes.exists() { samples_of_scenes(folder, &scenes)? } else { samples_of_images(folder)? };
        if samples.is_empty() {
            return Err(FormatError::Nothing { path: folder.to_path_buf(), what: "scene and no image" });
        }
        Ok(Self { samples, bank: bank_near(folder)? })
    }
}

/// The bank that scenes in `folder` refer to.
///
/// # Errors
/// [`FormatError`] if there is a bank that cannot be read.
pub fn bank_near<T: Real>(folder: &Path) -> Result<Bank<T>, FormatError> {
    let above = folder.join("..");
    let mut places = BANK_FILES.iter().flat_map(|name| [folder.join(name), above.join(name)]);
    places.find(|path| path.is_file()).map_or_else(|| Ok(mdshr_bank()), |path| read_bank(&path))
}

/// The pictures of a folder, by name; neither label maps, images of whole objects nor what lies in sub-folders.
///
/// # Errors
/// [`FormatError::Read`] if the folder cannot be listed.
pub fn pictures_of(folder: &Path) -> Result<Vec<PathBuf>, FormatError> {
    let refused = |source| FormatError::Read { path: folder.to_path_buf(), source };
    let mut pictures = Vec::new();
    for entry in fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        let ending = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        if ending.is_some_and(|ending| PICTURE_ENDINGS.contains(&ending.as_str())) && !is_truth(&path) && !path.is_dir()
        {
            pictures.push(path);
        }
    }
    pictures.sort();
    Ok(pictures)
}

fn samples_of_images(folder: &Path) -> Result<Vec<Sample>, FormatError> {
    let samples = pictures_of(folder)?.into_iter().map(|image| Sample {
        stem: image.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
        labels: labels_beside(&image),
        image,
        scene: None,
    });
    Ok(samples.collect())
}

fn samples_of_scenes(folder: &Path, scenes: &Path) -> Result<Vec<Sample>, FormatError> {
    let mut samples = Vec::new();
    for (scene, place) in read_scene_lines(scenes)? {
        let id = scene.id.unwrap_or(samples.len() as u64);
        let stem = format!("{id:05}");
        let image = folder.join(format!("{stem}.png"));
        samples.push(Sample { labels: labels_beside(&image), image, stem, scene: Some((scene, place)) });
    }
    Ok(samples)
}

/// The scenes of a file with one per line, blank lines skipped; numbers are not yet checked.
///
/// # Errors
/// [`FormatError`] if the file cannot be read or a line is too long or no scene.
pub fn read_scene_lines(path: &Path) -> Result<Vec<(SceneJson, Place)>, FormatError> {
    let refused = |source| FormatError::Read { path: path.to_path_buf(), source };
    let mut reader = BufReader::new(File::open(path).map_err(refused)?);
    let mut scenes = Vec::new();
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        let read = reader.by_ref().take(MAX_TEXT + 1).read_until(b'\n', &mut line).map_err(refused)?;
        let place = Place::line(path, number);
        if read == 0 {
            break;
        }
        if read as u64 > MAX_TEXT {
            return Err(FormatError::TooLong { place, limit: MAX_TEXT });
        }
        if !line.trim_ascii().is_empty() {
            scenes.push((SceneJson::parse(&line, &place)?, place));
        }
    }
    Ok(scenes)
}
