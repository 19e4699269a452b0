#!/bin/sh
# Several ranks under mpirun against one process, on this machine, and a model of many nodes. Two tables on standard output
# (tab-separated).
#
# Measured: samples/s of a process with two threads and of two ranks with one thread each, medians of RUNS runs that take
# turns, so that other load on the machine affects both; their ratio, of the medians; what two ranks exchange: passes, MB
# of all ranks together and milliseconds in a pass, medians; seconds in which a process computes passes, and all others.
#
# Model: an exchange of n nodes takes X(n) = X(2) + 2 F / B + n M: X(2) as measured, F the bytes of a pass, B the network's
# bytes per second (a reduction in which every node sends and receives about twice the film), M = 10 microseconds for rank
# 0's command and report of each node.
#   pt     passes last P = 20 X, at least 0.25 s, at most 4 s; efficiency P / (P + X) on nodes of any speed
#   mmlt   a generation of full size (524288 chains of 64 steps of 1.2 samples, as much again for pool and paths, W = 80.5
#          million samples) has three passes, and 126 MB of chains go out and back over rank 0's link: T(n) = H + W / (s r n) +
#          3 X(n) + 2 * 126 MB / B, H the seconds outside passes, r the samples per second within, both as measured, s = 1 and
#          32: nodes like this machine and 32 times as fast (64 cores). Efficiency (H + W / (s r)) / n / T(n).
# Not in it: nodes that are slower now and then, for which all others wait.
#
# usage: bench_mpi.sh TWINLIGHT SCENE
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

RUNS=${RUNS:-3}
twinlight=$1
scene=$2
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# run FILE INTEGRATOR SIZE SAMPLES COMMAND...: renders once.
run() {
    run_file=$1
    run_integrator=$2
    run_size=$3
    run_samples=$4
    shift 4
    "$@" render --quiet --integrator="$run_integrator" --resolution="$run_size" --samples="$run_samples" --no-png \
        -o "$folder/out.exr" --stats="$run_file" "${threads}" "$scene" 2>/dev/null
}

# medians KEY NAME: of a number in the statistics.
medians() {
    for file in "$folder/$2".*.json; do
        number "$1" "$file"
    done | median
}

# seconds WHICH NAME: the medians of seconds of rendering, in passes or outside.
seconds() {
    for file in "$folder/$2".*.json; do
        all=$(number render "$file")
        passes="$(number pool_seconds "$file") $(number chain_seconds "$file") $(number direct_seconds "$file")"
        echo "$1 $all $passes"
    done | awk '{ passes = NF > 2 ? $3 + $4 + $5 : $2; print $1 == "passes" ? passes : $2 - passes }' | median
}

head_print
echo "# $RUNS runs each, $(scene_name "$scene")"
printf 'integrator\tsize\tsamples/s, 1 process\tsamples/s, 2 ranks\tratio\tpasses\tMB a pass\tms a pass\tseconds in passes\tothers\n'
: >"$folder/measured"
for row in 'pt 640x360 32' 'mmlt 640x360 16' 'pt 1920x1080 8' 'mmlt 1920x1080 8'; do
    # shellcheck disable=SC2086 # words
    set -- $row
    for run in $(seq "$RUNS"); do
        threads=--threads=2
        run "$folder/single-$1-$2.$run.json" "$@" "$twinlight"
        threads=--threads=1
        run "$folder/ranks-$1-$2.$run.json" "$@" mpirun --oversubscribe -n 2 "$twinlight"
    done
    echo "$1 $2 $(medians samples_per_second "single-$1-$2") $(medians samples_per_second "ranks-$1-$2")" \
        "$(medians passes "ranks-$1-$2") $(medians exchanged_bytes "ranks-$1-$2") $(medians exchange_seconds "ranks-$1-$2")" \
        "$(seconds passes "single-$1-$2") $(seconds others "single-$1-$2") $(medians samples "single-$1-$2")" >>"$folder/measured"
done
awk '{ printf "%s\t%s\t%.4g\t%.4g\t%.3f\t%d\t%.4g\t%.3g\t%.3g\t%.3g\n", $1, $2, $3, $4, $4 / $3, $5, 1e-6 * $6 / $5, 1e3 * $7 / $5, $8, $9 }' \
    "$folder/measured"

printf '\n# model\nintegrator\tsize\tGb/s\tspeed of a node\tnodes\tms an exchange\tefficiency\n'
awk '
    {
        split("10 100", nets, " ")
        split("1 32", speeds, " ")
        split("2 8 64 1000", counts, " ")
        for (k = 1; k <= 2; ++k)
            for (j = 1; j <= ($1 == "mmlt" ? 2 : 1); ++j)
                for (i = 1; i <= 4; ++i) {
                    n = counts[i]
                    bytes = nets[k] * 1e9 / 8
                    x = $7 / $5 + 2 * $6 / $5 / bytes + n * 1e-5
                    pass = 20 * x < 0.25 ? 0.25 : 20 * x > 4 ? 4 : 20 * x
                    efficiency = pass / (pass + x)
                    if ($1 == "mmlt") {
                        compute = 80.5e6 / ($10 / $8) / speeds[j]
                        host = $9 / ($5 / 3)
                        efficiency = (host + compute) / n / (host + compute / n + 3 * x + 2 * 126e6 / bytes)
                    }
                    printf "%s\t%s\t%d\t%s\t%d\t%.3g\t%.3f\n", $1, $2, nets[k], $1 == "mmlt" ? speeds[j] : "any", n, 1e3 * x, efficiency
                }
    }' "$folder/measured"
