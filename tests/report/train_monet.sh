#!/usr/bin/env bash
# MONet on pictures of 64 pixels, as the report has it: a leg of large batches on a graphics card, then five of small ones on a processor, each
# from the weights of the one before; then its rows and its samples.
# Usage: tests/report/train_monet.sh DVP OUT [STEPS_1 STEPS_2 STEPS_3 STEPS_4 STEPS_5 STEPS_6]    (DVP: the command, built with --features wgpu,candle)
set -euo pipefail
dvp=$1 out=$2 first=${3:-3600} second=${4:-8000} third=${5:-3000} fourth=${6:-15000} fifth=${7:-8000} sixth=${8:-8000}
common=(--model monet --size "$(dirname "$0")/monet/sizes64.json" --side 64 --clip-norm 20 --validation 64)
small=(--backend candle --batch 8 --learning-rate 0.0004 --warm-up 100 --save-every 100)

"$dvp" train --out "$out/1" "${common[@]}" --backend wgpu --batch 64 --steps "$first" --learning-rate 0.001 --warm-up 300 --save-every 300
export RAYON_NUM_THREADS=1
"$dvp" train --out "$out/2" "${common[@]}" "${small[@]}" --steps "$second" --start "$out/1/best.safetensors" --seed 2
"$dvp" train --out "$out/3" "${common[@]}" "${small[@]}" --steps "$third" --start "$out/2/best.safetensors" --seed 3
"$dvp" train --out "$out/4" "${common[@]}" "${small[@]}" --steps "$fourth" --start "$out/3/best.safetensors" --seed 4
"$dvp" train --out "$out/5" "${common[@]}" "${small[@]}" --steps "$fifth" --start "$out/4/best.safetensors" --seed 5
"$dvp" train --out "$out/6" "${common[@]}" "${small[@]}" --steps "$sixth" --start "$out/5/best.safetensors" --seed 6
"$dvp" evaluate --generated 256 --seed 20261124 --method monet --model "$out/6/best.safetensors"
"$dvp" decompose --generated 8 --seed 4321 --model "$out/6/best.safetensors" --out "$out/parts.png"
