//! Each operation and its gradient against the host backend, on a sample; `tests/backend` has the whole suite.

use burn::tensor::Device;
use dvp_core::diff_op::Atan2;
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, Binary, Host, HostDevice, Stride, Tensor, TensorError, Unary};

use crate::Burn;

type Run<B> = Box<dyn Fn(&[Tensor<B>]) -> Result<Tensor<B>, TensorError>>;

/// Name, extents of the operands, operation.
type Case<B> = (String, Vec<Vec<usize>>, Run<B>);

fn case<B: Backend>(
    name: impl Into<String>,
    operands: &[&[usize]],
    run: impl Fn(&[Tensor<B>]) -> Result<Tensor<B>, TensorError> + 'static,
) -> Case<B> {
    (name.into(), operands.iter().map(|extents| extents.to_vec()).collect(), Box::new(run))
}

fn cases<B: Backend>() -> Vec<Case<B>> {
    let mut cases = vec![
        case("affine", &[&[2, 3]], |x| x[0].affine(0.1, 1.0 / 3.0)),
        case("rank 0", &[&[], &[]], |x| x[0].mul(&x[1])?.add(&x[0])?.affine(2.0, 0.5)?.exp()),
        case("greater", &[&[2, 3], &[3]], |x| x[0].greater(&x[1])?.mul(&x[0])),
        case("reshape", &[&[2, 6]], |x| x[0].reshape(&[3, 1, 4])),
        case("permute", &[&[2, 3, 4]], |x| x[0].permute(&[2, 0, 1])),
        case("permute and reshape", &[&[2, 3, 4]], |x| x[0].permute(&[2, 0, 1])?.reshape(&[24])),
        case("expand", &[&[3, 1]], |x| x[0].expand(&[2, 3, 4])),
        case("slice", &[&[3, 5]], |x| x[0].slice(1, 1, 3)),
        case("slice of nothing", &[&[3, 5]], |x| Tensor::concat(&[&x[0].slice(1, 5, 0)?, &x[0]], 1)),
        case("slices of nothing", &[&[3, 5]], |x| {
            let nothing = x[0].slice(0, 3, 0)?.exp()?;
            let nothing = nothing.slice(1, 0, 3)?.mul(&nothing.slice(1, 1, 3)?)?;
            Tensor::concat(&[&nothing, &x[0].slice(1, 2, 3)?], 0)
        }),
        case("concat", &[&[2, 3], &[2, 1]], |x| Tensor::concat(&[&x[0], &x[1], &x[0]], 1)),
        case("select", &[&[3, 4]], |x| x[0].select(1, &[3, 0, 3])),
        case("sum", &[&[2, 3, 4]], |x| x[0].sum(1)),
        case("sum of nothing", &[&[2, 3]], |x| x[0].slice(1, 0, 0)?.sum(1)?.add(&x[0])),
        case("max", &[&[2, 5]], |x| x[0].max(1)),
        case("softmax", &[&[2, 5]], |x| x[0].softmax(1)),
        case("layer norm", &[&[2, 5]], |x| x[0].layer_norm(1e-5)),
        case("matmul", &[&[3, 2, 4], &[3, 4, 5]], |x| x[0].matmul(&x[1])),
        case("matmul, transposed", &[&[3, 2], &[5, 2]], |x| x[0].matmul(&x[1].transpose()?)),
        case("matmul, broadcast", &[&[2, 1, 2, 3], &[4, 3, 2]], |x| x[0].matmul(&x[1])),
        case("matmul over nothing", &[&[2, 3], &[3, 2]], |x| {
            x[0].slice(1, 0, 0)?.matmul(&x[1].slice(0, 0, 0)?)?.add(&x[1].slice(0, 0, 2)?)
        }),
        case("max pool", &[&[2, 2, 5, 7]], |x| x[0].max_pool2d(3, Stride { step: 2, padding: 1 })),
        case("host op", &[&[2, 3], &[2, 3]], |x| match x[0].dtype() {
            DType::F32 => Tensor::apply::<f32, _>(Atan2::new(&[3])?, &[&x[0], &x[1]]),
            DType::F64 => Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[&x[0], &x[1]]),
        }),
        // The first input is not where a row of burn's memory starts, and its rows are not in order.
        case("host op of a view", &[&[3, 4], &[4, 2]], |x| {
            let y = x[0].transpose()?.slice(1, 1, 2)?;
            match y.dtype() {
                DType::F32 => Tensor::apply::<f32, _>(Atan2::new(&[2])?, &[&y, &x[1]]),
                DType::F64 => Tensor::apply::<f64, _>(Atan2::new(&[2])?, &[&y, &x[1]]),
            }
        }),
    ];
    for function in Unary::ALL {
        cases.push(case(format!("{function:?}"), &[&[2, 3]], move |x| x[0].unary(function)));
    }
    for function in Binary::ALL {
        cases.push(case(format!("{function:?}"), &[&[2, 1, 3], &[4, 1]], move |x| x[0].binary(function, &x[1])));
    }
    // Kernels that leave a remainder in one direction, in both or in none, larger than the image, of one pixel.
    for (image, kernel, step, padding) in [
        ([5, 7], [3, 3], 1, 0),
        ([5, 7], [3, 3], 2, 1),
        ([6, 7], [3, 2], 2, 0),
        ([8, 5], [3, 3], 3, 2),
        ([4, 4], [1, 1], 2, 1),
        ([2, 3], [4, 5], 1, 1),
        ([9, 8], [2, 4], 4, 3),
    ] {
        let (image, kernel) = ([2, 3, image[0], image[1]], [4, 3, kernel[0], kernel[1]]);
        let stride = Stride { step, padding };
        let name = format!("conv2d of {image:?} and {kernel:?}, {stride:?}");
        cases.push(case(name, &[&image, &kernel], move |x| x[0].conv2d(&x[1], stride)));
    }
    cases
}

/// Distinct numbers between 0.3 and 1.9.
fn number(k: usize) -> f64 {
    0.3 + 1.6 * ((k + 1) as f64 * 0.618_033_988_749_895).fract()
}

/// The result, and the gradient of its weighted sum with respect to each operand.
fn run<B: Backend>(case: &Case<B>, dtype: DType, device: &B::Device) -> Result<Vec<Vec<f64>>, TensorError> {
    let (_, operands, run) = case;
    let tensors = operands.iter().enumerate().map(|(k, extents)| {
        let dims = Dims::new(extents)?;
        let values = Values::F64((0..dims.len()).map(|i| number(100 * k + i)).collect());
        Tensor::from_values(values.cast(dtype), &dims, device)?.parameter()
    });
    let operands: Vec<Tensor<B>> = tensors.collect::<Result<_, _>>()?;
    let output = run(&operands)?;
    let weights = (0..output.dims().len()).map(|k| number(7 * k + 3) - 1.0).collect();
    let loss = output.mul(&output.like(weights, output.dims().extents())?)?.sum_all()?;
    let gradients = loss.backward()?;
    let mut results = vec![output.to_f64()?];
    for operand in &operands {
        results.push(gradients.of(operand).map_or(Ok(Vec::new()), |gradient| gradient.to_f64())?);
    }
    Ok(results)
}

/// `tolerance` is that of the largest number of each result; the case `but` is left out.
fn compare(dtype: DType, device: &Device, tolerance: f64, but: Option<&str>) {
    let mut wrong = Vec::new();
    for (host, burn) in cases::<Host>().iter().zip(&cases::<Burn>()).filter(|(host, _)| Some(host.0.as_str()) != but) {
        let expected = run(host, dtype, &HostDevice).unwrap();
        let found = match run(burn, dtype, device) {
            Ok(found) => found,
            Err(error) => {
                wrong.push(format!("{}: {error}", host.0));
                continue;
            }
        };
        for (k, (expected, found)) in expected.iter().zip(&found).enumerate() {
            let scale = expected.iter().fold(f64::MIN_POSITIVE, |scale, x| scale.max(x.abs()));
            let error = expected.iter().zip(found).fold(0.0_f64, |error, (x, y)| error.max((x - y).abs() / scale));
            if expected.len() != found.len() || error.is_nan() || error > tolerance {
                wrong.push(format!("{}, result {k}: {error:e}\n  {expected:?}\n  {found:?}", host.0));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn operations_and_gradients_are_those_of_the_host() {
    compare(DType::F64, &Device::flex(), 1e-13, None);
    compare(DType::F32, &Device::flex(), 2e-6, None);
}

/// On graphics cards, or the CPU by a driver that plays one; skipped where burn finds neither.
#[cfg(feature = "wgpu")]
#[test]
fn operations_and_gradients_on_wgpu() {
    use std::io::Write as _;

    use burn::backend::wgpu::graphics::AutoGraphicsApi;
    use burn::backend::wgpu::{RuntimeOptions, WgpuDevice, try_init_setup};

    let device = WgpuDevice::default();
    if let Err(error) = try_init_setup::<AutoGraphicsApi>(&device, RuntimeOptions::default()) {
        // The test runner shows what `eprintln` says for failed tests alone.
        let _ = writeln!(std::io::stderr(), "SKIPPED operations_and_gradients_on_wgpu: {error}");
        return;
    }
    let device = Device::new(device);
    // The way back of arrays without numbers: burn-cubecl 0.22.1 subtracts below 0 there.
    compare(DType::F32, &device, 2e-5, Some("slices of nothing"));
    // Many cards have no f64; the CPU as a card has.
    if let Err(error) = Tensor::<Burn>::new(vec![1.0_f64], &[1], &device) {
        let error = error.to_string();
        assert!(error.contains("has no f64; work in f32, or on the CPU"), "{error}");
    }
    let own = Tensor::<Burn>::new(vec![1.0_f32], &[1], &device).unwrap();
    let other = Tensor::<Burn>::new(vec![1.0_f32], &[1], &Device::flex()).unwrap();
    assert!(matches!(own.add(&other), Err(TensorError::Devices { .. })));
}
