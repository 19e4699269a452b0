#!/bin/sh
# The effect of sorting chains and of grouping their mutations (Frolov 2018, tables 1 to 3): mutations per second with
# neither, one or both, and with both when chains are sorted by depth alone; for the published scheme and for
# generations, on the CPU and on the first OpenCL device. Then acceptance rates by kind of mutation and depth.
# Tab-separated, on standard output.
# Rates are medians of RUNS rounds. Variants take turns within a round, so that other load on the machine affects all of
# them. A gain is the median of the gains of single rounds, with quartiles. Only the chains' time counts, not that of
# pools or direct light.
# usage: bench_mmlt.sh TWINLIGHT SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

RUNS=${RUNS:-7}
SECONDS_EACH=${SECONDS_EACH:-4}
DEPTH=${DEPTH:-10}
RESOLUTION=${RESOLUTION:-128x128}
CHAINS=${CHAINS:-32768}
twinlight=$1
shift

backends=cpu
if ! "$twinlight" devices --json | grep -q '"opencl": *\[\]'; then
    backends='cpu opencl'
fi
backends=${BACKENDS:-$backends}

# run NAME SCENE OPTION...: renders once, with statistics in $folder/NAME.$run.json
run() {
    run_name=$1
    run_scene=$2
    shift 2
    "$twinlight" render --quiet --integrator=mmlt --max-depth="$DEPTH" --resolution="$RESOLUTION" --seed="$run" \
        --time="${SECONDS_EACH}s" --mlt=chains="$CHAINS" --layers=none --no-png -o "$folder/out.exr" \
        --stats="$folder/$run_name.$run.json" "$@" "$run_scene" 2>/dev/null
}

# rates NAME: the chains' mutations per second, a line per round.
rates() {
    for rates_run in $(seq "$RUNS"); do
        rates_file=$folder/$1.$rates_run.json
        echo "$(number mutations "$rates_file") $(number chain_seconds "$rates_file")"
    done | awk '{ print $1 / $2 }'
}

# row: medians of the five variants, and the gains of the last four over the first.
row() {
    for row_name in neither sorted grouped both depth; do
        rates "$row_name" >"$folder/$row_name.rates"
        printf '\t%.0f' "$(median <"$folder/$row_name.rates")"
    done
    for row_name in sorted grouped both depth; do
        paste "$folder/neither.rates" "$folder/$row_name.rates" | awk '{ print 100 * ($2 / $1 - 1) }' | sort -g |
            awk '{ v[NR] = $1 }
                function at(q, place, low) { place = 1 + q * (NR - 1); low = int(place)
                    return low == NR ? v[NR] : v[low] + (place - low) * (v[low + 1] - v[low]) }
                END { printf "\t%+.0f %% (%+.0f ... %+.0f)", at(0.5), at(0.25), at(0.75) }'
    done
    echo
}

head_print
printf '# setting\t%s segments, %s pixels, %s chains at most, %s s a run, median of %s rounds\n' "$DEPTH" "$RESOLUTION" \
    "$CHAINS" "$SECONDS_EACH" "$RUNS"
printf 'scene\tbackend\tscheme\tneither\tsorted\tgrouped\tboth\tboth, by depth\t'
printf 'gain of sorting\tgain of grouping\tgain of both\tgain of both, by depth\n'
for scene in "$@"; do
    name=$(scene_name "$scene")
    for backend in $backends; do
        # Build the kernels before timing.
        "$twinlight" render --quiet --samples=1 --resolution=16x16 --layers=none --no-png --backend="$backend" \
            -o "$folder/out.exr" "$scene" 2>/dev/null
        for scheme in paper generations; do
            rm -f "$folder"/*.json
            for run in $(seq "$RUNS"); do
                mlt=--mlt=scheme=$scheme,combine=off # paper never combines
                run neither "$scene" --backend="$backend" "$mlt,sort=none,group=off"
                run sorted "$scene" --backend="$backend" "$mlt,group=off"
                run grouped "$scene" --backend="$backend" "$mlt,sort=none"
                run both "$scene" --backend="$backend" "$mlt"
                run depth "$scene" --backend="$backend" "$mlt,sort=depth"
            done
            printf '%s\t%s\t%s' "$name" "$backend" "$scheme"
            row
            # Acceptance rates of the first run with both, from its statistics: kind, depth, fraction.
            [ "$backend" = opencl ] || awk -v head="$name	$scheme" '
                /"acceptance"/ { found = 1; next }
                found && /\{/ { gsub(/[":{ ]/, ""); kind = $0; next }
                found && /"[0-9]+":/ { gsub(/[",]/, ""); split($0, part, ":"); gsub(/ /, "", part[1])
                    printf "%s\t%s\t%s\t%.3f\n", head, kind, part[1], part[2]; next }
                found && /\}/ { if (kind == "") exit; kind = "" }' "$folder/both.1.json" >>"$folder/acceptance"
        done
    done
done
[ -f "$folder/acceptance" ] || exit 0
printf '\nscene\tscheme\tmutation\tdepth\taccepted\n'
cat "$folder/acceptance"
