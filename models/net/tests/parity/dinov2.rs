//! DINOv2 with registers, on images that are not square: the position table is resampled.

use dvp_core::tensor::Backend;
use dvp_net::dinov2::{Dinov2, Dinov2Config};
use dvp_net::weights::Weights;

use crate::backends::on_every_backend;
use crate::published::{assert_all_used, assert_close, config, tensors};

fn published_outputs<B: Backend>(device: &B::Device) {
    let config: Dinov2Config = config("dinov2_tiny_config.json");
    let parameters = tensors::<B>("dinov2_tiny.safetensors", device);
    let io = tensors::<B>("dinov2_tiny_io.safetensors", device);
    let model = Dinov2::load(&config, &Weights::new(&parameters)).unwrap();
    let images = io.get("pixel_values").unwrap();
    let states = model.hidden_states(images).unwrap();
    assert_eq!(states.len(), config.num_hidden_layers + 1);
    for (k, state) in states.iter().enumerate() {
        assert_close(&format!("state {k}"), state, io.get(&format!("hidden_{k}")).unwrap());
    }
    let tokens = model.forward(images).unwrap();
    assert_close("last state", &tokens, io.get("last_hidden_state").unwrap());
    assert_all_used(&tokens, &parameters, &["embeddings.mask_token"]);

    let frozen = Dinov2::load(&config, &Weights::new(&parameters).frozen()).unwrap();
    let constant = frozen.forward(&images.detach().unwrap()).unwrap();
    assert!(!constant.is_tracked(), "{}: a frozen encoder leaves nothing to train", B::NAME);
    assert_eq!(constant.to_f64().unwrap(), tokens.to_f64().unwrap());
}

#[test]
fn dinov2_gives_the_published_outputs() {
    on_every_backend!(published_outputs);
}
