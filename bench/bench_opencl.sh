#!/bin/sh
# The OpenCL backend against the CPU backend, one table on standard output (tab-separated): samples/s with and without
# overlap of computing, copying and adding to the film; samples/s if the device adds to the film itself (--film=device);
# samples/s of the CPU; and rays per second within ray queries of both, where the CPU's time is that of all threads
# divided by their number. Figures are medians of RUNS runs; variants take turns, so that other load on the machine
# affects all of them. usage: bench_opencl.sh TWINLIGHT [SCENE...]; DEVICE: the device (default 0)
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

RUNS=${RUNS:-3}
SECONDS_EACH=${SECONDS_EACH:-5}
DEPTH=${DEPTH:-10}
DEVICE=${DEVICE:-0}
twinlight=$1
shift

# run NAME SCENE OPTION...: renders once, with statistics in $folder/NAME.$run.json
run() {
    run_name=$1
    run_scene=$2
    shift 2
    "$twinlight" render --quiet --integrator=pt --max-depth="$DEPTH" --time="${SECONDS_EACH}s" --seed="$run" \
        --no-png -o "$folder/out.exr" --stats="$folder/$run_name.$run.json" "$@" "$run_scene" 2>/dev/null
}

# figure NAME: the median of samples/s
figure() {
    for file in "$folder/$1".*.json; do
        number samples_per_second "$file"
    done | median
}

# rays NAME THREADS: the median of rays per second within ray queries
rays() {
    for file in "$folder/$1".*.json; do
        echo "$(number closest "$file") $(number shadow "$file") $(number seconds_all_threads "$file") $2"
    done | awk '{ print ($1 + $2) / ($3 / $4) }' | median
}

threads=$(nproc)
head_print
# The driver's version string, of the device that is measured.
driver=$("$twinlight" devices --json | awk -F'": ' -v device="$DEVICE" '
    /^  "/ { opencl = /"opencl"/ }
    /"index"/ { found = $2 + 0 "" == device }
    /"name"/ { found = found || index(tolower($2), tolower(device)) }
    /"version"/ && opencl && found { gsub(/^"|",$/, "", $2); print $2; exit }')
printf '# driver\t%s\n' "$driver"
printf 'scene\tdevice\topencl samples/s\twithout overlap\tfilm on device\tcpu samples/s\topencl/cpu\topencl rays/s\t'
printf 'cpu rays/s\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    # Build the kernels before timing.
    "$twinlight" render --quiet --integrator=pt --samples=1 --no-png --backend=opencl --device="$DEVICE" -o "$folder/out.exr" "$scene"
    for run in $(seq "$RUNS"); do
        run opencl "$scene" --backend=opencl --device="$DEVICE"
        TWINLIGHT_OVERLAP=0
        export TWINLIGHT_OVERLAP
        run turns "$scene" --backend=opencl --device="$DEVICE"
        unset TWINLIGHT_OVERLAP
        # Fails on a device without 64-bit atomics.
        run film "$scene" --backend=opencl --device="$DEVICE" --film=device || rm -f "$folder"/film.*.json
        run cpu "$scene" --backend=cpu
    done
    device=$(sed -n 's/.*"device": "\(.*\)",/\1/p' "$folder/opencl.1.json")
    ratio=$(echo "$(figure opencl) $(figure cpu)" | awk '{ printf "%.2f", $1 / $2 }')
    film=-
    [ ! -f "$folder/film.1.json" ] || film=$(figure film | awk '{ printf "%.0f", $1 }')
    printf '%s\t%s\t%.0f\t%.0f\t%s\t%.0f\t%s\t%.0f\t%.0f\n' "$name" "$device" "$(figure opencl)" \
        "$(figure turns)" "$film" "$(figure cpu)" "$ratio" "$(rays opencl 1)" "$(rays cpu "$threads")"
done
