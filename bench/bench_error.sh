#!/bin/sh
# Error against time of all integrators: one table on standard output (tab-separated).
#
# variance, relative variance: per pixel, from two images with different seeds, which needs no reference and has no
#   floor. Variance is half their mean squared difference. Relative variance is half the relMSE of one against the other
#   without the worst thousandth of the pixels, so that a single firefly does not decide; with the worst is the same
#   with all pixels. relMSE divides by the square of one of the images, which exaggerates where they are noisy.
# 8 x 8: half the relMSE of the means of tiles of 8 x 8 pixels, no tile left out.
# to the reference, with the worst, 8 x 8: the same errors against reference/NAME.exr beside the scene, mean of the two
#   images; with REFERENCE_SECONDS, against an image that mmlt renders first, with another seed. Minus signs if there is
#   no reference of this size. Includes the reference's own error.
# Efficiency is 1 / (relative variance x seconds), median over the budgets; the times to equal error of two integrators
# have the inverse ratio. `twinlight bench` always measures against a reference: it takes longer, draws charts, and sees
# light that all seeds miss.
# Each integrator renders twice for the last of BUDGETS (ascending); the other budgets use what it had saved by then. A
# scene takes 8 times the last budget: 64 s. INTEGRATORS selects integrators.
# usage: bench_error.sh TWINLIGHT SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

BUDGETS=${BUDGETS:-2 4 8}
DEPTH=${DEPTH:-10}
RESOLUTION=${RESOLUTION:-128x128}
INTEGRATORS=${INTEGRATORS:-pt ibpt bdpt mmlt}
REFERENCE_SECONDS=${REFERENCE_SECONDS:-}
twinlight=$1
shift

# saved_at FILE: when it was written, in seconds with decimals.
saved_at() {
    date -r "$1" +%s.%N
}

render_failed() {
    cat "$folder/err" >&2
    exit 1
}

# images INTEGRATOR SEED SCENE: for all budgets SEED.BUDGET.exr and SEED.BUDGET.time, the seconds until it was saved.
images() {
    last=${BUDGETS##* }
    out=$folder/$2.exr
    rm -f "$out"
    every=1s # writing takes time, too
    [ "$BUDGETS" != "$last" ] || every=24h
    begin=$(date +%s.%N)
    "$twinlight" render --quiet --integrator="$1" --max-depth="$DEPTH" --resolution="$RESOLUTION" --time="${last}s" \
        --save-every=$every --seed="$2" --no-png -o "$out" --stats="$folder/$2.json" "$3" 2>"$folder/err" &
    process=$!
    for budget in $BUDGETS; do
        if [ "$budget" = "$last" ]; then
            wait "$process" || render_failed # it may have ended a little before the limit
        else
            until [ -s "$out" ] && awk "BEGIN { exit !($(saved_at "$out") >= $begin + $budget) }"; do
                kill -0 "$process" 2>/dev/null || wait "$process" || render_failed
                sleep 0.1
            done
        fi
        cp -p "$out" "$folder/$2.$budget.exr" # take the time of the copy: the next image may replace $out at any moment
        awk "BEGIN { print $(saved_at "$folder/$2.$budget.exr") - $begin }" >"$folder/$2.$budget.time"
    done
}

# reference_make SCENE: sets $reference.
reference_make() {
    reference=$(dirname "$1")/reference/$(basename "$1" .pbrt).exr
    [ -n "$REFERENCE_SECONDS" ] || return 0
    reference=$folder/reference.exr
    "$twinlight" render --quiet --max-depth="$DEPTH" --resolution="$RESOLUTION" --time="${REFERENCE_SECONDS}s" --seed=9 \
        --no-png -o "$reference" "$1" 2>"$folder/err" || render_failed
}

# mean_number KEY FILE FILE
mean_number() {
    awk "BEGIN { printf \"%.6g\", ($(number "$1" "$2") + $(number "$1" "$3")) / 2 }"
}

# to_reference BUDGET: the three errors to $reference, means of both images.
to_reference() {
    for seed in 1 2; do
        if ! [ -f "$reference" ] ||
            ! "$twinlight" compare --json "$folder/$seed.$1.exr" "$reference" >"$folder/reference.$seed.json" 2>"$folder/err"; then
            printf -- '-\t-\t-'
            return
        fi
    done
    for key in rel_mse_trimmed rel_mse rel_mse_8x8; do
        [ $key = rel_mse_trimmed ] || printf '\t'
        mean_number $key "$folder/reference.1.json" "$folder/reference.2.json"
    done
}

# variances INTEGRATOR SCENE: per budget a line "seconds samples/s variance relative-variance with-the-worst 8x8",
# continued by to_reference.
variances() {
    images "$1" 1 "$2"
    images "$1" 2 "$2"
    for budget in $BUDGETS; do
        "$twinlight" compare --json "$folder/1.$budget.exr" "$folder/2.$budget.exr" >"$folder/compare.json"
        awk "BEGIN { printf \"%.3f\t%.0f\t%.6g\t%.6g\t%.6g\t%.6g\t\", \
            ($(cat "$folder/1.$budget.time") + $(cat "$folder/2.$budget.time")) / 2, \
            ($(number samples_per_second "$folder/1.json") + $(number samples_per_second "$folder/2.json")) / 2, \
            $(number mse "$folder/compare.json") / 2, $(number rel_mse_trimmed "$folder/compare.json") / 2, \
            $(number rel_mse "$folder/compare.json") / 2, $(number rel_mse_8x8 "$folder/compare.json") / 2 }"
        to_reference "$budget"
        echo
    done
}

head_print
printf '# setting\t%s segments, %s pixels\n' "$DEPTH" "$RESOLUTION"
[ -z "$REFERENCE_SECONDS" ] || printf '# reference\tmmlt, %s seconds\n' "$REFERENCE_SECONDS"
printf 'scene\tintegrator\tseconds\tsamples/s\tvariance\trelative variance\twith the worst\t8 x 8\t'
printf 'to the reference\twith the worst\t8 x 8\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    reference_make "$scene"
    for integrator in $INTEGRATORS; do
        variances "$integrator" "$scene" | awk -v head="$name\t$integrator\t" '{ print head $0 }'
    done
done | tee "$folder/table"
# A part of a pipeline that fails does not end the script.
# shellcheck disable=SC2086
rows=$(($# * $(echo $INTEGRATORS | wc -w) * $(echo $BUDGETS | wc -w)))
if [ "$(wc -l <"$folder/table")" -ne $rows ]; then
    echo "$0: $rows rows wanted" >&2
    exit 1
fi

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
