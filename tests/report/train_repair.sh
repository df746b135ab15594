#!/usr/bin/env bash
# What images alone do to a model that has learned from scenes: TI+ and TI-TP from the same weights, of the size `cells`.
# Usage: tests/report/train_repair.sh DVP WEIGHTS OUT [STEPS]    (DVP: the command, built with --features candle)
set -euo pipefail
dvp=$1 weights=$2 out=$3 steps=${4:-200}
export RAYON_NUM_THREADS=1

for mode in ti+ ti-tp; do
    "$dvp" train --out "$out/$mode" --backend candle --size cells --mode "$mode" --start "$weights" \
        --steps "$steps" --learning-rate 0.0003 --warm-up 20 --seed 3 --save-every 50 --rotation-weight 0.3 --scale-weight 5
    # The last weights: the best ones by the image error may be those of the start.
    last=$(ls "$out/$mode"/checkpoint-*.safetensors | tail -n 1)
    "$dvp" evaluate --model "$last" --looks 0 --generated 256 --seed 4321
done
"$dvp" evaluate --model "$weights" --looks 0 --generated 256 --seed 4321
