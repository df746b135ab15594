"""Computes the outputs in models/*_io.safetensors again: the public implementations on the weights and inputs there.

The weights are random; so are the inputs. Run with the versions of models/versions.json:
pip install torch transformers==4.48.3 safetensors && python3 make_models.py
Prints by how much the outputs differ from those in the files; `--write` puts them there.
"""

import json
import pathlib
import sys

import torch
from safetensors.torch import load_file, save_file
from transformers import ConditionalDetrConfig, Dinov2WithRegistersConfig, Dinov2WithRegistersModel
from transformers.models.conditional_detr.modeling_conditional_detr import (
    ConditionalDetrDecoder,
    ConditionalDetrEncoder,
)

FOLDER = pathlib.Path(__file__).parent / "models"


def read_config(name):
    return json.loads((FOLDER / f"{name}_config.json").read_text())


def under(weights, path):
    return {name.removeprefix(path): tensor for name, tensor in weights.items() if name.startswith(path)}


def dinov2(inputs):
    model = Dinov2WithRegistersModel(Dinov2WithRegistersConfig(**read_config("dinov2_tiny"))).eval()
    model.load_state_dict(load_file(FOLDER / "dinov2_tiny.safetensors"))
    output = model(inputs["pixel_values"], output_hidden_states=True)
    states = {f"hidden_{k}": state for k, state in enumerate(output.hidden_states)}
    return {**states, "last_hidden_state": output.last_hidden_state}


def conditional_detr(inputs):
    config = ConditionalDetrConfig(**read_config("conditional_detr_tiny"))
    weights = load_file(FOLDER / "conditional_detr_tiny.safetensors")
    encoder, decoder = ConditionalDetrEncoder(config).eval(), ConditionalDetrDecoder(config).eval()
    encoder.load_state_dict(under(weights, "encoder."))
    decoder.load_state_dict(under(weights, "decoder."))
    features, position = (inputs[name].flatten(2).permute(0, 2, 1) for name in ("features", "position"))
    memory = encoder(inputs_embeds=features, object_queries=position).last_hidden_state
    queries = weights["query_position_embedding.weight"].unsqueeze(0).repeat(len(features), 1, 1)
    latents = decoder(
        inputs_embeds=torch.zeros_like(queries),
        encoder_hidden_states=memory,
        object_queries=position,
        query_position_embeddings=queries,
    ).last_hidden_state
    return {"encoder_output": memory, "decoder_output": latents}


for name, run in {"dinov2_tiny": dinov2, "conditional_detr_tiny": conditional_detr}.items():
    path = FOLDER / f"{name}_io.safetensors"
    io = load_file(path)
    with torch.no_grad():
        outputs = run(io)
    for key, output in outputs.items():
        print(name, key, (output - io[key]).abs().max().item())
    if "--write" in sys.argv[1:]:
        save_file({**io, **{key: output.contiguous() for key, output in outputs.items()}}, path)
