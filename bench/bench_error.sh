#!/bin/sh
# Speed against error of all integrators: one table on standard output (tab separated) and one plot.
#
# The error is the variance of a pixel: half the mean square difference of two images with different seeds, which needs
# no reference and has no floor; relative variance is half of relMSE between the two without its worst thousandth, so that
# a single bright dot does not decide. Efficiency is 1 / (relative variance x seconds), the median over the budgets; the
# time to equal error of two integrators has the inverse ratio. The plot says of what commit, compiler and machine it is.
# A scene takes 8 renderings of every budget: 112 s. INTEGRATORS: which. usage: bench_error.sh TWINLIGHT PLOT.svg SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

BUDGETS=${BUDGETS:-2 4 8}
DEPTH=${DEPTH:-10}
RESOLUTION=${RESOLUTION:-128x128}
INTEGRATORS=${INTEGRATORS:-pt ibpt bdpt mmlt}
twinlight=$1
plot=$2
shift 2

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

# One panel a scene, both axes logarithmic.
caption=$(measured | sed 's/\t/: /; s/&/\&amp;/g; s/</\&lt;/g; s/$/;/' | tr '\n' ' ')
awk -F'\t' -v integrators="$INTEGRATORS" -v caption="$caption$DEPTH segments, $RESOLUTION pixels" '
    { if (!($1 in panel)) { panel[$1] = ++panels; title[panels] = $1; low[panels] = high[panels] = log($6) / log(10) }
      p = panel[$1]; y = log($6) / log(10); n = ++rows; at[n] = p; who[n] = $2; xs[n] = log($3) / log(10); ys[n] = y
      if (y < low[p]) low[p] = y; if (y > high[p]) high[p] = y
      if (n == 1 || xs[n] < left) left = xs[n]; if (n == 1 || xs[n] > right) right = xs[n] }
    END {
        color["pt"] = "#888888"; color["ibpt"] = "#2a7fbf"; color["bdpt"] = "#c4541c"; color["mmlt"] = "#2c8a3d"
        printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"282\" font-family=\"sans-serif\" font-size=\"12\">\n", panels * 240 + 20
        print "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>"
        for (p = 1; p <= panels; ++p) {
            x0 = (p - 1) * 240 + 50
            printf "<text x=\"%d\" y=\"18\">%s</text><rect x=\"%d\" y=\"30\" width=\"180\" height=\"180\" fill=\"none\" stroke=\"#999999\"/>\n", x0, title[p], x0
            printf "<text x=\"%d\" y=\"226\">%.3g s</text><text x=\"%d\" y=\"226\" text-anchor=\"end\">%.3g s</text>\n", x0, 10 ^ left, x0 + 180, 10 ^ right
            printf "<text x=\"%d\" y=\"40\" text-anchor=\"end\">%.1e</text><text x=\"%d\" y=\"210\" text-anchor=\"end\">%.1e</text>\n", x0 - 4, 10 ^ high[p], x0 - 4, 10 ^ low[p]
        }
        for (n = 1; n <= rows; ++n) {
            p = at[n]; x = (p - 1) * 240 + 50 + 180 * (right > left ? (xs[n] - left) / (right - left) : 0.5)
            y = 30 + 180 * (high[p] > low[p] ? (high[p] - ys[n]) / (high[p] - low[p]) : 0.5)
            printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x, y, color[who[n]]
            if (n > 1 && at[n - 1] == p && who[n - 1] == who[n])
                printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", px, py, x, y, color[who[n]]
            px = x; py = y
        }
        all = split(integrators, names, " ")
        printf "<text x=\"50\" y=\"248\">relative variance against seconds:</text>\n"
        for (k = 1; k <= all; ++k)
            printf "<text x=\"%d\" y=\"248\" fill=\"%s\">%s</text>\n", 200 + k * 50, color[names[k]], names[k]
        printf "<text x=\"50\" y=\"270\" font-size=\"9\" fill=\"#666666\">%s</text>\n", caption
        print "</svg>"
    }' "$folder/table" >"$plot"
