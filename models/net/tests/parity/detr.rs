//! Conditional DETR.

use dvp_core::tensor::{Backend, Tensor};
use dvp_net::detr::{ConditionalDetr, DetrConfig};
use dvp_net::weights::Weights;

use crate::backends::on_every_backend;
use crate::published::{assert_all_used, assert_close, config, tensors};

fn published_outputs<B: Backend>(device: &B::Device) {
    let config: DetrConfig = config("conditional_detr_tiny_config.json");
    let parameters = tensors::<B>("conditional_detr_tiny.safetensors", device);
    let io = tensors::<B>("conditional_detr_tiny_io.safetensors", device);
    let model = ConditionalDetr::load(&config, &Weights::new(&parameters)).unwrap();
    let output = model.forward(io.get("features").unwrap()).unwrap();
    assert_close("tokens", &output.memory, io.get("encoder_output").unwrap());
    assert_close("latents", &output.latents, io.get("decoder_output").unwrap());
    assert_all_used(&output.latents, &parameters, &[]);
}

/// Images of a batch do not see each other, though the first layer of the decoder starts with what they share.
fn images_alone<B: Backend>(device: &B::Device) {
    let config: DetrConfig = config("conditional_detr_tiny_config.json");
    let parameters = tensors::<B>("conditional_detr_tiny.safetensors", device);
    let model = ConditionalDetr::load(&config, &Weights::new(&parameters)).unwrap();
    let features = tensors::<B>("conditional_detr_tiny_io.safetensors", device).get("features").unwrap().clone();
    let together = model.forward(&features).unwrap().latents;
    let alone = |k| model.forward(&features.slice(0, k, 1).unwrap()).unwrap().latents;
    assert_close("image by image", &Tensor::concat(&[&alone(0), &alone(1)], 0).unwrap(), &together);
}

#[test]
fn conditional_detr_gives_the_published_outputs() {
    on_every_backend!(published_outputs);
}

#[test]
fn images_of_a_batch_do_not_see_each_other() {
    on_every_backend!(images_alone);
}
