#!/usr/bin/env bash
# Trains a model of the size `tiny` in every mode of the paper, gp on two backends. About an hour on one core.
# Usage: tests/report/train_modes.sh DVP OUT    (DVP: the command, built with --features burn,candle)
set -euo pipefail
dvp=$1 out=$2
export RAYON_NUM_THREADS=1

train() { # NAME OPTIONS...
    "$dvp" train --out "$out/$1" --size tiny --learning-rate 0.002 --warm-up 200 --save-every 250 "${@:2}"
}

train gp-early --backend candle --mode gp --steps 500 --cosine false
train gp-candle --backend candle --mode gp --steps 1500
train ti --backend candle --mode ti --steps 1000
train ti-plus --backend candle --mode ti+ --steps 1000 --start "$out/gp-early/best.safetensors"
train ti-tp --backend candle --mode ti-tp --steps 1000 --start "$out/gp-early/best.safetensors"
train tp --backend candle --mode tp --steps 1000
train gi --backend candle --mode gi --steps 1000
train gp-burn --backend burn --mode gp --steps 1500
