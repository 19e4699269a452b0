#!/bin/sh
# The program as its user meets it: exit statuses, messages, files and signals. Runs in the build folder; srcdir is the
# source folder (both set by `make check`).
set -u

program=$(pwd)/twinlight
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

# expect STATUS TEXT ARGUMENT...: runs the program; it must exit so and say TEXT (on either stream; "" for anything).
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

# A small rendering.
render() {
    "$program" render --resolution=16x12 --samples=1 --threads=2 "$@" >out 2>err
}

file_exists() {
    [ -s "$1" ]
    result "file $1 is missing or empty" $?
}

file_missing() {
    [ ! -e "$1" ]
    result "file $1 should not be there" $?
}

# ---- help, version, usage -----------------------------------------------------------------------------------------

expect 0 'Usage: twinlight COMMAND' --help
expect 0 'Usage: twinlight COMMAND' -h
expect 0 'Backends: cpu' --version
expect 0 'Usage: twinlight render' render --help
expect 0 '--save-every=TIME' render --help
expect 0 'Usage: twinlight info' info --help
expect 0 'twinlight compare' compare --help
expect 2 'no command is given'
expect 2 'unknown command paint' paint
expect 2 'unknown option --verbose' --verbose

# ---- bad options --------------------------------------------------------------------------------------------------

expect 2 'no scene is given' render
expect 2 'more than one scene' render "$scene" "$scene"
expect 2 'option --fast' render --fast "$scene"
expect 2 '--samples needs a value' render "$scene" --samples
expect 2 '--quiet takes no value' render --quiet=yes "$scene"
expect 2 '--samples=0: out of range' render --samples=0 "$scene"
expect 2 '--samples=-4: not a whole number' render --samples=-4 "$scene"
expect 2 '--samples=1e3: not a whole number' render --samples=1e3 "$scene"
expect 2 '--samples=99999999999: out of range' render --samples=99999999999 "$scene"
expect 2 '--time=30: not a time' render --time=30 "$scene"
expect 2 '--time=0s: out of range' render --time=0s "$scene"
expect 2 '--save-every=often: not a time' render --save-every=often "$scene"
expect 2 '--threads=0: out of range' render --threads=0 "$scene"
expect 2 '--seed=x: not a whole number' render --seed=x "$scene"
expect 2 '--max-depth=0: out of range' render --max-depth=0 "$scene"
expect 2 '--resolution=640: not a size' render --resolution=640 "$scene"
expect 2 '--resolution=0x4: not a size' render --resolution=0x4 "$scene"
expect 2 '--crop=1,2,3: not a rectangle' render --crop=1,2,3 "$scene"
expect 2 '--crop=3,0,3,4: the rectangle is empty' render --crop=3,0,3,4 "$scene"
expect 2 'outside the film' render --crop=0,0,401,10 "$scene"
expect 2 '--exposure=bright: not a number' render --exposure=bright "$scene"
expect 2 'does not end in .exr' render -o image.jpg "$scene"
expect 2 'does not end in .png' render --png=image.jpg "$scene"
expect 2 'use one of: cpu' render --backend=gpu "$scene"
expect 2 'use pt' render --integrator=bdpt "$scene"
expect 2 'no scene is given' info
expect 2 '' compare
expect 2 '' compare one.exr

# ---- what cannot be read or written -------------------------------------------------------------------------------

expect 1 'missing.pbrt' render missing.pbrt
expect 1 'missing.pbrt' info missing.pbrt
expect 1 'nowhere/image.exr' render -o nowhere/image.exr "$scene"
expect 1 'nowhere/stats.json' render --stats=nowhere/stats.json "$scene"
mkdir folder.exr
expect 1 'it is a folder' render -o folder.exr "$scene"
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked
    chmod a-w locked
    expect 1 'locked/image.exr' render -o locked/image.exr "$scene"
fi
file_missing cornell.exr

# ---- rendering ----------------------------------------------------------------------------------------------------

render "$scene"
result 'default names: exit status' $?
file_exists cornell.exr
file_exists cornell.png
head -c 4 cornell.exr | od -An -tx1 | grep -q '76 2f 31 01'
result 'cornell.exr is no OpenEXR file' $?
head -c 4 cornell.png | od -An -tx1 | grep -q '89 50 4e 47'
result 'cornell.png is no PNG' $?
grep -q 'wrote cornell.exr and cornell.png' err
result 'the summary does not name the files' $?

render --quiet -o quiet.exr "$scene"
result '--quiet: exit status' $?
[ ! -s out ] && [ ! -s err ]
result '--quiet is not silent' $?

render --no-png -o plain.exr "$scene"
file_exists plain.exr
file_missing plain.png
render --png=other.png --exposure=1 -o named.exr "$scene"
file_exists other.png
file_missing named.png

render --threads=1 -o one.exr "$scene"
render --threads=3 -o three.exr "$scene"
cmp one.exr three.exr
result 'the image depends on the number of threads' $?
render --seed=7 -o seed.exr "$scene"
! cmp -s one.exr seed.exr
result '--seed changes nothing' $?
[ -z "$(find . -name '*~')" ] # see output_file.c
result 'a temporary file is left' $?

render --crop=4,2,12,10 -o crop.exr "$scene"
result '--crop: exit status' $?
file_exists crop.exr

expect 0 'lights        2' info "$scene"
expect 0 '"feature_mask"' info --json "$scene"

# ---- compare ------------------------------------------------------------------------------------------------------

expect 0 '' compare one.exr three.exr
expect 1 '' compare one.exr crop.exr
expect 1 'missing.exr' compare one.exr missing.exr

# ---- statistics ---------------------------------------------------------------------------------------------------

render --seed=18446744073709551615 --stats=stats.json -o stats.exr "$scene"
result '--stats: exit status' $?
for key in format version scene file width height crop max_depth primitives instances materials lights bytes \
    integrator backend device seed threads samples_per_pixel samples samples_per_second stopped seconds load build \
    render write total rays closest shadow seconds_all_threads per_second peak_memory_bytes backend_bytes diagnostics \
    film_saturated film_not_finite degenerate_triangles zero_area_lights substitutions warnings kernels image png; do
    grep -q "\"$key\": " stats.json
    result "stats.json has no key $key" $?
done
if command -v python3 >/dev/null 2>&1; then
    python3 - <<'PYTHON'
import json, sys

def unique(pairs):
    assert len(dict(pairs)) == len(pairs), "a key twice: %s" % [key for key, value in pairs]
    return dict(pairs)

stats = json.load(open("stats.json"), object_pairs_hook=unique)
seconds = stats["seconds"]
assert stats["seed"] == 2**64 - 1, stats["seed"]
assert stats["threads"] == 2 and stats["samples"] == 192 and stats["samples_per_pixel"] == 1
assert stats["scene"]["width"] == 16 and stats["scene"]["crop"] == [0, 0, 16, 12]
assert stats["rays"]["closest"] >= 192 and stats["stopped"] is False
assert 0 < sum(seconds[s] for s in ("load", "build", "render", "write")) <= seconds["total"]
PYTHON
    result 'stats.json is not valid JSON, or holds wrong values' $?
fi

# ---- long runs: signals, saving -----------------------------------------------------------------------------------

# wait_for FILE: until it is there, 20 s at most.
wait_for() {
    tries=0
    while [ ! -s "$1" ] && [ "$tries" -lt 200 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    file_exists "$1"
}

# long_render ARGUMENT...: in the background, process number in $process, ended after 60 s whatever happens.
long_render() {
    "$program" render --quiet --resolution=32x32 --time=60s "$@" "$scene" >out 2>err &
    process=$!
}

for signal in INT TERM; do
    long_render --save-every=0.2s --stats=$signal.json -o $signal.exr
    wait_for $signal.exr # written by --save-every
    rm -f $signal.exr $signal.png
    kill -s $signal $process
    wait $process
    [ $? -eq 130 ]
    result "SIG$signal: exit status is not 130" $?
    file_exists $signal.exr
    file_exists $signal.png
    grep -q '"stopped": true' $signal.json
    result "SIG$signal: the statistics do not say so" $?
done

start=$(date +%s)
"$program" render --quiet --resolution=32x32 --time=1s -o time.exr "$scene"
result '--time: exit status' $?
[ $(($(date +%s) - start)) -le 5 ]
result '--time=1s took more than 5 s' $?
file_exists time.exr

echo "100% of $checks checks run, failures: $failures"
[ "$failures" -eq 0 ]
