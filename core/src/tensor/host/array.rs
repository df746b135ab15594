//! Shared values with their extents, and the node of the tape that made them.

use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

use super::tape::{Node, Pull};
use crate::dims::Dims;
use crate::real::Values;

/// An array of the [`Host`](super::Host).
#[derive(Clone, Debug)]
pub struct HostArray {
    values: Arc<Values>,
    dims: Dims,
    node: Option<Arc<Node>>,
}

impl HostArray {
    pub(super) fn constant(values: Values, dims: Dims) -> Self {
        Self { values: Arc::new(values), dims, node: None }
    }

    /// A result of `parents`: `pull` turns its gradient into one for each parent.
    pub(super) fn tracked(
        values: Values,
        dims: Dims,
        parents: &[&Self],
        pull: impl Fn(&Values) -> Pull + Send + Sync + 'static,
    ) -> Self {
        let nodes: Vec<Option<Arc<Node>>> = parents.iter().map(|parent| parent.node.clone()).collect();
        let node = nodes.iter().any(Option::is_some).then(|| Node::step(nodes, pull));
        Self { values: Arc::new(values), dims, node }
    }

    /// The same values with other extents.
    pub(super) fn viewed(&self, dims: Dims) -> Self {
        let node =
            self.node.as_ref().map(|node| Node::step(vec![Some(Arc::clone(node))], |grad| Ok(vec![grad.clone()])));
        Self { values: Arc::clone(&self.values), dims, node }
    }

    pub(super) fn as_parameter(&self) -> Self {
        Self { node: Some(Node::leaf()), ..self.clone() }
    }

    pub(super) fn as_constant(&self) -> Self {
        Self { node: None, ..self.clone() }
    }

    /// The values in row-major order.
    #[must_use]
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The extents.
    #[must_use]
    pub fn dims(&self) -> Dims {
        self.dims
    }

    /// Whether gradients are kept.
    #[must_use]
    pub fn is_tracked(&self) -> bool {
        self.node.is_some()
    }

    pub(super) fn node(&self) -> Option<&Arc<Node>> {
        self.node.as_ref()
    }
}

/// One expression for values of either type.
macro_rules! by_type {
    ($values:expr, $x:ident => $body:expr) => {
        match $values {
            crate::real::Values::F32($x) => crate::real::Values::F32($body),
            crate::real::Values::F64($x) => crate::real::Values::F64($body),
        }
    };
}

/// One expression for two arrays of the same type; of different types, which callers rule out, nothing.
macro_rules! by_types {
    ($a:expr, $b:expr, ($x:ident, $y:ident) => $body:expr) => {
        match ($a, $b) {
            (crate::real::Values::F32($x), crate::real::Values::F32($y)) => crate::real::Values::F32($body),
            (crate::real::Values::F64($x), crate::real::Values::F64($y)) => crate::real::Values::F64($body),
            (other, _) => crate::real::Values::zeros(other.dtype(), 0),
        }
    };
}

pub(super) use {by_type, by_types};
