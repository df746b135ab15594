//! Measures of many scenes by columns, as `dvp fit --table` writes them.

use dvp::export::{ColumnValues, ExportError, MeasuredPicture, Scale, TableColumn, table_columns};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::border::{refusal, unlocked};
use crate::scene::{Scene, paintable};

/// A scene, or why there is none.
#[derive(FromPyObject)]
pub(crate) enum Outcome<'py> {
    Scene(PyRef<'py, Scene>),
    Error(String),
}

/// The columns of the table: name, kind (`text`, `count`, `number`) and the values of the rows. `names`: picture and stem of each scene.
#[pyfunction]
pub(crate) fn columns<'py>(
    py: Python<'py>,
    outcomes: Vec<Outcome<'py>>,
    names: Vec<(String, String)>,
    mm_per_px: Option<f64>,
) -> PyResult<Vec<(String, &'static str, Bound<'py, PyList>)>> {
    if outcomes.len() != names.len() {
        return Err(refusal(format!("{} names for {} scenes", names.len(), outcomes.len())));
    }
    if let Some(scale) = mm_per_px
        && !(scale > 0.0 && scale.is_finite())
    {
        return Err(refusal(format!("a pixel of {scale} mm: must be a number above 0")));
    }
    let mut pictures = Vec::with_capacity(outcomes.len());
    for (outcome, (picture, stem)) in outcomes.iter().zip(names) {
        pictures.push(match outcome {
            Outcome::Error(error) => MeasuredPicture::new(picture, stem, Err(error.clone())),
            Outcome::Scene(scene) => {
                let scene: &Scene = scene;
                paintable(scene.image_size().width(), scene.image_size().height())?;
                unlocked(py, || scene.measured(picture, stem))?
            }
        });
    }
    let scale = mm_per_px.map(|mm_per_px| Scale { mm_per_px });
    let columns = unlocked(py, || Ok::<_, ExportError>(table_columns(&pictures, scale)))?;
    let list = |TableColumn { name, values }: TableColumn| {
        Ok(match values {
            ColumnValues::Text(values) => (name, "text", PyList::new(py, values)?),
            ColumnValues::Count(values) => (name, "count", PyList::new(py, values)?),
            ColumnValues::Number(values) => (name, "number", PyList::new(py, values)?),
        })
    };
    columns.into_iter().map(list).collect()
}
