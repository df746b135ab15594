#!/usr/bin/env bash
# Slot Attention on pictures of 32 pixels, as the report has it; then its row and its samples.
# Usage: tests/report/train_slots.sh DVP OUT [STEPS]    (DVP: the command, built with --features candle)
set -euo pipefail
dvp=$1 out=$2 steps=${3:-15000}
export RAYON_NUM_THREADS=1

"$dvp" train --out "$out" --model slots --backend candle --size "$(dirname "$0")/slots/sizes32.json" --side 32 --batch 8 \
    --learning-rate 0.001 --warm-up 200 --save-every 250 --validation 32 --seed 3 --steps "$steps"
"$dvp" evaluate --generated 256 --seed 20261124 --method slots --model "$out/best.safetensors"
"$dvp" decompose --generated 8 --seed 4321 --model "$out/best.safetensors" --out "$out/parts.png"
