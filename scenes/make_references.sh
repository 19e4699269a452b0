#!/bin/sh
# Makes the pictures that the scenes' renderings are compared with: the mean of two renderings with different seeds, by an
# integrator without Markov chains, at 128 x 128 pixels and up to 10 segments, as half floats. Prints how far the mean is
# from the truth, by how far its halves are apart. All of them take about two hours of processor time.
# usage: make_references.sh TWINLIGHT AVERAGE_IMAGES FOLDER [SCENE...], SCENE: cornell, door ...; default: all
set -eu
twinlight=$1
average=$2
folder=$3
shift 3
scenes=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder"

# reference SCENE INTEGRATOR SAMPLES, the samples of one half.
reference() {
    for seed in 1001 1002; do
        "$twinlight" render --quiet --integrator="$2" --samples="$3" --max-depth=10 --resolution=128x128 --seed=$seed \
            --no-png -o "$work/$seed.exr" "$scenes/$1.pbrt"
    done
    "$average" "$folder/$1.exr" "$work/1001.exr" "$work/1002.exr"
}

[ $# -gt 0 ] || set -- cornell door glossy lamp pool relief windows
for name in "$@"; do
    case $name in
        cornell) reference cornell pt 2048 ;;
        door) reference door bdpt 3584 ;;
        glossy) reference glossy bdpt 2560 ;;
        lamp) reference lamp bdpt 4480 ;;
        pool) reference pool pt 51200 ;;
        relief) reference relief bdpt 320 ;;
        windows) reference windows ibpt 640 ;;
        *)
            echo "make_references.sh: no scene $name" >&2
            exit 2
            ;;
    esac
done
