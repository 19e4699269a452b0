#!/bin/sh
# Float against double: the same scenes, seeds and samples rendered by the usual build and by one with --enable-double.
#
# Columns, from block_difference on 8 x 8 blocks, all relative: the largest difference of block means; its standard
# error over the seeds; the largest difference less what noise explains (p = 0.01 for all blocks together); the
# difference of the whole picture and its standard error; and, for comparison, how much block means differ between two
# seeds. Equal seeds cancel most of that last figure, because paths are the same except where rounding decides.
# SEEDS, SAMPLES, RESOLUTION, DEPTH and INTEGRATORS shorten it.
# usage: bench_double.sh FLOAT DOUBLE BLOCK_DIFFERENCE SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

SEEDS=${SEEDS:-8}
SAMPLES=${SAMPLES:-16}
RESOLUTION=${RESOLUTION:-64x48}
DEPTH=${DEPTH:-8}
INTEGRATORS=${INTEGRATORS:-pt bdpt mmlt}
float=$1
double=$2
difference=$3
shift 3

# image PROGRAM INTEGRATOR SEED SCENE FILE: renders SCENE to FILE
image() {
    "$1" render --quiet --backend=cpu --integrator="$2" --max-depth="$DEPTH" --resolution="$RESOLUTION" \
        --samples="$SAMPLES" --seed="$3" --no-png --layers=none -o "$5" "$4" 2>/dev/null
}

head_print
printf '# setting\t%s seeds, %s samples a pixel each, %s pixels, %s segments\n' "$SEEDS" "$SAMPLES" "$RESOLUTION" "$DEPTH"
printf 'scene\tintegrator\tlargest difference\tstandard error\tbeyond noise\tpicture\tstandard error\tbetween seeds\n'
for scene in "$@"; do
    for integrator in $INTEGRATORS; do
        set --
        seed=0
        while [ "$seed" -lt "$SEEDS" ]; do
            image "$float" "$integrator" "$seed" "$scene" "$folder/f$seed.exr"
            image "$double" "$integrator" "$seed" "$scene" "$folder/d$seed.exr"
            set -- "$@" "$folder/f$seed.exr" "$folder/d$seed.exr"
            seed=$((seed + 1))
        done
        printf '%s\t%s\t%s\n' "$(scene_name "$scene")" "$integrator" "$("$difference" 8 "$@")"
    done
done
