#!/bin/sh
# The OpenCL backend against the CPU's, one table on standard output (tab separated): samples/s with and without overlap
# of computing, copying and adding to the film, samples/s of the CPU, and rays per second inside ray queries of both,
# where the CPU's time is that of all threads divided by their number. Every figure is the median of RUNS runs.
# usage: bench_opencl.sh TWINLIGHT [SCENE...]; DEVICE: the device (default 0)
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

RUNS=${RUNS:-3}
SECONDS_EACH=${SECONDS_EACH:-5}
DEPTH=${DEPTH:-10}
DEVICE=${DEVICE:-0}
twinlight=$1
shift

# runs NAME SCENE OPTION...: renders RUNS times, statistics in $folder/NAME.N.json
runs() {
    runs_name=$1
    runs_scene=$2
    shift 2
    for run in $(seq "$RUNS"); do
        "$twinlight" render --quiet --integrator=pt --max-depth="$DEPTH" --time="${SECONDS_EACH}s" --seed="$run" \
            --no-png -o "$folder/out.exr" --stats="$folder/$runs_name.$run.json" "$@" "$runs_scene" 2>/dev/null
    done
}

# figure NAME: the median of samples/s
figure() {
    for file in "$folder/$1".*.json; do
        number samples_per_second "$file"
    done | median
}

# rays NAME THREADS: the median of rays per second inside ray queries
rays() {
    for file in "$folder/$1".*.json; do
        echo "$(number closest "$file") $(number shadow "$file") $(number seconds_all_threads "$file") $2"
    done | awk '{ print ($1 + $2) / ($3 / $4) }' | median
}

threads=$(nproc)
head_print
printf 'scene\tdevice\topencl samples/s\twithout overlap\tcpu samples/s\topencl/cpu\topencl rays/s\tcpu rays/s\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    # The kernels are built before anything is timed.
    "$twinlight" render --quiet --samples=1 --no-png --backend=opencl --device="$DEVICE" -o "$folder/out.exr" "$scene"
    runs opencl "$scene" --backend=opencl --device="$DEVICE"
    TWINLIGHT_OVERLAP=0
    export TWINLIGHT_OVERLAP
    runs turns "$scene" --backend=opencl --device="$DEVICE"
    unset TWINLIGHT_OVERLAP
    runs cpu "$scene" --backend=cpu
    device=$(sed -n 's/.*"device": "\(.*\)",/\1/p' "$folder/opencl.1.json")
    ratio=$(echo "$(figure opencl) $(figure cpu)" | awk '{ printf "%.2f", $1 / $2 }')
    printf '%s\t%s\t%.0f\t%.0f\t%.0f\t%s\t%.0f\t%.0f\n' "$name" "$device" "$(figure opencl)" "$(figure turns)" \
        "$(figure cpu)" "$ratio" "$(rays opencl 1)" "$(rays cpu "$threads")"
done
