#!/bin/sh
# What each constant and each mechanism of MMLT is worth: the error of programs that have one of them changed
# (bench/ablation.txt), over that of the program as it is. Equal work (--samples), so that the load of the machine does
# not matter. Tab-separated, on standard output.
#
# A row per variant, scene and seed: relMSE without and with the worst thousandth of the pixels; the mean relative
# difference of the means of BLOCKS x BLOCKS blocks; and each over that of the baseline with the same seed. Then the
# summary of ablation_summary.awk.
#
# References are REFERENCES/FOLDER-NAME.exr (scene_name with a -), rendered with seed 1000 and REFERENCE_SAMPLES by the
# baseline if there are none; they add their own error, about SAMPLES / REFERENCE_SAMPLES of the baseline's, to all.
# A variant that changes nothing in its file, or whose program does not build, is an error. VARIANTS selects variants;
# WORK keeps the scratch tree for a next run.
# usage: bench_ablation.sh LIST SCENE...
set -eu
# shellcheck source=bench/bench.sh
. "$(dirname "$0")/bench.sh"

SAMPLES=${SAMPLES:-8}
REFERENCE_SAMPLES=${REFERENCE_SAMPLES:-256}
SEEDS=${SEEDS:-1 2 3 4 5}
RESOLUTION=${RESOLUTION:-640x360}
DEPTH=${DEPTH:-10}
BLOCKS=${BLOCKS:-64}
THREADS=${THREADS:-2}
WORK=${WORK:-$folder/work}
REFERENCES=${REFERENCES:-$folder/references}
source=$(cd "$(dirname "$0")/.." && pwd)
list=$1
shift
VARIANTS=${VARIANTS:-$(awk -F'\t' '/^[^#]/ && !seen[$1]++ { print $1 }' "$list")}
tab=$(printf '\t')

# tree_make: the scratch tree and its build. Files get new times, for one there may be of another variant.
tree_make() {
    mkdir -p "$WORK/source" "$REFERENCES"
    (cd "$source" && tar -cf - --exclude=./.git --exclude=./build .) | tar -xmf - -C "$WORK/source"
    mkdir -p "$WORK/source/build"
    [ -f "$WORK/source/build/Makefile" ] ||
        (cd "$WORK/source/build" && ../configure -q CC="${CC:-gcc}")
}

# edits NAME: lines "file<TAB>expression" of a variant.
edits() {
    awk -F'\t' -v name="$1" '
        /^[^#]/ { line[++count] = $0; key[count] = $1 }
        function show(wanted, i, part, parts, k) {
            for (i = 1; i <= count; ++i) {
                if (key[i] != wanted) continue
                found = 1
                split(line[i], part, "\t")
                if (part[2] != "+") { print part[2] "\t" part[3]; continue }
                parts = split(part[3], names, " ")
                for (k = 1; k <= parts; ++k) several[k] = names[k]
            }
            return parts
        }
        END {
            parts = show(name)
            for (k = 1; k <= parts; ++k) show(several[k])
            exit !found
        }' "$list"
}

# variant_build NAME: edits copies of the files, and installs those that differ from the scratch tree's, so that make
# compiles only what is affected. Files of the variant before become what they were.
variant_build() {
    rm -rf "$folder/edited"
    mkdir "$folder/edited"
    if [ "$1" != baseline ]; then
        edits "$1" >"$folder/edits" || {
            echo "$0: no variant $1 in $list" >&2
            exit 1
        }
        while IFS=$tab read -r file expression; do
            mkdir -p "$(dirname "$folder/edited/$file")"
            [ -f "$folder/edited/$file" ] || cp "$source/$file" "$folder/edited/$file"
            sed "$expression" "$folder/edited/$file" >"$folder/after"
            if cmp -s "$folder/after" "$folder/edited/$file"; then
                echo "$0: variant $1 changes nothing in $file" >&2
                exit 1
            fi
            cp "$folder/after" "$folder/edited/$file"
        done <"$folder/edits"
    fi
    awk -F'\t' '/^[^#]/ && $2 != "+" && !seen[$2]++ { print $2 }' "$list" >"$folder/files"
    while read -r file; do
        edited=$folder/edited/$file
        [ -f "$edited" ] || edited=$source/$file
        cmp -s "$edited" "$WORK/source/$file" || cp "$edited" "$WORK/source/$file"
    done <"$folder/files"
    make -s -C "$WORK/source/build" twinlight >"$folder/log" 2>&1 || {
        cat "$folder/log" >&2
        echo "$0: variant $1 does not build" >&2
        exit 1
    }
}

# image SEED SAMPLES SCENE FILE
image() {
    "$WORK/source/build/twinlight" render --quiet --backend=cpu --threads="$THREADS" --integrator=mmlt --max-depth="$DEPTH" \
        --resolution="$RESOLUTION" --samples="$2" --seed="$1" --no-png --layers=none -o "$4" "$3" 2>"$folder/err" || {
        cat "$folder/err" >&2
        exit 1
    }
}

# errors SEED SCENE: "trimmed all blocks"
errors() {
    image "$1" "$SAMPLES" "$2" "$folder/image.exr"
    "$WORK/source/build/twinlight" compare --json --blocks="$BLOCKS" "$folder/image.exr" \
        "$REFERENCES/$(scene_name "$2" | tr / -).exr" >"$folder/compare.json"
    printf '%s\t%s\t%s\n' "$(number rel_mse_trimmed "$folder/compare.json")" "$(number rel_mse "$folder/compare.json")" \
        "$(number block_mean "$folder/compare.json")"
}

tree_make
head_print
printf '# setting\t%s samples a pixel, %s pixels, %s segments; references of %s samples a pixel; %s x %s blocks\n' \
    "$SAMPLES" "$RESOLUTION" "$DEPTH" "$REFERENCE_SAMPLES" "$BLOCKS" "$BLOCKS"
variant_build baseline
for scene in "$@"; do
    reference=$REFERENCES/$(scene_name "$scene" | tr / -).exr
    if ! [ -f "$reference" ]; then
        image 1000 "$REFERENCE_SAMPLES" "$scene" "$folder/reference.exr"
        mv "$folder/reference.exr" "$reference"
    fi
done
printf 'variant\tscene\tseed\ttrimmed\tall pixels\tblocks\ttrimmed ratio\tratio of all\tratio of blocks\n'
for variant in baseline $VARIANTS; do
    variant_build "$variant"
    for scene in "$@"; do
        for seed in $SEEDS; do
            printf '%s\t%s\t%s\t%s\n' "$variant" "$(scene_name "$scene")" "$seed" "$(errors "$seed" "$scene")"
        done
    done
done | awk -F'\t' -v OFS='\t' '
    $1 == "baseline" { for (k = 4; k <= 6; ++k) base[$2, $3, k] = $k }
    { print $0, $4 / base[$2, $3, 4], $5 / base[$2, $3, 5], $6 / base[$2, $3, 6]; fflush() }' | tee "$folder/table"

echo
awk -f "$source/bench/ablation_summary.awk" "$folder/table"
