//! The tape: what each array was made from, and the walk back from a number to its parameters.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;
use core::sync::atomic::{AtomicUsize, Ordering};

use super::array::{HostArray, by_types};
use crate::real::{Real, Values};
use crate::tensor::backend::BackendError;

/// A gradient for each parent of a node.
pub(super) type Pull = Result<Vec<Values>, BackendError>;

type PullFn = dyn Fn(&Values) -> Pull + Send + Sync;

/// One step of a computation. Parents have smaller numbers.
pub(super) struct Node {
    number: usize,
    parents: Vec<Option<Arc<Node>>>,
    /// None for parameters.
    pull: Option<Box<PullFn>>,
}

impl fmt::Debug for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Node({})", self.number)
    }
}

impl Node {
    pub(super) fn leaf() -> Arc<Self> {
        Arc::new(Self { number: next_number(), parents: Vec::new(), pull: None })
    }

    pub(super) fn step(
        parents: Vec<Option<Arc<Self>>>,
        pull: impl Fn(&Values) -> Pull + Send + Sync + 'static,
    ) -> Arc<Self> {
        Arc::new(Self { number: next_number(), parents, pull: Some(Box::new(pull)) })
    }
}

impl Drop for Node {
    /// Long graphs are taken apart in a loop: dropped parent by parent they would exhaust the stack.
    fn drop(&mut self) {
        let mut open = core::mem::take(&mut self.parents);
        while let Some(parent) = open.pop() {
            if let Some(mut node) = parent.and_then(Arc::into_inner) {
                open.append(&mut node.parents);
            }
        }
    }
}

fn next_number() -> usize {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    COUNT.fetch_add(1, Ordering::Relaxed)
}

/// Gradients of parameters of the [`Host`](super::Host).
#[derive(Debug, Default)]
pub struct HostGradients {
    by_node: BTreeMap<usize, Values>,
}

impl HostGradients {
    pub(super) fn of(&self, parameter: &HostArray) -> Option<HostArray> {
        let values = self.by_node.get(&parameter.node()?.number)?;
        Some(HostArray::constant(values.clone(), parameter.dims()))
    }
}

/// Walks from the last node to the first: when a node's turn comes all gradients that flow into it have arrived.
pub(super) fn backward(number: &HostArray) -> Result<HostGradients, BackendError> {
    let mut found = HostGradients::default();
    let mut open = BTreeMap::new();
    if let Some(node) = number.node() {
        let one = match number.values() {
            Values::F32(_) => Values::F32(alloc::vec![1.0]),
            Values::F64(_) => Values::F64(alloc::vec![1.0]),
        };
        open.insert(node.number, (Arc::clone(node), one));
    }
    while let Some((number, (node, grad))) = open.pop_last() {
        let Some(pull) = &node.pull else {
            found.by_node.insert(number, grad);
            continue;
        };
        for (parent, grad) in node.parents.iter().zip(pull(&grad)?) {
            let Some(parent) = parent else { continue };
            match open.get_mut(&parent.number) {
                Some((_, sum)) => {
                    let added = by_types!(&*sum, &grad, (a, b) => added(a, b));
                    *sum = added;
                }
                None => {
                    open.insert(parent.number, (Arc::clone(parent), grad));
                }
            }
        }
    }
    Ok(found)
}

fn added<T: Real>(a: &[T], b: &[T]) -> Vec<T> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}
