#!/usr/bin/env bash
# Trains a model in every mode of the paper, on candle and on burn, and scores it.
# Usage: tests/report/train_modes.sh DVP OUT [SIZE]    (DVP: the command, built with --features burn,candle; SIZE: cells)
# A run that is there already goes on.
set -euo pipefail
dvp=$1 out=$2 size=${3:-cells}
export RAYON_NUM_THREADS=1

train() { # NAME OPTIONS...
    if [ -e "$out/$1/run.json" ]; then
        "$dvp" train --out "$out/$1" --resume
    else
        "$dvp" train --out "$out/$1" --size "$size" --rotation-weight 0.3 --scale-weight 5 --save-every 100 "${@:2}"
    fi
    # The last weights: the best ones by the image error may be those of the start.
    last=$(ls "$out/$1"/checkpoint-*.safetensors | tail -n 1)
    "$dvp" evaluate --model "$last" --looks 0 --generated 256 --seed 4321
}

nothing=(--learning-rate 0.0015 --warm-up 50)
learned=(--learning-rate 0.0005 --warm-up 20 --steps 400 --seed 3 --start "$out/gp-candle/best.safetensors")
for backend in candle burn; do
    train gp-$backend --backend $backend --mode gp --steps 500 "${nothing[@]}"
    for mode in ti gi tp; do
        train $mode-$backend --backend $backend --mode $mode --steps 400 "${nothing[@]}"
    done
    for mode in gp ti+ ti-tp; do
        train $mode-more-$backend --backend $backend --mode $mode "${learned[@]}"
    done
done
