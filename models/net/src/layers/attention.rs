//! Attention of several heads.

use dvp_core::tensor::{Backend, Tensor, TensorError};

/// For each query the mean of `values`, weighted by the softmax of the query's products with the `keys` over the root
/// of a head's width; each of `heads` equal parts of the last axis for itself.
///
/// *Dimensions*: queries batch x n x width, keys batch x m x width, values batch x m x any width: batch x n x the width
/// of the values. A batch of 1 stretches.
///
/// *Source*: Vaswani et al.: Attention Is All You Need (2017), without the linear maps before and after.
///
/// # Errors
/// [`TensorError::Operand`] if a rank is not 3 or the heads do not divide a width; as [`Tensor::matmul`].
pub fn attend<B: Backend>(
    queries: &Tensor<B>,
    keys: &Tensor<B>,
    values: &Tensor<B>,
    heads: usize,
) -> Result<Tensor<B>, TensorError> {
    let [q, k, v] = [split_heads(queries, heads)?, split_heads(keys, heads)?, split_heads(values, heads)?];
    let width = q.dims().get(3).unwrap_or(1).max(1);
    let scores = q.affine((width as f64).sqrt().recip(), 0.0)?.matmul(&k.transpose()?)?;
    let mixed = scores.softmax(3)?.matmul(&v)?.permute(&[0, 2, 1, 3])?;
    match *mixed.dims().extents() {
        [batch, n, heads, width] => mixed.reshape(&[batch, n, heads * width]),
        _ => Ok(mixed),
    }
}

/// batch x n x 2 width: in each of `heads` equal parts of the last axis the part of `a`, then that of `b`.
///
/// # Errors
/// As [`attend`]; as [`Tensor::concat`].
pub(crate) fn join_heads<B: Backend>(a: &Tensor<B>, b: &Tensor<B>, heads: usize) -> Result<Tensor<B>, TensorError> {
    let &[batch_a, n, width] = a.dims().extents() else { return Err(not_tokens(a)) };
    let &[batch_b, ..] = b.dims().extents() else { return Err(not_tokens(b)) };
    let batch = batch_a.max(batch_b);
    let parts = |tensor: &Tensor<B>| {
        let part = head_width(tensor, heads)?;
        tensor.expand(&[batch, n, width])?.reshape(&[batch, n, heads, part])
    };
    Tensor::concat(&[&parts(a)?, &parts(b)?], 3)?.reshape(&[batch, n, 2 * width])
}

/// batch x heads x n x width of a head.
fn split_heads<B: Backend>(tensor: &Tensor<B>, heads: usize) -> Result<Tensor<B>, TensorError> {
    let &[batch, n, _] = tensor.dims().extents() else { return Err(not_tokens(tensor)) };
    tensor.reshape(&[batch, n, heads, head_width(tensor, heads)?])?.permute(&[0, 2, 1, 3])
}

fn head_width<B: Backend>(tensor: &Tensor<B>, heads: usize) -> Result<usize, TensorError> {
    match *tensor.dims().extents() {
        [_, _, width] if heads > 0 && width > 0 && width.is_multiple_of(heads) => Ok(width / heads),
        _ => {
            let must = "the heads must divide the last extent";
            Err(TensorError::Operand { op: "attend", dims: *tensor.dims(), must })
        }
    }
}

fn not_tokens<B: Backend>(tensor: &Tensor<B>) -> TensorError {
    TensorError::Operand { op: "attend", dims: *tensor.dims(), must: "must be batch x tokens x width" }
}
