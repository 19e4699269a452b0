# shellcheck shell=sh
# Shared by the end-to-end tests: a scratch folder, counted checks, small renderings. Sourced in the build folder;
# srcdir is the source folder.

build=$(pwd)
program=$build/twinlight
# shellcheck disable=SC2034 # for who sources this
scene=$(cd "${srcdir:-.}" && pwd)/scenes/cornell.pbrt
work=$(mktemp -d "${TMPDIR:-/tmp}/twinlight-cli.XXXXXX") || exit 99
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work" || exit 99
checks=0
failures=0

# result NAME STATUS: counts one check.
result() {
    checks=$((checks + 1))
    if [ "$2" -ne 0 ]; then
        failures=$((failures + 1))
        echo "FAILED: $1"
        sed 's/^/    /' err out 2>/dev/null | head -n 20
    fi
}

# expect STATUS TEXT ARGUMENT...: runs the program, which must exit with STATUS and print TEXT (on either stream; "":
# anything).
expect() {
    expected=$1
    text=$2
    shift 2
    "$program" "$@" >out 2>err
    status=$?
    [ "$status" -eq "$expected" ]
    result "twinlight $*: exit status $status, not $expected" $?
    if [ -n "$text" ]; then
        cat out err | grep -qF -- "$text"
        result "twinlight $*: says nothing of \"$text\"" $?
    fi
    if [ "$expected" -eq 1 ] || [ "$expected" -eq 2 ]; then
        grep -q 'error: ' err
        result "twinlight $*: no error on standard error" $?
    fi
}

# Prefix for programs run in the background: shells start those with SIGINT ignored, which the program would respect.
# shellcheck disable=SC2034 # for who sources this
with_signals='env --default-signal=INT,HUP,PIPE'
$with_signals true 2>/dev/null || with_signals=

# A small rendering, by path tracing unless an argument overrides it.
render() {
    "$program" render --integrator=pt --resolution=16x12 --samples=1 --threads=2 "$@" >out 2>err
}

file_exists() {
    [ -s "$1" ]
    result "file $1 is missing or empty" $?
}

file_missing() {
    [ ! -e "$1" ]
    result "file $1 should not be there" $?
}

# wait_for FILE: waits until the file exists, at most a minute.
wait_for() {
    tries=0
    while [ ! -s "$1" ] && [ "$tries" -lt 600 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    file_exists "$1"
}

# checks_end: prints the summary; its status is the script's.
checks_end() {
    echo "100% of $checks checks run, failures: $failures"
    [ "$failures" -eq 0 ]
}
