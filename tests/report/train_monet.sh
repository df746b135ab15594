#!/usr/bin/env bash
# MONet on pictures of 32 pixels, as the report has it: a leg at a high rate, one at a lower; then its rows and its samples.
# Usage: tests/report/train_monet.sh DVP OUT [STEPS_1 STEPS_2]    (DVP: the command, built with --features candle)
set -euo pipefail
dvp=$1 out=$2 first=${3:-5000} second=${4:-11250}
here=$(dirname "$0")/monet
export RAYON_NUM_THREADS=1

"$dvp" train --out "$out" --model monet --backend candle --size "$here/sizes32.json" --side 32 --batch 8 --steps "$first" \
    --cosine false --learning-rate 0.001 --warm-up 100 --clip-norm 20 --save-every 250 --validation 32
"$dvp" train --out "$out" --resume --learning-rate 0.0003 --steps "$second"
"$dvp" evaluate --generated 256 --seed 4321 --method monet --model "$out/best.safetensors"
"$dvp" decompose --generated 8 --seed 4321 --model "$out/best.safetensors" --out "$out/parts.png"
