#!/usr/bin/env bash
# Trains models of several sizes from nothing on the same images, 500 steps of gp each, and scores them.
# Usage: tests/report/train_sizes.sh DVP OUT    (DVP: the command, built with --features candle)
set -euo pipefail
dvp=$1 out=$2
export RAYON_NUM_THREADS=1
mkdir -p "$out"

cells() { # WIDTH LAYERS: sizes like `cells`, wider or narrower
    cat <<JSON
{"encoder": {"kind": "conv", "patch": 8, "channels": [$(($1 / 2)), $1], "residual": 1}, "batch_norm": false,
 "transformer": {"d_model": $1, "num_queries": 8, "encoder_layers": $2, "encoder_attention_heads": 8,
  "encoder_ffn_dim": $((2 * $1)), "decoder_layers": $2, "decoder_attention_heads": 8, "decoder_ffn_dim": $((2 * $1)),
  "activation_function": "relu", "position_embedding_type": "sine"},
 "slots": {"cells": {"rows": 8, "columns": 8}}, "head_width": $1, "shape": "prototypes", "rotation": "by_symmetry"}
JSON
}

cells 24 1 > "$out/cells24.json"
cells 48 1 > "$out/cells48.json"
cells 96 1 > "$out/cells96.json"
cells 128 2 > "$out/cells128.json"
for size in tiny small "$out"/cells{24,48,96,128}.json; do
    run=$out/$(basename "$size" .json)
    "$dvp" train --out "$run" --backend candle --size "$size" --mode gp --steps 500 --learning-rate 0.0015 --warm-up 50 \
        --rotation-weight 0.3 --scale-weight 5 --save-every 100
    "$dvp" evaluate --model "$run/best.safetensors" --looks 0 --generated 256 --seed 4321
done
