//! What is refused: the same error on every backend, but for its name.

use core::fmt;

use dvp_core::diff_op::{Atan2, DiffOp, OpError, OpInput, Signature};
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Real};
use dvp_core::tensor::{BackendError, Host, Parameters, Stride, Tensor, TensorError};

use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// A number twice; refuses some: forward below -1, backward above 1.
#[derive(Clone, Debug)]
struct Picky {
    signature: Signature,
}

#[derive(Debug)]
struct Refused;

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("not this number")
    }
}

impl core::error::Error for Refused {}

impl Picky {
    fn new(batch: Option<usize>) -> Self {
        let number = OpInput::new("number", &[1]).unwrap();
        let signature = Signature::new("picky", [number], Dims::new(&[2]).unwrap());
        Self { signature: batch.map_or(signature.clone(), |items| signature.for_batch(items)) }
    }
}

impl<T: Real> DiffOp<T> for Picky {
    type Scratch = ();
    type Error = Refused;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Refused> {
        output.fill(input[0]);
        if input[0] < -T::one() { Err(Refused) } else { Ok(()) }
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), Refused> {
        grad_input[0] += grad_output[0] + grad_output[1];
        if input[0] > T::one() { Err(Refused) } else { Ok(()) }
    }
}

fn tensor<B: Tested>(extents: &[usize]) -> Result<Tensor<B>, TensorError> {
    Tensor::full(0.5, extents, DType::F64, &B::place())
}

/// Everything that must be refused.
fn refused<B: Tested>() -> Result<Vec<Result<Tensor<B>, TensorError>>, TensorError> {
    let (a, b, images) = (tensor::<B>(&[2, 3])?, tensor::<B>(&[4])?, tensor::<B>(&[1, 2, 5, 5])?);
    let (single, kernel) = (a.cast(DType::F32)?, tensor::<B>(&[1, 2, 3, 3])?);
    let (stride, no_step) = (Stride { step: 1, padding: 0 }, Stride { step: 0, padding: 0 });
    let pairs = tensor::<B>(&[2, 1])?;
    let negative = Tensor::<B>::new(vec![0.0, -2.0, -3.0], &[3, 1], &B::place())?;
    let double = |op| Tensor::apply::<f64, _>(Picky::new(op), &[&pairs]);
    Ok(vec![
        // Extents.
        a.add(&b),
        a.greater(&b),
        a.matmul(&a),
        b.matmul(&a),
        tensor::<B>(&[2, 2, 3])?.matmul(&tensor::<B>(&[3, 3, 2])?),
        a.reshape(&[5]),
        a.reshape(&[1, 1, 1, 1, 1, 2, 3]),
        a.expand(&[2, 4]),
        a.expand(&[3]),
        a.permute(&[0, 0]),
        b.transpose(),
        Tensor::concat(&[&a, &b], 0),
        Tensor::concat(&[], 0),
        images.conv2d(&a, stride),
        images.conv2d(&tensor::<B>(&[1, 3, 3, 3])?, stride),
        images.conv2d(&tensor::<B>(&[1, 2, 6, 3])?, stride),
        images.conv2d(&kernel, no_step),
        images.max_pool2d(6, stride),
        images.max_pool2d(2, Stride { step: 1, padding: 2 }),
        Tensor::new(vec![1.0, 2.0], &[3], &B::place()),
        tensor::<B>(&[])?.layer_norm(1e-5),
        // Axes and indices.
        a.sum(2),
        a.mean(2),
        a.max(2),
        a.softmax(2),
        Tensor::concat(&[&a], 2),
        a.slice(1, 2, 2),
        a.slice(2, 0, 1),
        a.slice(1, usize::MAX, 2),
        a.select(1, &[0, 3]),
        tensor::<B>(&[2, 0])?.max(1),
        tensor::<B>(&[2, 0])?.mean_all(),
        // Number types.
        a.add(&single),
        a.greater(&single),
        a.matmul(&single.transpose()?),
        Tensor::concat(&[&a, &single], 0),
        images.conv2d(&kernel.cast(DType::F32)?, stride),
        Tensor::apply::<f32, _>(Picky::new(None), &[&pairs]),
        Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[&a, &single]),
        // Steps: operands, batches, items. The second of three items is the first that is refused.
        Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[&a]),
        Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[]),
        Tensor::apply::<f64, _>(Atan2::new(&[2])?, &[&a, &a]),
        Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[&a, &tensor::<B>(&[1, 3])?]),
        double(Some(3)),
        Tensor::apply::<f64, _>(Picky::new(None), &[&negative]),
        Tensor::apply::<f64, _>(Picky::new(None), &[&negative.parameter()?]),
        // Gradients.
        a.backward().map(|_| a.clone()),
        a.parameter()?.backward().map(|_| a.clone()),
        tensor::<B>(&[1])?.backward().map(|_| a.clone()),
        a.greater(&a.parameter()?)?.sum_all()?.backward().map(|_| a.clone()),
    ])
}

fn refusals<B: Tested>(tally: &Tally) -> Outcome {
    let (own, reference) = (refused::<B>()?, refused::<Host>()?);
    assert_eq!(own.len(), reference.len());
    for (k, (own, reference)) in own.into_iter().zip(reference).enumerate() {
        let (Err(own), Err(reference)) = (own, reference) else { panic!("number {k} must be refused") };
        // Fields and words; only the backend may differ.
        let own = format!("{own:?}: {own}");
        let own = own.replace(&format!("backend: {:?}", B::NAME), "backend: \"host\"");
        let own = own.replace(&format!("on {}:", B::NAME), "on host:");
        let reference = format!("{reference:?}: {reference}");
        tally.check(own == reference, || format!("{own}\nmust be\n{reference}"))?;
    }
    Ok(())
}

/// An op's own error comes through as it is.
fn errors_of_steps<B: Tested>(tally: &Tally) -> Outcome {
    let number = Tensor::<B>::new(vec![0.0, -2.0, 0.0], &[3, 1], &B::place())?;
    let error = Tensor::apply::<f64, _>(Picky::new(None), &[&number]).unwrap_err();
    let TensorError::Backend { op: "picky", backend, cause: BackendError::Op(cause) } = &error else {
        panic!("{error:?}")
    };
    tally.check(*backend == B::NAME, || format!("{backend} for {}", B::NAME))?;
    let OpError::Item { item: 1, cause, .. } = cause else { panic!("{error:?}") };
    tally.check(cause.is::<Refused>(), || format!("{cause:?}"))?;
    let error = Tensor::apply::<f64, _>(Picky::new(Some(2)), &[&number]).unwrap_err();
    let TensorError::Backend { cause: BackendError::Op(OpError::Batch { expected: 2, found: 3, .. }), .. } = error
    else {
        panic!("{error:?}")
    };
    // Refused on the way back: with the op's words or, where the framework cannot stop, no number in the whole gradient.
    let number = Tensor::<B>::new(vec![0.0, 2.0], &[2, 1], &B::place())?.parameter()?;
    match Tensor::apply::<f64, _>(Picky::new(None), &[&number])?.sum_all()?.backward() {
        Ok(gradients) => {
            let gradient = gradients.of(&number).unwrap();
            let lost = gradient.dims() == number.dims() && gradient.to_f64()?.iter().all(|g| g.is_nan());
            tally.check(lost, || format!("{gradient:?} must be NaN, with the extents of the parameter"))
        }
        Err(error) => tally.check(error.to_string().contains("picky, item "), || format!("{error}")),
    }
}

fn parameters<B: Tested>(tally: &Tally) -> Outcome {
    let mut parameters = Parameters::<B>::new();
    parameters.insert("weight", &tensor::<B>(&[2, 3])?)?;
    let messages = [
        (parameters.get("bias").unwrap_err(), "there is no parameter bias; are these the weights of another model?"),
        (
            parameters.set("weight", &tensor::<B>(&[3, 2])?).unwrap_err(),
            "parameter weight is [3, 2], the model needs [2, 3]; check the model's sizes",
        ),
    ];
    for (error, message) in messages {
        tally.check(error.to_string() == message, || error.to_string())?;
    }
    Ok(())
}

#[test]
fn refusals_everywhere() {
    on_every_backend!(refusals);
}

#[test]
fn errors_of_steps_everywhere() {
    on_every_backend!(errors_of_steps);
}

#[test]
fn parameters_everywhere() {
    on_every_backend!(parameters);
}
