# shellcheck shell=sh
# Shared by the scripts of `make bench`: a temporary folder, numbers from JSON files, medians, the header of a table.
# To be sourced by a script that lies in the source tree.

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT INT TERM

# number KEY FILE: the first number that follows "KEY": in a JSON file.
number() {
    sed -n "s/.*\"$1\": *\\([0-9.eE+-]*\\).*/\\1/p" "$2" | head -n 1
}

median() {
    sort -g | awk '{ v[NR] = $1 } END { print (NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2) }'
}

# scene_name PATH: folder and name of a scene file.
scene_name() {
    echo "$(basename "$(dirname "$1")")/$(basename "$1" .pbrt)"
}

# measured: the commit, the compiler and the machine, a line each.
measured() {
    printf 'commit\t%s\n' "$(git -C "$(dirname "$0")" describe --always --dirty 2>/dev/null || echo unknown)"
    printf 'compiler\t%s\n' "$("${CC:-cc}" --version | head -n 1)"
    printf 'cpu\t%s, %s cores\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)"
}

# head_print: the same, as comments of a table.
head_print() {
    measured | sed 's/^/# /'
}
