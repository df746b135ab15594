//! A scene, in every form that the command writes.

use alloc::sync::Arc;
use core::time::Duration;
use std::path::Path;

use dvp::export::{ExportError, Found, MeasuredPicture, label_map, label_map_in, measure, normal_efd, whole_coverage};
use dvp::format::{FormatError, Picture, Place, SceneJson, bank_to_json};
use dvp::paint::Painter;
use dvp::svg::to_svg_numbered;
use dvp_core::{Efd, Image, ImageSize, Real as _};
use dvp_fit::{Bank, Fit};
use numpy::{IntoPyArray as _, PyArray1, PyArray2, PyArray3, PyArrayMethods as _, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::border::{MOST_PIXELS, exception, refusal, unlocked};
use crate::input::{self, InputError, PySource, Source};

/// What errors call scenes that came as text.
const TEXT: &str = "scene";

/// A scene, and what is known of it.
#[pyclass(frozen, module = "dvp._dvp")]
pub(crate) struct Scene {
    scene: dvp_core::Scene<f32>,
    json: SceneJson,
    size: ImageSize,
    covariance: Vec<[f32; 25]>,
    bank: Option<Arc<Bank<f32>>>,
    /// What the objects are called, one number each.
    numbers: Vec<u32>,
    /// Mean absolute error against the picture; none for scenes that were not found in one.
    mae: Option<f32>,
    time: Option<Duration>,
}

/// Where a scene comes from.
#[derive(Default)]
pub(crate) struct Origin {
    pub(crate) bank: Option<Arc<Bank<f32>>>,
    /// The labels of a label map, one per object.
    pub(crate) labels: Option<Vec<u32>>,
    /// Processor time of the fit.
    pub(crate) time: Option<Duration>,
}

impl Scene {
    /// What a fit found in a picture.
    pub(crate) fn of_fit(fit: &Fit<f32>, picture: &Picture<f32>, origin: Origin) -> Result<Self, FormatError> {
        let json = SceneJson::from_fit(fit, picture)?;
        let scene = fit.scene.clone();
        let numbers = origin.labels.unwrap_or_else(|| (1..).take(scene.objects.len()).collect());
        Ok(Self {
            json,
            size: picture.image.size(),
            covariance: fit.covariance.clone(),
            bank: origin.bank,
            numbers,
            mae: Some(fit.loss),
            time: origin.time,
            scene,
        })
    }

    /// The scene of a text's structure.
    pub(crate) fn of_json(json: SceneJson, bank: Option<Arc<Bank<f32>>>, place: &Place) -> Result<Self, FormatError> {
        let scene = json.to_scene(bank.as_deref(), place)?;
        let field = || FormatError::Field {
            place: place.clone(),
            field: "width".to_owned(),
            problem: "is missing: scenes of data sets take the size of their image; add width and height".to_owned(),
        };
        let size = json.size(place)?.ok_or_else(field)?;
        let numbers = (1..).take(scene.objects.len()).collect();
        Ok(Self { scene, json, size, covariance: Vec::new(), bank, numbers, mae: None, time: None })
    }

    /// A picture of the size of this scene.
    fn image(&self, source: &Source) -> Result<Image<f32>, InputError> {
        let image = source.picture(self.size.pixels(), false)?.image;
        if image.size() == self.size {
            Ok(image)
        } else {
            Err(InputError::Size { found: image.size(), scene: self.size })
        }
    }

    pub(crate) fn core(&self) -> &dvp_core::Scene<f32> {
        &self.scene
    }

    pub(crate) fn image_size(&self) -> ImageSize {
        self.size
    }

    /// The measures of the objects, as of a picture with these names.
    pub(crate) fn measured(&self, picture: String, stem: String) -> Result<MeasuredPicture, ExportError> {
        let objects = measure(&self.scene, &self.covariance, self.bank.as_deref(), &self.numbers, self.size)?;
        Ok(MeasuredPicture::new(picture, stem, Ok(Found { size: self.size, objects })))
    }
}

/// Refuses images that would take more memory than a process has.
pub(crate) fn paintable(width: usize, height: usize) -> PyResult<ImageSize> {
    let size = ImageSize::new(width, height).ok().filter(|size| size.pixels() <= MOST_PIXELS);
    size.ok_or_else(|| refusal(format!("an image of {width} x {height} pixels, must be 1 to {MOST_PIXELS}")))
}

#[pymethods]
impl Scene {
    /// The scene of a JSON text of any version.
    #[staticmethod]
    #[pyo3(signature = (text, bank_text, covariance=None, numbers=None, mae=None, seconds=None))]
    fn from_json(
        py: Python<'_>,
        text: &str,
        bank_text: &str,
        covariance: Option<PyReadonlyArray2<'_, f32>>,
        numbers: Option<Vec<u32>>,
        mae: Option<f32>,
        seconds: Option<f64>,
    ) -> PyResult<Self> {
        let place = Place::file(Path::new(TEXT));
        let mut scene = unlocked(py, || {
            let bank = input::bank(bank_text)?.map(Arc::new);
            Self::of_json(SceneJson::parse(text.as_bytes(), &place)?, bank, &place)
        })?;
        let count = scene.scene.objects.len();
        if let Some(numbers) = numbers {
            if numbers.len() != count {
                return Err(refusal(format!("{} numbers for {count} objects", numbers.len())));
            }
            scene.numbers = numbers;
        }
        if let Some(covariance) = covariance {
            let values: Vec<f32> = covariance.as_array().iter().copied().collect();
            scene.covariance = values.as_chunks().0.to_vec();
        }
        scene.mae = mae;
        scene.time = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        Ok(scene)
    }

    #[getter]
    fn width(&self) -> usize {
        self.size.width()
    }

    #[getter]
    fn height(&self) -> usize {
        self.size.height()
    }

    #[getter]
    fn mae(&self) -> Option<f32> {
        self.mae
    }

    #[getter]
    fn seconds(&self) -> Option<f64> {
        self.time.map(|time| time.as_secs_f64())
    }

    #[getter]
    fn numbers(&self) -> Vec<u32> {
        self.numbers.clone()
    }

    #[getter]
    fn bank(&self) -> String {
        self.bank.as_ref().map_or_else(|| "none".to_owned(), |bank| bank_to_json(bank))
    }

    /// Per object, row by row: covariance of (x, y, log scale, rotation, log stretch); no row where the fit tells nothing.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.covariance.as_flattened().to_vec().into_pyarray(py).reshape([self.covariance.len(), 25])
    }

    /// One line of JSON, as in STEM.json.
    fn to_json(&self) -> PyResult<String> {
        self.json.to_line(&Place::file(Path::new(TEXT))).map_err(|error| exception(&error))
    }

    fn to_svg(&self, py: Python<'_>) -> PyResult<String> {
        unlocked(py, || to_svg_numbered(&self.scene, self.size, self.bank.as_deref(), &self.numbers))
    }

    /// Pixels of `size` (width, height): height x width x 3, or 4 with straight colors.
    fn render<'py>(&self, py: Python<'py>, size: [usize; 2], rgba: bool) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let [width, height] = size;
        let size = paintable(width, height)?;
        let values = unlocked(py, || {
            let painter = Painter::default();
            if rgba {
                painter.paint_rgba(&self.scene, size).map(|image| image.to_straight())
            } else {
                painter.paint(&self.scene, size).map(|image| image.to_interleaved())
            }
        })?;
        values.into_pyarray(py).reshape([height, width, if rgba { 4 } else { 3 }])
    }

    /// Of the scene, or of the picture that it was read from.
    fn labels<'py>(&self, py: Python<'py>, picture: Option<PySource<'py>>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let size = paintable(self.size.width(), self.size.height())?;
        let labels = match picture.map(|picture| picture.to_owned()) {
            None => unlocked(py, || label_map(&self.scene, &self.numbers, size))?,
            Some(source) => {
                let image = unlocked(py, || self.image(&source))?;
                let noise = self.json.known.as_ref().and_then(|known| known.noise).unwrap_or(f64::NAN);
                unlocked(py, || label_map_in(&self.scene, &self.numbers, image.view(), f32::of(noise)))?
            }
        };
        labels.into_pyarray(py).reshape([size.height(), size.width()])
    }

    fn whole<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let size = paintable(self.size.width(), self.size.height())?;
        let values = unlocked(py, || whole_coverage(&self.scene, size))?;
        values.into_pyarray(py).reshape([self.scene.objects.len(), size.height(), size.width()])
    }

    /// Objects x harmonics x 4; NaN for objects that enclose nothing.
    fn efd<'py>(&self, py: Python<'py>, harmonics: usize, normalize: bool) -> PyResult<Bound<'py, PyArray3<f64>>> {
        paintable(self.size.width(), self.size.height())?;
        let values = unlocked(py, || {
            let measured = self.measured(String::new(), String::new())?;
            let rows = measured.objects().iter().flat_map(|object| {
                let ring = object.region.largest_ring().unwrap_or(&[]);
                let efd = if normalize {
                    normal_efd(ring, harmonics)
                } else {
                    Efd::from_contour(ring, harmonics).map(|(efd, _)| efd)
                };
                efd.map_or_else(|_| vec![[f64::NAN; 4]; harmonics], |efd| efd.rows().to_vec())
            });
            Ok::<_, ExportError>(rows.collect::<Vec<_>>().into_flattened())
        })?;
        values.into_pyarray(py).reshape([self.scene.objects.len(), harmonics, 4])
    }

    /// The rings of every object, px: arrays of corners, those of holes after the ring around them.
    fn rings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Vec<Bound<'py, PyArray2<f64>>>>> {
        paintable(self.size.width(), self.size.height())?;
        let measured = unlocked(py, || self.measured(String::new(), String::new()))?;
        let ring = |ring: &[[f64; 2]]| -> PyResult<Bound<'py, PyArray2<f64>>> {
            PyArray1::from_slice(py, ring.as_flattened()).reshape([ring.len(), 2])
        };
        measured.objects().iter().map(|object| object.region.rings().map(ring).collect()).collect()
    }
}
