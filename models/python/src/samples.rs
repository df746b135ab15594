//! Random scenes, and scores of scenes against what was drawn.

use std::path::Path;

use dvp::format::{FormatError, Place, SceneJson};
use dvp::generate::{Range, SceneSettings, sample_scene};
use dvp::paint::Painter;
use dvp::score::{Row, ScoreError, Scratch, Totals, Truth, score};
use dvp_core::image::{Image, ImageError};
use dvp_core::render::Compositing;
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::border::{in_words, refusal, unlocked};
use crate::input::{Labels, PyLabels, bank};
use crate::scene::{Scene, paintable};

/// What scenes are drawn from; none: as the preset has it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Settings {
    size: Option<[usize; 2]>,
    visible: Option<[usize; 2]>,
    slots: Option<usize>,
    placements: Option<usize>,
    margin: Option<f32>,
    scale: Option<[f32; 2]>,
    color: Option<[f32; 2]>,
    background: Option<[f32; 2]>,
    compositing: Option<String>,
}

impl Settings {
    fn apply(&self, to: &mut SceneSettings) -> PyResult<()> {
        let range = |range: Option<[f32; 2]>, otherwise| match range {
            None => Ok(otherwise),
            Some([low, high]) if low.is_finite() && high.is_finite() && low <= high => Ok(Range::new(low, high)),
            Some([low, high]) => {
                Err(refusal(format!("({low}, {high}) is no range; give two numbers, the smaller one first")))
            }
        };
        if let Some([fewest, most]) = self.visible {
            (to.fewest, to.most) = (fewest, most);
            to.slots = to.slots.max(most);
        }
        to.slots = self.slots.unwrap_or(to.slots);
        to.placements = self.placements.unwrap_or(to.placements);
        to.margin = self.margin.unwrap_or(to.margin);
        to.scale = range(self.scale, to.scale)?;
        to.color = range(self.color, to.color)?;
        to.background = range(self.background, to.background)?;
        to.compositing = match self.compositing.as_deref() {
            None => to.compositing,
            Some("over") => Compositing::Over,
            Some("blend") => Compositing::Blend,
            Some(other) => return Err(refusal(format!("compositing {other:?}: must be over, blend or None"))),
        };
        to.check().map_err(refusal)
    }
}

/// The scenes number `first`, `first + 1`, ... of the data set `seed`: those that `dvp generate` draws.
#[pyfunction]
pub(crate) fn generate(
    py: Python<'_>,
    range: [u64; 2],
    seed: u64,
    preset: &str,
    bank_text: &str,
    settings: Settings,
) -> PyResult<Vec<Scene>> {
    let [first, count] = range;
    let (mut from, side) = match preset {
        "mds-hr" => (SceneSettings::mds_hr(), 128),
        "multi-dsprites" => (SceneSettings::multi_dsprites(), 64),
        other => return Err(refusal(format!("preset {other:?}: must be mds-hr or multi-dsprites"))),
    };
    settings.apply(&mut from)?;
    let [width, height] = settings.size.unwrap_or([side; 2]);
    let size = paintable(width, height)?;
    let Some(shapes) = unlocked(py, || bank(bank_text))? else {
        return Err(refusal("bank=\"none\": random scenes need shapes"));
    };
    let shapes = alloc::sync::Arc::new(shapes);
    let one = |index: u64| {
        let scene = sample_scene(&from, &shapes, size, seed, index);
        let mut json = SceneJson::from_scene(&scene, size)?;
        json.id = Some(index);
        Scene::of_json(json, Some(shapes.clone()), &Place::file(Path::new("generated scene")))
    };
    unlocked(py, || (first..first.saturating_add(count)).into_par_iter().map(one).collect::<Result<_, FormatError>>())
}

/// What a prediction is compared with: the true scene, or labels.
#[derive(FromPyObject)]
pub(crate) enum PyTruth<'py> {
    Scene(PyRef<'py, Scene>),
    Labels(PyLabels<'py>),
}

/// Why a prediction was not scored.
#[derive(Debug, thiserror::Error)]
enum EvaluateError {
    #[error(transparent)]
    Score(#[from] ScoreError),
    #[error(transparent)]
    Image(#[from] ImageError),
    #[error("a label map or a scene of {found:?} pixels for an image of {wanted:?}")]
    Size { found: [usize; 2], wanted: [usize; 2] },
}

/// Scores of one scene against its image (height x width x 3) and its truth; JSON of the paper's columns.
#[pyfunction]
pub(crate) fn evaluate(
    py: Python<'_>,
    scenes: Vec<PyRef<'_, Scene>>,
    images: Vec<PyReadonlyArray3<'_, f32>>,
    truths: Vec<Option<PyTruth<'_>>>,
) -> PyResult<String> {
    if scenes.len() != images.len() || scenes.len() != truths.len() {
        let counts = [scenes.len(), images.len(), truths.len()];
        return Err(refusal(format!("{counts:?} scenes, images and truths: must be as many of each")));
    }
    let mut scratch = Scratch::default();
    let mut rows = Vec::with_capacity(scenes.len());
    for (index, ((scene, image), truth)) in scenes.iter().zip(&images).zip(&truths).enumerate() {
        let image = image.as_array();
        let (height, width, _) = image.dim();
        let size = paintable(width, height)?;
        let values: Vec<f32> = image.iter().copied().collect();
        let found = scene.core();
        let labels = match truth {
            Some(PyTruth::Labels(labels)) => Some(match labels.to_owned() {
                Labels::Array(extents, labels) => (extents, labels),
                path @ Labels::Path(_) => {
                    let (size, labels) = unlocked(py, || path.read(size.pixels()))?;
                    ([size.height(), size.width()], labels)
                }
            }),
            _ => None,
        };
        let truth = match truth {
            Some(PyTruth::Scene(scene)) => Some(scene.core()),
            _ => None,
        };
        let own = scene.image_size();
        let result = unlocked(py, || {
            let mut one = || -> Result<_, EvaluateError> {
                let wanted = [height, width];
                let extents = labels.as_ref().map(|(extents, _)| *extents);
                for found in extents.into_iter().chain([[own.height(), own.width()]]) {
                    if found != wanted {
                        return Err(EvaluateError::Size { found, wanted });
                    }
                }
                let image = Image::from_interleaved(size, &values)?;
                let labels = labels.as_ref().map(|(_, labels)| Truth::Labels(labels));
                let known = labels.or_else(|| truth.map(Truth::Scene));
                Ok(score(&Painter::default(), image.view(), known.as_ref(), [found; 2], &mut scratch)?)
            };
            Ok::<_, core::convert::Infallible>(one().map_err(|error| in_words(&error)))
        })?;
        rows.push(Row { stem: index.to_string(), result });
    }
    serde_json::to_string(&Totals::of(&rows)).map_err(refusal)
}
