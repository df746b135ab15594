//! MONet's loss by hand; of both decomposers the gradient against central differences, and what they refuse; parts of an image.

use core::f64::consts::TAU;

use dvp_core::ImageSize;
use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};

use super::monet::MonetConfig;
use super::slots::SlotsConfig;
use super::terms::{apart, mixture, told};
use super::{DecomposerConfig, PartsOf};
use crate::error::NetError;
use crate::initial::initial_weights;
use crate::weights::{Weights, asked};

pub(super) fn tensor(values: &[f64], extents: &[usize]) -> Tensor<Host> {
    Tensor::new(values.to_vec(), extents, &HostDevice).unwrap()
}

pub(super) fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} for {expected}");
}

/// The sizes for tests of each decomposer, for images of 16 x 16.
fn all() -> [DecomposerConfig; 2] {
    [DecomposerConfig::Monet(MonetConfig::tiny(16)), DecomposerConfig::Slots(SlotsConfig::tiny(16))]
}

fn weights(config: &DecomposerConfig, seed: u64) -> Parameters<Host> {
    let asked = asked::<Host, _>(&HostDevice, |weights| config.load(weights)).unwrap();
    initial_weights(&asked, seed, dvp_core::real::DType::F64, &HostDevice).unwrap()
}

/// Two images of 16 x 16 without a pattern.
fn images() -> Tensor<Host> {
    let value = |k: usize| 0.5 + 0.4 * (0.37 * k as f64 + 0.002 * (k * k % 91) as f64).sin();
    tensor(&(0..2 * 3 * 256).map(value).collect::<Vec<_>>(), &[2, 3, 16, 16])
}

#[test]
fn the_likelihood_of_a_mixture_by_hand() {
    // One pixel (1/2, 1/2, 1/2); two parts of shares 1/4 and 3/4, the first of exactly that color and deviation 1/10, the second
    // off by 1/10 in each channel, with deviation 1/5.
    let log_masks = tensor(&[0.25_f64.ln(), 0.75_f64.ln()], &[1, 2, 1, 1]);
    let colors = tensor(&[0.5, 0.5, 0.5, 0.6, 0.6, 0.6], &[1, 2, 3, 1, 1]);
    let found = mixture(&tensor(&[0.5; 3], &[1, 3, 1, 1]), &log_masks, &colors, &[0.1, 0.2]).unwrap();
    let density = |sigma: f64, square: f64| (-0.5 * square / (sigma * sigma)).exp() / (sigma * TAU.sqrt()).powi(3);
    let expected = -(0.25 * density(0.1, 0.0) + 0.75 * density(0.2, 3.0 * 0.01)).ln() + density(0.1, 0.0).ln();
    close(found.number().unwrap(), expected, 1e-12);
}

#[test]
fn divergences_by_hand() {
    // (m^2 + v - ln v - 1) / 2 summed, over 4: m = 1, v = 1: 1/2; m = 0, v = e: (e - 2) / 2.
    let found = told(&tensor(&[1.0, 0.0], &[1, 2]), &tensor(&[0.0, 1.0], &[1, 2]), 4).unwrap();
    close(found.number().unwrap(), (0.5 + (1.0_f64.exp() - 2.0) / 2.0) / 4.0, 1e-14);
    // 1/2 ln(1/2 / 1/4) + 1/2 ln(1/2 / 3/4).
    let of = |a: f64, b: f64| tensor(&[a.ln(), b.ln()], &[1, 2, 1, 1]);
    let found = apart(&of(0.5, 0.5), &of(0.25, 0.75)).unwrap().number().unwrap();
    close(found, 0.5 * 2.0_f64.ln() + 0.5 * (2.0_f64 / 3.0).ln(), 1e-14);
    assert!(apart(&of(0.3, 0.7), &of(0.3, 0.7)).unwrap().number().unwrap().abs() < 1e-15, "equal masks");
}

#[test]
fn masks_share_every_pixel_and_colors_are_colors() {
    for config in all() {
        let decomposer = config.load(&Weights::new(&weights(&config, 3)).frozen()).unwrap();
        let parts = decomposer.parts(&images()).unwrap();
        assert_eq!(parts.log_masks.dims().extents(), [2, 3, 16, 16]);
        assert_eq!(parts.colors.dims().extents(), [2, 3, 3, 16, 16]);
        for sum in parts.log_masks.exp().unwrap().sum(1).unwrap().to_f64().unwrap() {
            close(sum, 1.0, 1e-12);
        }
        assert!(parts.colors.to_f64().unwrap().iter().all(|color| (0.0..=1.0).contains(color)));
        // An image of a batch is judged as if it were alone.
        let alone = decomposer.parts(&images().slice(0, 1, 1).unwrap()).unwrap().of_images().unwrap();
        let both = parts.of_images().unwrap();
        let largest = both[1].masks().flatten().zip(alone[0].masks().flatten()).map(|(a, b)| (a - b).abs());
        assert!(largest.fold(0.0, f32::max) < 1e-6);
        assert_eq!((both.len(), both[1].slots()), (2, 3));
    }
}

#[test]
fn the_gradient_is_that_of_central_differences() {
    // The loss of MONet is some nats, that of Slot Attention some hundredths.
    for (config, scale) in all().into_iter().zip([1e-2, 1e-4]) {
        check_gradient(&config, scale);
    }
}

/// Holds the gradient of every weight against differences; `scale`: below it a gradient is small.
fn check_gradient(config: &DecomposerConfig, scale: f64) {
    let mut parameters = weights(config, 5);
    let loss = |parameters: &Parameters<Host>| {
        config.load(&Weights::new(parameters)).unwrap().judge(&images(), 11).unwrap().loss
    };
    let gradients = parameters.gradients(&loss(&parameters).backward().unwrap());
    assert_eq!(gradients.len(), parameters.len(), "every weight has a gradient");
    let names: Vec<String> = parameters.iter().map(|(name, _)| name.to_owned()).collect();
    let (step, mut moved) = (1e-5, 0);
    for name in names {
        let tensor = parameters.get(&name).unwrap().clone();
        let (values, gradient) = (tensor.to_f64().unwrap(), gradients[&name].to_f64().unwrap());
        // The weights with the largest and the smallest gradient of each tensor.
        let by = |a: &usize, b: &usize| gradient[*a].abs().total_cmp(&gradient[*b].abs());
        let ends = [(0..values.len()).max_by(by).unwrap(), (0..values.len()).min_by(by).unwrap()];
        for k in ends {
            let mut at = |offset: f64| {
                let mut values = values.clone();
                values[k] += offset;
                parameters.set(&name, &tensor.like(values, tensor.dims().extents()).unwrap()).unwrap();
                loss(&parameters).number().unwrap()
            };
            let difference = (at(step) - at(-step)) / (2.0 * step);
            at(0.0);
            // A kink of a ReLU within the step is an error of the order of the step times the kink.
            let tolerance = 2e-4 * gradient[k].abs().max(scale);
            assert!((difference - gradient[k]).abs() < tolerance, "{name}[{k}]: {} for {difference}", gradient[k]);
            moved += usize::from(gradient[k].abs() > 1e-4 * scale);
        }
    }
    assert!(moved > gradients.len(), "only {moved} of the gradients of {} are not 0", gradients.len());
}

#[test]
fn published_sizes_are_taken() {
    // Weights of the attention network alone, by the paper's layers: 3 x 3 kernels without a bias, two numbers per channel of a norm.
    for (side, channels) in [(64, &[4, 32, 32, 64, 64, 64][..]), (128, &[4, 32, 32, 32, 64, 64, 64])] {
        let config = MonetConfig::published(side);
        let asked =
            asked::<Host, _>(&HostDevice, |weights| DecomposerConfig::Monet(config.clone()).load(weights)).unwrap();
        let of = |path: &str| asked.iter().filter(|(name, _)| name.starts_with(path)).map(|(_, dims)| dims.len()).sum();
        let down: usize = of("attention.down.");
        let expected: usize = channels.windows(2).map(|pair| 9 * pair[0] * pair[1] + 2 * pair[1]).sum();
        assert_eq!(down, expected);
        // 16 latents and two places to 32 channels, three times 32 to 32, 32 to 4; each with a bias.
        let decoder: usize = of("vae.decoder.");
        assert_eq!(decoder + 32 * 4 + 4, 9 * 18 * 32 + 32 + 3 * (9 * 32 * 32 + 32) + 32 * 4 + 4);
    }
}

#[test]
fn sizes_and_images_that_do_not_fit_are_refused() {
    let (tiny, slots) = (|| MonetConfig::tiny(16), || SlotsConfig::tiny(16));
    let monet = [
        (MonetConfig { slots: 1, ..tiny() }, "slots"),
        (MonetConfig { side: 17, ..tiny() }, "side"),
        (MonetConfig { side: 2, ..tiny() }, "side"),
        (MonetConfig { attention_channels: vec![4; 16], ..tiny() }, "attention_channels"),
        (MonetConfig { encoder_channels: vec![], ..tiny() }, "encoder_channels"),
        (MonetConfig { decoder_channels: vec![0], ..tiny() }, "decoder_channels"),
        (MonetConfig { decoder_step: 3, ..tiny() }, "decoder_step"),
        (MonetConfig { beta: f64::NAN, ..tiny() }, "beta"),
        (MonetConfig { sigma_foreground: 0.0, ..tiny() }, "sigma_foreground"),
    ];
    let slots = [
        (SlotsConfig { slots: 1, ..slots() }, "slots"),
        (SlotsConfig { side: 0, ..slots() }, "side"),
        (SlotsConfig { rounds: 0, ..slots() }, "rounds"),
        (SlotsConfig { width: 0, ..slots() }, "width"),
        (SlotsConfig { hidden: 0, ..slots() }, "hidden"),
        (SlotsConfig { encoder_channels: vec![], ..slots() }, "encoder_channels"),
        (SlotsConfig { decoder_channels: vec![4, 0], ..slots() }, "decoder_channels"),
        (SlotsConfig { encoder_step: 0, ..slots() }, "encoder_step"),
        (SlotsConfig { decoder_step: 3, ..slots() }, "decoder_step"),
    ];
    let monet = monet.map(|(config, key)| (DecomposerConfig::Monet(config), key));
    for (config, key) in monet.into_iter().chain(slots.map(|(config, key)| (DecomposerConfig::Slots(config), key))) {
        let error = asked::<Host, _>(&HostDevice, |weights| config.load(weights)).unwrap_err();
        assert!(matches!(error, NetError::Config { key: found, .. } if found == key), "{key}: {error}");
    }
    for config in all() {
        let parameters = weights(&config, 1);
        let decomposer = config.load(&Weights::new(&parameters)).unwrap();
        for extents in [[2, 3, 16, 8], [2, 1, 16, 16], [0, 3, 16, 16]] {
            let images = tensor(&vec![0.0; extents.iter().product()], &extents);
            assert!(matches!(decomposer.judge(&images, 0), Err(NetError::Input { .. })), "{extents:?}");
            assert!(matches!(decomposer.parts(&images), Err(NetError::Input { .. })), "{extents:?}");
        }
    }
}

#[test]
fn the_largest_part_is_the_background_and_specks_belong_to_it() {
    // 32 x 32: the second part holds all but a row, the first that row but one pixel, the third the pixel.
    let size = ImageSize::new(32, 32).unwrap();
    let owner = |pixel: usize| match pixel {
        0..31 => 0,
        31 => 2,
        _ => 1,
    };
    let masks = (0..3 * 1024).map(|k| if owner(k % 1024) == k / 1024 { 0.8 } else { 0.1 }).collect();
    let colors = (0..9 * 1024).map(|k| [0.0, 0.5, 1.0][k / 3072]).collect();
    let parts = PartsOf::new(size, masks, colors);
    let labels = parts.labels();
    assert_eq!((labels[0], labels[30], labels[31], labels[32], labels[1023]), (1, 1, 0, 0, 0));
    // 0.1 x 0 + 0.8 x 0.5 + 0.1 x 1.
    let painted = parts.reconstruction();
    assert!((painted.data()[1023] - 0.5).abs() < 1e-6 && (painted.data()[31] - 0.85).abs() < 1e-6);
}
