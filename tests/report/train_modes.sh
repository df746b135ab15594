#!/usr/bin/env bash
# Trains a model of the size `tiny` in every mode of the paper, the first steps of gp on two backends.
# Usage: tests/report/train_modes.sh DVP OUT    (DVP: the command, built with --features burn,candle)
# A run that is there already goes on.
set -euo pipefail
dvp=$1 out=$2
export RAYON_NUM_THREADS=1

train() { # NAME OPTIONS...
    if [ -e "$out/$1/run.json" ]; then
        "$dvp" train --out "$out/$1" --resume
    else
        "$dvp" train --out "$out/$1" --size tiny --learning-rate 0.002 --warm-up 200 --save-every 100 "${@:2}"
    fi
}

train gp-early --backend candle --mode gp --steps 500 --cosine false
train gp --backend candle --mode gp --steps 1500
train ti --backend candle --mode ti --steps 400
train ti-plus --backend candle --mode ti+ --steps 400 --start "$out/gp-early/best.safetensors"
train ti-tp --backend candle --mode ti-tp --steps 400 --start "$out/gp-early/best.safetensors"
train tp --backend candle --mode tp --steps 400
train gi --backend candle --mode gi --steps 400
train gp-early-burn --backend burn --mode gp --steps 500 --cosine false
