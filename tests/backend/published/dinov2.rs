//! DINOv2 with registers, on images that are not square: the position table is resampled.

use dvp_core::tensor::{Parameters, Tensor};
use dvp_net::dinov2::{Dinov2, Dinov2Config};
use dvp_net::error::NetError;
use dvp_net::weights::Weights;

use super::{Published, config, gradients, io, published, weights};
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

struct Encoder;

impl Published for Encoder {
    const STEM: &'static str = "dinov2_tiny";
    const INPUT: &'static str = "pixel_values";
    const UNUSED: &'static [&'static str] = &["embeddings.mask_token"];

    fn output<B: Tested>(parameters: &Parameters<B>, input: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        Dinov2::load(&config::<Self, Dinov2Config>(), &Weights::new(parameters))?.forward(input)
    }
}

fn dinov2_outputs<B: Tested>(tally: &Tally) -> Outcome {
    let config: Dinov2Config = config::<Encoder, _>();
    let (parameters, io) = (weights::<Encoder, B>(), io::<Encoder, B>());
    let model = Dinov2::load(&config, &Weights::new(&parameters))?;
    let images = io.get(Encoder::INPUT)?;
    let states = model.hidden_states(images)?;
    tally.check(states.len() == config.num_hidden_layers + 1, || format!("{} states", states.len()))?;
    for (k, state) in states.iter().enumerate() {
        published(tally, &format!("hidden_{k}"), state, &io)?;
    }
    let tokens = model.forward(images)?;
    published(tally, "last_hidden_state", &tokens, &io)?;

    let frozen = Dinov2::load(&config, &Weights::new(&parameters).frozen())?;
    let constant = frozen.forward(&images.detach()?)?;
    tally.check(!constant.is_tracked(), || "a frozen encoder leaves nothing to train".into())?;
    tally.check(constant.to_f64()? == tokens.to_f64()?, || "a frozen encoder gives the same".into())
}

fn dinov2_gradients<B: Tested>(tally: &Tally) -> Outcome {
    gradients::<Encoder, B>(tally)
}

#[test]
fn dinov2_gives_the_published_outputs_everywhere() {
    on_every_backend!(dinov2_outputs);
}

#[test]
fn dinov2_has_the_same_gradients_everywhere() {
    on_every_backend!(dinov2_gradients);
}
