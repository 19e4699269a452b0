#!/bin/sh
# Which scenes of folders can be rendered, and what the others need: a page in Markdown, by feature and by file, made of
# what `twinlight info --needs` says of every file with WorldBegin. Images and meshes need not be there.
set -u

if [ $# -lt 2 ]; then
    echo "usage: tests/coverage.sh PROGRAM FOLDER..." >&2
    exit 2
fi
program=$1
shift
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# needs FILE SHOWN: lines "SHOWN <tab> count <tab> status <tab> kind <tab> name" of a scene.
needs() {
    "$program" info --needs "$1" >"$work/out" 2>"$work/err"
    if [ -s "$work/out" ]; then
        awk -v file="$2" 'NR > 1 {
            name = substr($0, 45)
            sub(/  \(.*/, "", name)
            sub(/cannot read .*\//, "cannot read ", name)
            status = substr($0, 10, 13); kind = substr($0, 25, 18)
            sub(/ +$/, "", status); sub(/ +$/, "", kind)
            printf "%s\t%d\t%s\t%s\t%s\n", file, substr($0, 1, 7), status, kind, name
        }' "$work/out"
    else
        printf '%s\t1\terror\terror\t%s\n' "$2" "$(head -n 1 "$work/err" | sed 's/^.*error: //')"
    fi
}

for folder; do
    find "$folder" \( -name '*.pbrt' -o -name '*.pbrt.gz' \) -type f | LC_ALL=C sort >"$work/files"
    while IFS= read -r file; do
        gzip -cdf "$file" | grep -q '^[[:space:]]*WorldBegin' || continue
        needs "$file" "$(basename "$folder")/${file#"$folder"/}"
    done <"$work/files"
done >"$work/all"

files=$(cut -f 1 "$work/all" | uniq | wc -l)
lacking=$(awk -F '\t' '$3 == "not supported" || $3 == "error" { print $1 }' "$work/all" | uniq | wc -l)
echo "# What scenes need"
echo
echo "Made by \`tests/coverage.sh\`: $((files - lacking)) of $files files need nothing that is not supported."
echo
echo "## By feature"
echo
echo "| kind | name | files | uses | status |"
echo "|---|---|---|---|---|"
# The worst status of a feature in any file stands for all.
awk -F '\t' '
    BEGIN { rank["supported"] = 1; rank["approximated"] = 2; rank["not supported"] = 3; rank["error"] = 4 }
    {
        key = $4 " | " $5
        uses[key] += $2
        ++files[key]
        if (rank[$3] > rank[status[key]]) status[key] = $3
    }
    END { for (key in uses) printf "| %s | %d | %d | %s |\n", key, files[key], uses[key], status[key] }
' "$work/all" | LC_ALL=C sort
echo
echo "## By file"
echo
echo "| file | not supported |"
echo "|---|---|"
awk -F '\t' '
    !($1 in lacks) { order[++count] = $1; lacks[$1] = "" }
    $3 == "not supported" || $3 == "error" { lacks[$1] = lacks[$1] (lacks[$1] == "" ? "" : "; ") $4 " " $5 }
    END { for (i = 1; i <= count; ++i) printf "| %s | %s |\n", order[i], lacks[order[i]] }
' "$work/all"
