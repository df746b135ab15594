#!/usr/bin/env bash
# MONet on pictures of 32 pixels, as the report has it: a leg at a high rate, one at a lower, then one that begins anew at a high rate
# from the weights of these and falls along a cosine; then its rows and its samples.
# Usage: tests/report/train_monet.sh DVP OUT [STEPS_1 STEPS_2 STEPS_3]    (DVP: the command, built with --features candle)
set -euo pipefail
dvp=$1 out=$2 first=${3:-5000} second=${4:-11250} third=${5:-16500}
here=$(dirname "$0")/monet
export RAYON_NUM_THREADS=1
common=(--model monet --backend candle --size "$here/sizes32.json" --side 32 --batch 8 --clip-norm 20 --save-every 250 --validation 32)

"$dvp" train --out "$out/early" "${common[@]}" --steps "$first" --cosine false --learning-rate 0.001 --warm-up 100
"$dvp" train --out "$out/early" --resume --learning-rate 0.0003 --steps "$second"
"$dvp" train --out "$out/late" "${common[@]}" --steps "$third" --start "$out/early/best.safetensors" --learning-rate 0.0007 --warm-up 200 --seed 2
"$dvp" evaluate --generated 256 --seed 20261124 --method monet --model "$out/late/best.safetensors"
"$dvp" decompose --generated 8 --seed 4321 --model "$out/late/best.safetensors" --out "$out/parts.png"
