//! Conditional DETR.

use dvp_core::tensor::{Parameters, Tensor};
use dvp_net::detr::{ConditionalDetr, DetrConfig};
use dvp_net::error::NetError;
use dvp_net::weights::Weights;

use super::{Published, TOLERANCE, config, gradients, io, published, weights};
use crate::check::close;
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

struct Transformer;

impl Published for Transformer {
    const STEM: &'static str = "conditional_detr_tiny";
    const INPUT: &'static str = "features";
    const UNUSED: &'static [&'static str] = &[];

    fn output<B: Tested>(parameters: &Parameters<B>, input: &Tensor<B>) -> Result<Tensor<B>, NetError> {
        Ok(load(parameters)?.forward(input)?.latents)
    }
}

fn load<B: Tested>(parameters: &Parameters<B>) -> Result<ConditionalDetr<B>, NetError> {
    ConditionalDetr::load(&config::<Transformer, DetrConfig>(), &Weights::new(parameters))
}

fn detr_outputs<B: Tested>(tally: &Tally) -> Outcome {
    let io = io::<Transformer, B>();
    let model = load(&weights::<Transformer, B>())?;
    let output = model.forward(io.get(Transformer::INPUT)?)?;
    published(tally, "encoder_output", &output.memory, &io)?;
    published(tally, "decoder_output", &output.latents, &io)
}

/// Images of a batch do not see each other, though the first layer of the decoder starts with what they share.
fn detr_images<B: Tested>(tally: &Tally) -> Outcome {
    let model = load(&weights::<Transformer, B>())?;
    let features = io::<Transformer, B>().get(Transformer::INPUT)?.clone();
    let together = model.forward(&features)?.latents;
    let alone = |k| model.forward(&features.slice(0, k, 1)?).map(|output| output.latents);
    let alone = Tensor::concat(&[&alone(0)?, &alone(1)?], 0)?;
    close(tally, "image by image", &alone.to_f64()?, &together.to_f64()?, TOLERANCE)
}

fn detr_gradients<B: Tested>(tally: &Tally) -> Outcome {
    gradients::<Transformer, B>(tally)
}

#[test]
fn conditional_detr_gives_the_published_outputs_everywhere() {
    on_every_backend!(detr_outputs);
}

#[test]
fn images_of_a_batch_do_not_see_each_other_anywhere() {
    on_every_backend!(detr_images);
}

#[test]
fn conditional_detr_has_the_same_gradients_everywhere() {
    on_every_backend!(detr_gradients);
}
