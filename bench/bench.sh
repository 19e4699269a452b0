# shellcheck shell=sh
# What the scripts of `make bench` share: a folder of their own, figures from JSON files, medians, the head of a table.
# Sourced; the sourcing script's $0 lies in the folder of the sources.

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT INT TERM

# number KEY FILE: the first number behind "KEY": in a JSON file.
number() {
    sed -n "s/.*\"$1\": *\\([0-9.eE+-]*\\).*/\\1/p" "$2" | head -n 1
}

median() {
    sort -g | awk '{ v[NR] = $1 } END { print (NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2) }'
}

# scene_name PATH: its folder and name.
scene_name() {
    echo "$(basename "$(dirname "$1")")/$(basename "$1" .pbrt)"
}

# what was measured: one line each of the commit, the compiler and the machine.
measured() {
    printf 'commit\t%s\n' "$(git -C "$(dirname "$0")" describe --always --dirty 2>/dev/null || echo unknown)"
    printf 'compiler\t%s\n' "$("${CC:-cc}" --version | head -n 1)"
    printf 'cpu\t%s, %s cores\n' "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)"
}

# head_print: the same as comments.
head_print() {
    measured | sed 's/^/# /'
}
