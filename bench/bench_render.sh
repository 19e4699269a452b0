#!/bin/sh
# Path tracing speed, one table on standard output (tab-separated): samples/s, rays/s and the fraction of time within
# ray queries for each scene, scaling from one thread to all, and the loading time of a million triangles. Figures are
# medians of RUNS runs. usage: bench_render.sh TWINLIGHT MAKE_PLY [SCENE...]
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

RUNS=${RUNS:-3}
SECONDS_EACH=${SECONDS_EACH:-5}
DEPTH=${DEPTH:-10}
twinlight=$1
make_ply=$2
shift 2
cores=$(nproc)

# runs SCENE THREADS: renders RUNS times, with statistics in $folder/run.N.json
runs() {
    run=1
    while [ "$run" -le "$RUNS" ]; do
        "$twinlight" render --quiet --integrator=pt --max-depth="$DEPTH" --time="${SECONDS_EACH}s" --threads="$2" \
            --seed="$run" --no-png -o "$folder/out.exr" --stats="$folder/run.$run.json" "$1" 2>/dev/null
        run=$((run + 1))
    done
}

# figure KEY: the median of a key over the runs
figure() {
    for file in "$folder"/run.*.json; do
        number "$1" "$file"
    done | median
}

head_print
printf '# setting\t%s segments, %s s a run, median of %s runs\n' "$DEPTH" "$SECONDS_EACH" "$RUNS"
printf 'scene\tthreads\tsamples/s\trays/s\tray share\tscaling per core\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    runs "$scene" 1
    single=$(figure samples_per_second)
    for threads in 1 "$cores"; do
        [ "$threads" = 1 ] || runs "$scene" "$threads"
        samples=$(figure samples_per_second)
        rays=$(figure per_second)
        ray_seconds=$(figure seconds_all_threads)
        render_seconds=$(figure render)
        printf '%s\t%s\t%.0f\t%.0f\t%s\t%s\n' "$name" "$threads" "$samples" "$rays" \
            "$(awk "BEGIN { printf \"%.3f\", $ray_seconds / ($render_seconds * $threads) }")" \
            "$(awk "BEGIN { printf \"%.3f\", $samples / ($single * $threads) }")"
    done
done

"$make_ply" "$folder/million.ply"
cat >"$folder/million.pbrt" <<TXT
LookAt 0.5 0.5 2  0.5 0.5 0  0 1 0
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Shape "plymesh" "string filename" "million.ply"
TXT
run=1
while [ "$run" -le "$RUNS" ]; do
    "$twinlight" render --quiet --integrator=pt --samples=1 --no-png -o "$folder/out.exr" --stats="$folder/run.$run.json" \
        "$folder/million.pbrt" 2>/dev/null
    run=$((run + 1))
done
printf 'million triangles\tload seconds\t%.3f\n' "$(figure load)"
printf 'million triangles\tbuild seconds\t%.3f\n' "$(figure build)"
