//! Outlines to coverage: the closest of all edges, inside by parity.

use alloc::vec::Vec;

use super::{DenseRenderer, Rows};
use crate::scene::EdgeLaw;
use crate::tensor::{Backend, Tensor, TensorError, Unary};

/// Squared length (scene units) below which an edge is none.
const SHORTEST_SQUARED: f64 = 1e-24;
/// Squared distance (scene units) of edges that are none.
const FAR: f64 = 1e6;
/// Added to squared distances before a root: its derivative stays finite on the outline.
const ROOT_GUARD: f64 = 1e-30;

/// Edges of outlines, each batch objects x 1 x edges: to be held against pixels, 1 x pixels x 1.
struct Edges<B: Backend> {
    start: [Tensor<B>; 2],
    along: [Tensor<B>; 2],
}

impl DenseRenderer {
    /// Coverage of the pixels of some rows, batch x objects x pixels, from outlines, batch x objects x vertices x 2.
    pub(super) fn cover<B: Backend>(&self, outlines: &Tensor<B>, rows: &Rows) -> Result<Tensor<B>, TensorError> {
        let &[batch, objects, vertices, _] = outlines.dims().extents() else {
            return Err(TensorError::Operand { op: "cover", dims: *outlines.dims(), must: "must have four axes" });
        };
        let edges = Edges::of(&outlines.reshape(&[batch * objects, vertices, 2])?, &self.breaks)?;
        let pixels = self.centers(outlines, rows)?;
        let squared = edges.squared_distance(&pixels)?;
        let side = edges.detached()?.side(&pixels)?;
        // The profile is in the doubled frame: lengths are twice those in scene units.
        let measure = match self.edge.law {
            EdgeLaw::SquaredDistance => squared.affine(4.0, 0.0)?,
            _ => squared.affine(4.0, ROOT_GUARD)?.sqrt()?,
        };
        let measure = measure.mul(&side)?;
        let sharpness = self.edge.sigma.recip();
        let coverage = measure.affine(-sharpness, self.edge.offset * sharpness)?.sigmoid()?;
        let beyond = measure.greater(&measure.like([self.edge.cut].to_vec(), &[1, 1, 1])?)?;
        let pixels = (rows.end - rows.first) * self.size.width();
        coverage.mul(&beyond.affine(-1.0, 1.0)?)?.reshape(&[batch, objects, pixels])
    }

    /// Centers of the pixels of some rows, scene units: x and y, each 1 x pixels x 1.
    fn centers<B: Backend>(&self, like: &Tensor<B>, rows: &Rows) -> Result<[Tensor<B>; 2], TensorError> {
        #[expect(clippy::cast_precision_loss, reason = "pixel indices are far below 2^52")]
        let center = |index: usize| (index as f64 + 0.5) / self.size.unit_px() as f64;
        let grid = || (rows.first..rows.end).flat_map(|y| (0..self.size.width()).map(move |x| (x, y)));
        let (xs, ys): (Vec<f64>, Vec<f64>) = grid().map(|(x, y)| (center(x), center(y))).unzip();
        let extents = [1, xs.len(), 1];
        Ok([like.like(xs, &extents)?, like.like(ys, &extents)?])
    }
}

impl<B: Backend> Edges<B> {
    /// Edges of outlines, outlines x vertices x 2, whose rings begin at 0 and at `breaks` and are closed.
    fn of(outlines: &Tensor<B>, breaks: &[usize]) -> Result<Self, TensorError> {
        let (outline_count, vertices) = match outlines.dims().extents() {
            &[outline_count, vertices, _] if vertices > 0 => (outline_count, vertices),
            _ => return Err(TensorError::Operand { op: "cover", dims: *outlines.dims(), must: "must have vertices" }),
        };
        let mut next = Vec::new();
        let mut first = 0;
        for &end in breaks.iter().chain([&vertices]) {
            if end < first || end > vertices {
                let must = "must have rings that begin one after the other inside of its outlines";
                return Err(TensorError::Operand { op: "cover", dims: *outlines.dims(), must });
            }
            if end > first {
                next.push(outlines.slice(1, first + 1, end - first - 1)?);
                next.push(outlines.slice(1, first, 1)?);
            }
            first = end;
        }
        let next = Tensor::concat(&next.iter().collect::<Vec<_>>(), 1)?;
        let along = next.sub(outlines)?;
        let component = |of: &Tensor<B>, axis| of.slice(2, axis, 1)?.reshape(&[outline_count, 1, vertices]);
        Ok(Self {
            start: [component(outlines, 0)?, component(outlines, 1)?],
            along: [component(&along, 0)?, component(&along, 1)?],
        })
    }

    fn detached(&self) -> Result<Self, TensorError> {
        let Self { start: [x, y], along: [dx, dy] } = self;
        Ok(Self { start: [x.detach()?, y.detach()?], along: [dx.detach()?, dy.detach()?] })
    }

    /// Squared distances of pixels to the closest edge, outlines x pixels x 1.
    fn squared_distance(&self, [px, py]: &[Tensor<B>; 2]) -> Result<Tensor<B>, TensorError> {
        let [dx, dy] = &self.along;
        let length = dx.mul(dx)?.add(&dy.mul(dy)?)?;
        let is_edge = length.greater(&length.like([SHORTEST_SQUARED].to_vec(), &[1, 1, 1])?)?;
        let missing = is_edge.affine(-1.0, 1.0)?;
        let (from_x, from_y) = (px.sub(&self.start[0])?, py.sub(&self.start[1])?);
        let foot = from_x.mul(dx)?.add(&from_y.mul(dy)?)?.div(&length.add(&missing)?)?;
        // Clamped to [0, 1].
        let foot = foot.relu()?.sub(&foot.affine(1.0, -1.0)?.relu()?)?;
        let (off_x, off_y) = (from_x.sub(&foot.mul(dx)?)?, from_y.sub(&foot.mul(dy)?)?);
        let squared = off_x.mul(&off_x)?.add(&off_y.mul(&off_y)?)?.add(&missing.affine(FAR, 0.0)?)?;
        squared.affine(-1.0, 0.0)?.max(2)?.affine(-1.0, 0.0)
    }

    /// -1 inside, 1 outside: a ray to the left meets an odd number of edges inside. Outlines x pixels x 1.
    fn side(&self, [px, py]: &[Tensor<B>; 2]) -> Result<Tensor<B>, TensorError> {
        let ([x, y], [dx, dy]) = (&self.start, &self.along);
        let (starts_below, ends_below) = (y.greater(py)?, y.add(dy)?.greater(py)?);
        let crosses = starts_below.sub(&ends_below)?.abs()?;
        // Edges along the rows cross none: any slope will do, if it is finite.
        let zero = dy.like([0.0].to_vec(), &[1, 1, 1])?;
        let level = dy.abs()?.greater(&zero)?.affine(-1.0, 1.0)?;
        let meets = py.sub(y)?.mul(&dx.div(&dy.add(&level)?)?)?.add(x)?;
        let crossings = crosses.mul(&px.greater(&meets)?)?.sum(2)?;
        crossings.affine(core::f64::consts::PI, 0.0)?.unary(Unary::Cos)
    }
}
