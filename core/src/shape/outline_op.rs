//! Unit outlines of any shape model, as one differentiable step of a batch.

use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::{Dims, DimsError};
use crate::real::Real;

use super::{PrototypeBank, ShapeError, ShapeModel};

/// Parameters of `objects` shapes to their unit outlines: objects x parameters, objects x vertices x 2.
///
/// With [`EfdModel`](super::EfdModel) the parameters are descriptors, with [`PrototypeModel`](super::PrototypeModel)
/// weights of a bank.
///
/// *Derivative*: that of the model.
#[derive(Clone, Debug)]
pub struct OutlineOp<M> {
    model: M,
    signature: Signature,
}

impl<M> OutlineOp<M> {
    /// Outlines of `objects` shapes of `model` per item.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new<T: Real>(model: M, objects: usize) -> Result<Self, DimsError>
    where
        M: ShapeModel<T>,
    {
        let parameters = OpInput::new("parameters", &[objects, model.parameter_count()])?;
        let outlines = Dims::new(&[objects, model.vertex_count(), 2])?;
        Ok(Self { model, signature: Signature::new("outline", [parameters], outlines) })
    }
}

impl<T: Real, M: ShapeModel<T> + core::fmt::Debug + Send + Sync> DiffOp<T> for OutlineOp<M> {
    type Scratch = ();
    type Error = ShapeError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), ShapeError> {
        let outlines = output.as_chunks_mut().0.chunks_exact_mut(self.model.vertex_count().max(1));
        for (parameters, outline) in input.chunks_exact(self.model.parameter_count().max(1)).zip(outlines) {
            self.model.outline(parameters, outline)?;
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), ShapeError> {
        let count = self.model.parameter_count().max(1);
        let outlines = grad_output.as_chunks().0.chunks_exact(self.model.vertex_count().max(1));
        for ((parameters, grad), outline) in
            input.chunks_exact(count).zip(grad_input.chunks_exact_mut(count)).zip(outlines)
        {
            self.model.outline_vjp(parameters, outline, grad)?;
        }
        Ok(())
    }
}

/// Weights of a bank's prototypes to mixed descriptors: objects x prototypes, objects x harmonics x 4.
///
/// *Derivative*: the mixture is linear, [`PrototypeBank::mix_vjp`].
#[derive(Clone, Debug)]
pub struct MixOp<T> {
    bank: PrototypeBank<T>,
    signature: Signature,
}

impl<T: Real> MixOp<T> {
    /// Mixtures of `bank` for `objects` shapes per item.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(bank: PrototypeBank<T>, objects: usize) -> Result<Self, DimsError> {
        let weights = OpInput::new("weights", &[objects, bank.prototypes().len()])?;
        let mixtures = Dims::new(&[objects, bank.harmonic_count(), 4])?;
        Ok(Self { bank, signature: Signature::new("prototype mixture", [weights], mixtures) })
    }
}

impl<T: Real> DiffOp<T> for MixOp<T> {
    type Scratch = ();
    type Error = ShapeError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), ShapeError> {
        let mixtures = output.as_chunks_mut().0.chunks_exact_mut(self.bank.harmonic_count().max(1));
        for (weights, rows) in input.chunks_exact(self.bank.prototypes().len().max(1)).zip(mixtures) {
            self.bank.mix(weights, rows)?;
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        _: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), ShapeError> {
        let mixtures = grad_output.as_chunks().0.chunks_exact(self.bank.harmonic_count().max(1));
        for (grad, rows) in grad_input.chunks_exact_mut(self.bank.prototypes().len().max(1)).zip(mixtures) {
            self.bank.mix_vjp(rows, grad)?;
        }
        Ok(())
    }
}
