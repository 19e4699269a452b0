#!/bin/sh
# Every command of README.md and docs/guide.md as it stands there, in order, in a folder with build/twinlight and scenes/,
# but with fewer samples, pixels and seconds.
set -u
# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

sources=$(cd "${scene%/*}/.." && pwd)
mkdir build
ln -s "$program" build/twinlight
ln -s "$sources/scenes" scenes
opencl=yes
"$program" devices --json | grep -q '"opencl": *\[\]' && opencl=

# shortened COMMAND: takes a moment.
shortened() {
    text=$(printf '%s\n' "$1" | sed 's/--time=[0-9a-z]*/--time=1s/; s/--times=[0-9a-z,]*/--times=0.3s/;
        s/--save-every=[0-9a-z]*/--save-every=1s/; s/--samples=[0-9]*/--samples=4/')
    case $text in
    *' bench '*)
        case $text in *--times=*) ;; *) text="$text --times=0.3s" ;; esac
        text="$text --runs=1 --resolution=16x12 --reference-time=0.3s"
        ;;
    *' pyramid '* | *--verify*) text="$text --resolution=16x12" ;;
    *' render '*)
        case $text in *--resolution=*) ;; *) text="$text --resolution=32x24" ;; esac
        case $text in *--time=* | *--samples=*) ;; *) text="$text --samples=2" ;; esac
        ;;
    esac
    printf '%s\n' "$text"
}

commands=0
for page in README.md docs/guide.md; do
    grep -E '^    (build/twinlight|cmp) ' "$sources/$page" | sed 's/ *# .*//' >"commands"
    while read -r command; do
        case $command in *opencl* | *--verify* | *--backend=all* | cmp*) [ "$opencl" ] || continue ;; esac
        sh -c "$(shortened "$command")" >out 2>err </dev/null
        result "$page: $command" $?
        commands=$((commands + 1))
    done <commands
done
[ $commands -ge 15 ]
result "only $commands commands were found" $?
checks_end
