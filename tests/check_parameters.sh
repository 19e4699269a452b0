#!/bin/sh
# Checks that no function of the program takes more than 7 parameters, prototypes and static functions included. Kernels may:
# the buffers are their parameters. LARGE names the functions that have more nevertheless, for a library that calls them: a name
# in it that has 7 or fewer is a fault, too.
srcdir=${srcdir:-$(dirname "$0")/..}

LARGE=request_answer

# Prints "file:line: name has N parameters" for every function of more than 7. A declaration begins in the first column
# and its list of parameters ends before a `{` or `;`. Commas within inner parentheses, those of function pointers,
# separate no parameters.
# shellcheck disable=SC2016 # the program's own variables
program='
function finish(    list, name, count, n, i, c, deep) {
    name = text
    sub(/\(.*/, "", name)
    sub(/.*[ *]/, "", name)
    list = text
    sub(/^[^(]*\(/, "", list)
    count = 1
    deep = 0
    n = length(list)
    for (i = 1; i <= n; ++i) {
        c = substr(list, i, 1)
        if (c == "(") ++deep
        else if (c == ")" && --deep < 0) break
        else if (c == "," && deep == 0) ++count
    }
    if (count > 7 && text !~ /__kernel/) print FILENAME ":" first ": " name " has " count " parameters"
}
FNR == 1 { open = 0; comment = 0 }
{
    line = $0
    while (match(line, /\/\*[^*]*(\*[^*\/][^*]*)*\*\//)) line = substr(line, 1, RSTART - 1) " " substr(line, RSTART + RLENGTH)
    if (comment) { if (!sub(/^.*\*\//, "", line)) next; comment = 0 }
    if (sub(/\/\*.*/, "", line)) comment = 1
    sub(/\/\/.*/, "", line)
}
!open && line ~ /^[A-Za-z_][^=;{}()]*[ *][A-Za-z_0-9]+\(/ && line !~ /^typedef / { open = 1; text = ""; first = FNR }
open {
    text = text " " line
    if (line ~ /[;{]|^}/) { open = 0; finish() }
}'

# check ROOT LARGE: prints "file:line: why" for every fault; fails if there is one.
check() {
    (cd "$1" && find shared host backend_cpu backend_ocl -name '*.[ch]' -o -name '*.cl' | sort | xargs awk "$program") >"$work/found"
    for check_name in $2; do
        grep -q ": $check_name has " "$work/found" || echo "tests/check_parameters.sh:1: $check_name is in LARGE without need"
    done >"$work/faults"
    awk -v large="$2" 'BEGIN { n = split(large, names); for (i = 1; i <= n; ++i) known[names[i]] = 1 } !($2 in known)' \
        "$work/found" >>"$work/faults"
    cat "$work/faults"
    [ ! -s "$work/faults" ]
}

# planted WANTED LARGE TEXT: a tree whose file has this text from line 2 on must give this fault, or none if it is empty.
planted() {
    mkdir -p "$work/tree/shared" "$work/tree/host" "$work/tree/backend_cpu" "$work/tree/backend_ocl"
    printf '/* a file, with a list (a, b, c, d, e, f, g, h); */\n%s\n' "$3" >"$work/tree/host/file.h"
    check "$work/tree" "$2" >"$work/output"
    if [ "$(cat "$work/output")" != "$1" ]; then
        echo "self-test: wanted \"$1\" for: $3"
        cat "$work/output"
        status=1
    fi
}

work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
status=0
planted '' '' 'int seven(int a, int b, int c, int d, int e, int f, int g);
static const int numbers[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
int call(void)
{
    return eight(1, 2, 3, 4, 5, 6, 7, 8);
}'
planted '' '' 'int seven(int a, int b, int c, int d, int e, int f, int (*g)(int, int));'
planted '' '' '__kernel void eight(int a, int b, int c, int d,
                    int e, int f, int g, int h)
{'
planted 'host/file.h:2: eight has 8 parameters' '' 'bool eight(int a, int b, int c,
           int d, /* the fourth, which counts */
           int e, int f, int g, int h);'
planted 'host/file.h:2: eight has 8 parameters' '' 'static char *eight(int a, int b, int c, int d, int e, int f, int g, int h)
{'
planted 'host/file.h:2: eight has 8 parameters' '' 'SHARED_FUNCTION void eight(int a, int b, int c, int (*d)(int, int),
                           int e, int f, int g, int h)
{'
planted '' 'eight' 'int eight(int a, int b, int c, int d, int e, int f, int g, int h);'
planted 'tests/check_parameters.sh:1: seven is in LARGE without need' 'seven' 'int seven(int a, int b, int c, int d, int e, int f, int g);'
check "$srcdir" "$LARGE" || status=1
exit $status
