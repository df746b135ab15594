//! Elliptic Fourier descriptors of contours.

use dvp::export::normal_efd;
use dvp_core::Efd;
use dvp_core::shape::ShapeError;
use numpy::{IntoPyArray as _, PyArray1, PyArray2, PyArrayMethods as _, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::border::unlocked;

/// Descriptors, and the center.
type Described<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// The descriptors of a closed contour (points x 2), harmonics x 4, and its center (2), which normalizing takes out.
#[pyfunction]
pub(crate) fn efd<'py>(
    py: Python<'py>,
    contour: PyReadonlyArray2<'py, f64>,
    harmonics: usize,
    normalize: bool,
) -> PyResult<Described<'py>> {
    let values: Vec<f64> = contour.as_array().iter().copied().collect();
    let (rows, center) = unlocked(py, || {
        let points = values.as_chunks().0;
        let (efd, center) = Efd::from_contour(points, harmonics)?;
        let efd = if normalize { normal_efd(points, harmonics)? } else { efd };
        Ok::<_, ShapeError>((efd.rows().as_flattened().to_vec(), center.to_vec()))
    })?;
    Ok((rows.into_pyarray(py).reshape([harmonics, 4])?, center.into_pyarray(py)))
}
