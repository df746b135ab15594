//! The step of scenes for Python, in either precision.

use dvp_core::Real;
use dvp_core::render::{Compositing, ContourRenderer, EdgeLaw, EdgeProfile, PixelLoss};
use numpy::{Element, IntoPyArray as _, PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use crate::border::{exception, refusal, unlocked};
use crate::scene::paintable;
use crate::step::{Shapes, Step};

/// Most numbers of a scene.
const MOST_NUMBERS: usize = 1 << 24;

/// Scenes of one layout to images or losses, of numbers of 32 or of 64 bits.
#[pyclass(frozen, module = "dvp._dvp")]
pub(crate) struct SceneStep {
    precision: Precision,
}

enum Precision {
    Single(Step<f32>),
    Double(Step<f64>),
}

/// What a batch of numbers is handed over as: flat, in C order.
#[derive(FromPyObject)]
pub(crate) enum Numbers<'py> {
    Single(PyReadonlyArray1<'py, f32>),
    Double(PyReadonlyArray1<'py, f64>),
}

/// What images are painted into: flat, in C order. The caller's memory, which a loop can use again and again.
#[derive(FromPyObject)]
pub(crate) enum Images<'py> {
    Single(PyReadwriteArray1<'py, f32>),
    Double(PyReadwriteArray1<'py, f64>),
}

/// Flat arrays of either precision.
type Arrays<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

#[pymethods]
impl SceneStep {
    /// `extents` (width, height, objects); `rings` vertices per ring, or else `harmonics` rows of descriptors drawn with `vertices`
    /// vertices; `edge` is `reference`, `area`, or `blur` of `sigma_px`.
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the Python half names and documents each of them")]
    fn new(
        extents: [usize; 3],
        rings: Option<Vec<usize>>,
        harmonics: usize,
        vertices: usize,
        edge: &str,
        sigma_px: f64,
        compositing: &str,
        rgba: bool,
        double: bool,
    ) -> PyResult<Self> {
        let [width, height, objects] = extents;
        let size = paintable(width, height)?;
        let shapes = match rings {
            Some(lengths) => {
                if let Some(short) = lengths.iter().find(|&&length| length < 3) {
                    return Err(refusal(format!("a ring of {short} vertices, needs at least 3")));
                }
                Shapes::Rings(lengths)
            }
            None => Shapes::Efd(harmonics),
        };
        let per_object = [harmonics, vertices].iter().copied().chain([shapes.numbers()]).max().unwrap_or(0);
        if objects.saturating_mul(per_object) > MOST_NUMBERS {
            return Err(refusal(format!(
                "{objects} objects of {per_object} numbers: must be {MOST_NUMBERS} at most in all"
            )));
        }
        let compositing = match compositing {
            "over" => Compositing::Over,
            "blend" => Compositing::Blend,
            other => return Err(refusal(format!("compositing {other:?}: must be over or blend"))),
        };
        // Lengths of profiles are those of the doubled frame, where the shorter side is 2.
        let blur = EdgeProfile::distance(2.0 * sigma_px / f64::of_usize(size.unit_px()));
        let profile = match edge {
            "reference" => EdgeProfile::<f64>::reference(),
            "area" => EdgeProfile::area(),
            "blur" if sigma_px > 0.0 && sigma_px.is_finite() => blur,
            "blur" => return Err(refusal(format!("edge {sigma_px}: a softness must be above 0 px"))),
            other => return Err(refusal(format!("edge {other:?}: must be reference, area or a number of pixels"))),
        };
        let precision = if double {
            let renderer = ContourRenderer::new(profile, compositing);
            Step::new(size, objects, shapes, vertices, renderer, rgba).map(Precision::Double)
        } else {
            let law: EdgeLaw = profile.law;
            let [offset, sigma, cut] = [profile.offset, profile.sigma, profile.cut].map(f32::of);
            let renderer = ContourRenderer::new(EdgeProfile { law, offset, sigma, cut }, compositing);
            Step::new(size, objects, shapes, vertices, renderer, rgba).map(Precision::Single)
        };
        Ok(Self { precision: precision.map_err(|error| exception(&error))? })
    }

    /// Numbers per scene.
    #[getter]
    fn width(&self) -> usize {
        match &self.precision {
            Precision::Single(step) => step.width(),
            Precision::Double(step) => step.width(),
        }
    }

    /// Paints into `images`: batch x channels x height x width, flat.
    fn render<'py>(&self, py: Python<'py>, input: Numbers<'py>, images: Images<'py>) -> PyResult<()> {
        match (&self.precision, input, images) {
            (Precision::Single(step), Numbers::Single(input), Images::Single(images)) => {
                render(py, step, &input, images)
            }
            (Precision::Double(step), Numbers::Double(input), Images::Double(images)) => {
                render(py, step, &input, images)
            }
            _ => Err(other_precision()),
        }
    }

    /// The gradient of the numbers, given that of the images.
    fn render_vjp<'py>(&self, py: Python<'py>, input: Numbers<'py>, grad: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        match (&self.precision, input, grad) {
            (Precision::Single(step), Numbers::Single(input), Numbers::Single(grad)) => {
                render_vjp(py, step, &input, &grad)
            }
            (Precision::Double(step), Numbers::Double(input), Numbers::Double(grad)) => {
                render_vjp(py, step, &input, &grad)
            }
            _ => Err(other_precision()),
        }
    }

    /// A loss per scene (`mae`, `mse`), and the gradient of the numbers, empty unless `backward`.
    fn loss<'py>(
        &self,
        py: Python<'py>,
        input: Numbers<'py>,
        targets: Numbers<'py>,
        kind: &str,
        backward: bool,
    ) -> PyResult<Arrays<'py>> {
        let kind = match kind {
            "mae" => PixelLoss::Mae,
            "mse" => PixelLoss::Mse,
            other => return Err(refusal(format!("kind {other:?}: must be mae or mse"))),
        };
        match (&self.precision, input, targets) {
            (Precision::Single(step), Numbers::Single(input), Numbers::Single(targets)) => {
                loss(py, step, &input, &targets, kind, backward)
            }
            (Precision::Double(step), Numbers::Double(input), Numbers::Double(targets)) => {
                loss(py, step, &input, &targets, kind, backward)
            }
            _ => Err(other_precision()),
        }
    }
}

fn other_precision() -> PyErr {
    refusal("numbers of another precision than the step: all must be float32, or all float64")
}

/// Refuses arrays that are not a whole number of items of `width`, or not `batch` of them; returns how many there are.
fn items(what: &str, len: usize, width: usize, batch: Option<usize>) -> PyResult<usize> {
    let count = len / width.max(1);
    if len.is_multiple_of(width.max(1)) && batch.is_none_or(|batch| batch == count) {
        return Ok(count);
    }
    let wanted = batch.map_or_else(|| "a multiple".to_owned(), |batch| format!("{batch} times as many"));
    Err(refusal(format!("{what}: {len} values, must be {wanted} of {width}")))
}

fn contiguous<'a, T: Element>(array: &'a PyReadonlyArray1<'_, T>) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|_| refusal("numbers must lie one after the other: numpy.ascontiguousarray makes them so"))
}

fn render<'py, T: Real + Element>(
    py: Python<'py>,
    step: &Step<T>,
    input: &PyReadonlyArray1<'py, T>,
    mut images: PyReadwriteArray1<'py, T>,
) -> PyResult<()> {
    let input = contiguous(input)?;
    let batch = items("numbers", input.len(), step.width(), None)?;
    let images = images.as_slice_mut().map_err(|_| refusal("images must lie one after the other"))?;
    items("images", images.len(), step.image_len(), Some(batch))?;
    unlocked(py, || step.render(input, images))
}

fn render_vjp<'py, T: Real + Element>(
    py: Python<'py>,
    step: &Step<T>,
    input: &PyReadonlyArray1<'py, T>,
    grad: &PyReadonlyArray1<'py, T>,
) -> PyResult<Bound<'py, PyAny>> {
    let (input, grad) = (contiguous(input)?, contiguous(grad)?);
    let batch = items("numbers", input.len(), step.width(), None)?;
    items("gradient of the images", grad.len(), step.image_len(), Some(batch))?;
    Ok(unlocked(py, || step.render_vjp(input, grad))?.into_pyarray(py).into_any())
}

fn loss<'py, T: Real + Element>(
    py: Python<'py>,
    step: &Step<T>,
    input: &PyReadonlyArray1<'py, T>,
    targets: &PyReadonlyArray1<'py, T>,
    kind: PixelLoss,
    backward: bool,
) -> PyResult<Arrays<'py>> {
    let (input, targets) = (contiguous(input)?, contiguous(targets)?);
    let batch = items("numbers", input.len(), step.width(), None)?;
    items("targets", targets.len(), step.image_len(), Some(batch))?;
    let (losses, grads) = unlocked(py, || step.loss(input, targets, kind, backward))?;
    Ok((losses.into_pyarray(py).into_any(), grads.into_pyarray(py).into_any()))
}
