#!/bin/sh
# MMLT against the best of the other integrators at the sizes of real pictures: tables on standard output (tab-separated).
#
# For each of SIZES the table of bench_error.sh, which says what the columns mean, and then for every scene and budget: the
# error of mmlt over the least of the others, of pixels without the worst thousandth and of tiles of 8 x 8 pixels, and which
# integrators those are. BUDGETS: seconds, ascending. A scene takes 8 times the last of them per size: 80 minutes in all.
# usage: bench_real.sh TWINLIGHT SCENE...
set -eu

SIZES=${SIZES:-640x360 1280x720}
export BUDGETS="${BUDGETS:-10 60 300}"
table=$(mktemp)
trap 'rm -f "$table"' EXIT

for size in $SIZES; do
    RESOLUTION=$size "$(dirname "$0")/bench_error.sh" "$@" | tee "$table"
    grep -q 'median efficiency' "$table" || exit 1 # it has failed, and said why
    printf '\nscene\tsize\tbudget\tpixels: mmlt over the best\tbest\t8 x 8: mmlt over the best\tbest\n'
    awk -F'\t' -v size="$size" -v budgets="$BUDGETS" '
        BEGIN { count = split(budgets, budget, " ") }
        $1 ~ /^#/ || NF < 11 || $1 == "scene" { next }
        {
            row = $1 SUBSEP (++rows[$1, $2])
            if (!($1 in known)) { known[$1] = 1; order[++scenes] = $1 }
            if ($2 == "mmlt") { own[row] = $6; own_tiles[row] = $8; next }
            if (!(row in least) || $6 < least[row]) { least[row] = $6; name[row] = $2 }
            if (!(row in tiles) || $8 < tiles[row]) { tiles[row] = $8; name_tiles[row] = $2 }
        }
        END {
            for (s = 1; s <= scenes; ++s) for (b = 1; b <= count; ++b) {
                row = order[s] SUBSEP b
                printf "%s\t%s\t%s\t%.2f\t%s\t%.2f\t%s\n", order[s], size, budget[b], own[row] / least[row], name[row],
                    own_tiles[row] / tiles[row], name_tiles[row]
            }
        }' "$table"
    echo
done
