#!/bin/sh
# Speed against error of all integrators without a reference: one table on standard output (tab separated).
#
# The error is the variance of a pixel: half the mean square difference of two images with different seeds, which needs
# no reference and has no floor; relative variance is half of relMSE between the two without its worst thousandth, so that
# a single bright dot does not decide. Efficiency is 1 / (relative variance x seconds), the median over the budgets; the
# time to equal error of two integrators has the inverse ratio. `twinlight bench` measures against a reference, which takes
# longer, and sees what all seeds miss; it draws, too.
# A scene takes 8 renderings of every budget: 112 s. INTEGRATORS: which. usage: bench_error.sh TWINLIGHT SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

BUDGETS=${BUDGETS:-2 4 8}
DEPTH=${DEPTH:-10}
RESOLUTION=${RESOLUTION:-128x128}
INTEGRATORS=${INTEGRATORS:-pt ibpt bdpt mmlt}
twinlight=$1
shift

# image INTEGRATOR SECONDS SEED SCENE
image() {
    "$twinlight" render --quiet --integrator="$1" --max-depth="$DEPTH" --resolution="$RESOLUTION" --time="$2s" \
        --seed="$3" --no-png -o "$folder/$3.exr" --stats="$folder/$3.json" "$4" 2>/dev/null
}

# variance INTEGRATOR SECONDS SCENE: "seconds samples/s variance relative-variance"
variance() {
    image "$1" "$2" 1 "$3"
    image "$1" "$2" 2 "$3"
    "$twinlight" compare --json "$folder/1.exr" "$folder/2.exr" >"$folder/compare.json"
    awk "BEGIN { printf \"%.3f\\t%.0f\\t%.6g\\t%.6g\\n\", \
        ($(number render "$folder/1.json") + $(number render "$folder/2.json")) / 2, \
        ($(number samples_per_second "$folder/1.json") + $(number samples_per_second "$folder/2.json")) / 2, \
        $(number mse "$folder/compare.json") / 2, $(number rel_mse_trimmed "$folder/compare.json") / 2 }"
}

head_print
printf '# setting\t%s segments, %s pixels\n' "$DEPTH" "$RESOLUTION"
printf 'scene\tintegrator\tseconds\tsamples/s\tvariance\trelative variance\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    for integrator in $INTEGRATORS; do
        for seconds in $BUDGETS; do
            printf '%s\t%s\t%s\n' "$name" "$integrator" "$(variance "$integrator" "$seconds" "$scene")"
        done
    done
done | tee "$folder/table"

echo
printf 'scene\tintegrator\tmedian efficiency\ttimes as efficient as the first\n'
awk -F'\t' -v integrators="$INTEGRATORS" '
    { n = ++count[$1, $2]; value[$1, $2, n] = 1 / ($3 * $6); if (!($1 in seen)) { seen[$1] = 1; order[++scenes] = $1 } }
    function median(s, i,   n, a, b, k, t) {
        n = count[s, i]
        for (a = 1; a <= n; ++a) v[a] = value[s, i, a]
        for (a = 2; a <= n; ++a) for (b = a; b > 1 && v[b] < v[b - 1]; --b) { t = v[b]; v[b] = v[b - 1]; v[b - 1] = t }
        return n % 2 ? v[(n + 1) / 2] : (v[n / 2] + v[n / 2 + 1]) / 2
    }
    END {
        all = split(integrators, names, " ")
        for (s = 1; s <= scenes; ++s) for (k = 1; k <= all; ++k)
            printf "%s\t%s\t%.4g\t%.2f\n", order[s], names[k], median(order[s], names[k]),
                median(order[s], names[k]) / median(order[s], names[1])
    }' "$folder/table"
