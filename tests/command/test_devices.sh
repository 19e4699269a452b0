#!/bin/sh
# End-to-end tests of devices: --verify, several devices at once, broken drivers and caches, odd sizes and scenes. PoCL
# offers two devices on one CPU. Runs in the build folder, like command/test_cli.sh.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

# Device 1 is the one that the other tests use, so that most programs have been built: 0 has those of one scene, by path
# tracing and bdpt.
POCL_DEVICES='basic pthread'
export POCL_DEVICES
sources=$(cd "${scene%/*}/../shared" && pwd)

expect 2 'compares devices with the CPU' render --verify --backend=cpu "$scene"
if ! "$program" --version | grep -q opencl; then
    expect 2 'in a build that has it' render --verify "$scene"
    echo 'skipped: this build is without OpenCL'
    checks_end
    exit
fi
for option in --output=verify.exr --png=verify.png --stats=verify.json --trace=verify.json --time=1s --save-every=1s \
    --film=host; do
    expect 2 'cannot be used with --verify' render --verify "$option" "$scene"
done

# ---- no driver, or one without devices ----------------------------------------------------------------------------

(
    OCL_ICD_VENDORS=$work/nothing
    export OCL_ICD_VENDORS
    expect 1 'there is no OpenCL device' render --integrator=pt --backend=opencl "$scene"
    expect 1 'there is no OpenCL device' render --integrator=pt --backend=opencl --device=0,1 "$scene"
    expect 1 'there is no OpenCL device' render --integrator=pt --backend=all --device=0 "$scene"
    expect 1 'there is no OpenCL device' render --verify "$scene"
    expect 0 'opencl has no device on this machine' render --integrator=pt --backend=all --resolution=16x12 --samples=1 -o alone.exr "$scene"
    expect 0 'no device' devices
    [ "$failures" -eq 0 ]
)
result 'without a driver' $?
file_exists alone.exr

if [ "$("$program" devices --json | grep -c '"index"')" -lt 3 ] || ! "$program" devices | grep -q ' 1  pthread'; then
    echo 'skipped: PoCL does not give two devices here'
    checks_end
    exit
fi

# ---- lists of devices ---------------------------------------------------------------------------------------------

for list in '0,,1' ',0' '0,'; do
    expect 2 'missing between the commas' render --integrator=pt --backend=opencl --device="$list" "$scene"
done
expect 2 '--device names 0 twice' render --integrator=pt --backend=opencl --device=0,1,0 "$scene"
expect 1 '0 and basic are the same device' render --integrator=pt --backend=opencl --device=0,basic "$scene"
expect 1 'PTHREAD and 1 are the same device' render --integrator=pt --backend=all --device=PTHREAD,1 "$scene"
expect 1 '--device=7: there is no OpenCL device with that number' render --integrator=pt --backend=opencl --device=0,7 "$scene"
expect 1 'more than one OpenCL device has that' render --integrator=pt --backend=opencl --device=c "$scene"

# ---- the same image -----------------------------------------------------------------------------------------------

# same SCENE WAYS OPTION...: each of these ways (opencl, two, all, film, film_all) of rendering gives the CPU's file.
# The options apply to all.
same() {
    same_scene=$1
    same_ways=$2
    shift 2
    "$program" render --quiet --integrator=pt --no-png -o cpu.exr "$@" "$same_scene" >out 2>err
    result "twinlight render $* $same_scene on the CPU" $?
    for way in $same_ways; do
        case $way in
        opencl) way='opencl --device=1' ;;
        two) way='opencl --device=0,1' ;;
        film) way='opencl --device=1 --film=device' ;;
        film_all) way='all --film=device' ;;
        esac
        # shellcheck disable=SC2086 # a way is several options
        "$program" render --quiet --integrator=pt --no-png -o device.exr "$@" --backend=$way "$same_scene" >out 2>err &&
            cmp cpu.exr device.exr
        result "twinlight render $* --backend=$way $same_scene: not the CPU's image" $?
        rm -f device.exr
    done
    rm -f cpu.exr
}

# An environment alone.
cat >environment.pbrt <<'PBRT'
Film "rgb" "integer xresolution" 17 "integer yresolution" 13
Camera "perspective" "float fov" 50
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.7 ]
PBRT
cp "$sources/../tests/instances.pbrt" .
same "$scene" "two all film_all" --resolution=64x48 --samples=2
same "$scene" "film film_all" --integrator=bdpt --resolution=31x23 --crop=3,2,30,21 --samples=3
same "$scene" film --integrator=ibpt --resolution=31x23 --crop=3,2,30,21 --samples=3
for other in environment.pbrt instances.pbrt; do
    for batch in 1 63 100000; do
        "$program" render --quiet --integrator=pt --no-png -o cpu.exr --samples=3 $other >out 2>err &&
            "$program" render --quiet --integrator=pt --no-png -o batch.exr --samples=3 --backend=opencl --device=1 --batch=$batch $other \
                >out 2>err && cmp cpu.exr batch.exr
        result "$other: --batch=$batch changes the image" $?
    done
done
same instances.pbrt "opencl film" --samples=3
same "$scene" "opencl two film_all" --resolution=1x1 --samples=3000
same "$scene" "opencl all" --resolution=333x7 --samples=1 --threads=1
same "$scene" "opencl two film" --crop=16,12,17,13 --samples=50
same instances.pbrt opencl --max-depth=1 --samples=3
same instances.pbrt opencl --max-depth=65535 --samples=1

# plant FOLDER EDIT [FILE]: copies the kernels' sources and changes one file, by default bsdf/diffuse.h; EDIT is for
# sed.
plant() {
    plant_file=${3:-bsdf/diffuse.h}
    cp -r "$sources" "$1"
    sed -i "$2" "$1/$plant_file"
    ! cmp -s "$1/$plant_file" "$sources/$plant_file"
    result 'no fault was planted' $?
}

# ---- divisions and roots ------------------------------------------------------------------------------------------

expect 0 'root yes, promised and by a probe of 6291456 divisions and roots' devices
expect 0 '"probed_divisions": 6291456' devices --json

# A single wrong result among six million; multiplication by the reciprocal; roots by reciprocal roots.
plant one 's/float_bits(float_sqrt(x\.c))/float_bits(float_sqrt(x.c)) ^ (first + (uint)i == 777777u ? 1u : 0u)/' kernels/rounding.cl
plant products 's|x\.a / x\.b|x.a * (1.0f / x.b)|' kernels/rounding.cl
plant roots 's/float_bits(float_sqrt(x\.c))/float_bits(x.c * rsqrt(x.c))/' kernels/rounding.cl
TWINLIGHT_KERNELS=$work/one expect 0 'but 1 of 6291456 results are wrong: sqrt(0x1.' devices
TWINLIGHT_KERNELS=$work/products expect 0 'root no, though promised, by a probe of 6291456 divisions and roots' devices
[ "$(grep -c 'same image, bit for bit      not expected' out)" -eq 2 ] && grep -qE 'are wrong: -?0x[0-9a-fp.+-]+ / -?0x' err
result 'products with reciprocals pass for quotients' $?
TWINLIGHT_KERNELS=$work/roots expect 0 '"rounds_division": false' devices --json
TWINLIGHT_KERNELS=$work/nowhere expect 0 'cannot probe the divisions' devices

# ---- verify -------------------------------------------------------------------------------------------------------

expect 0 'agrees with the CPU: 192 paths' render --verify --integrator=pt --resolution=16x12 --samples=1 "$scene"
expect 0 'agrees with the CPU: chains, 192 paths' render --verify --device=1 --resolution=16x12 --samples=1 --max-depth=4 "$scene"
expect 0 'agrees with the CPU: 576 paths' render --verify --integrator=pt --batch=63 --device=1 --resolution=16x12 --samples=3 "$scene"
"$program" render --verify --integrator=pt --backend=all --resolution=16x12 --samples=1 "$scene" >out 2>err
result '--verify --backend=all: exit status' $?
[ "$(grep -c 'agrees with the CPU' err)" -eq 2 ]
result '--verify --backend=all does not compare both devices' $?
TWINLIGHT_TEST_FAIL_BATCH=3 expect 1 'CL_OUT_OF_RESOURCES' render --verify --integrator=pt --resolution=16x12 --samples=1 "$scene"

# One wrong constant in one kernel's source: verify names the kernel that first uses it, a path and a field.
plant wrong 's/value.pdf_w = float_abs(wi.z) \* INV_PI;/value.pdf_w = float_abs(wi.z) * (INV_PI * 1.000001f);/'
TWINLIGHT_KERNELS=$work/wrong expect 1 'kernel pt_sample_lights (segment 1), item ' render --verify --integrator=pt \
    --resolution=8x6 --samples=1 "$scene"
grep -qE 'light sample\.x is [0-9.e+-]+ \(0x[0-9a-f]{8}\) on cpu.* but [0-9.e+-]+ \(0x[0-9a-f]{8}\) on opencl' err
result '--verify does not name field and values' $?

# A kernel that sometimes divides by zero: affected chains are listed, and the image is unaffected.
plant nan 's/vec3_scale(bsdf->color0, value.pdf_w);/vec3_scale(bsdf->color0, value.pdf_w \/ (wi.z > 0.99f ? 0.0f : 1.0f));/'
TWINLIGHT_KERNELS=$work/nan expect 0 'not finite inside the kernels' render --mlt=combine=off --backend=opencl --resolution=16x12 --samples=40 \
    --max-depth=3 --dump-bad=bad.jsonl --layers=none -o nan.exr "$scene"
grep -qE '^\{"seed": 0, "generation": [0-9]+, "pool_sample": [0-9]+, .*"depth": 3, "s": [0-3]\}$' bad.jsonl
result '--dump-bad names no chain' $?
"$program" compare --json nan.exr nan.exr >out 2>err
grep -q '"not_finite": 0' out
result 'a value that is not finite came into the image' $?
expect 0 '' render --backend=cpu --resolution=16x12 --samples=20 --max-depth=4 --dump-bad=none.jsonl --layers=none \
    -o good.exr "$scene"
[ -e none.jsonl ] && [ ! -s none.jsonl ]
result '--dump-bad lists chains where there are none' $?

# ---- failures and signals -----------------------------------------------------------------------------------------

# Batches 0 ... 31 of each of two devices are the pilot's.
TWINLIGHT_TEST_FAIL_BATCH=40 expect 1 'CL_OUT_OF_RESOURCES; what was finished, ' render --integrator=pt \
    --backend=opencl --device=0,1 --batch=64 --resolution=64x64 --samples=50 -o failed.exr "$scene"
file_exists failed.exr
file_exists failed.png
TWINLIGHT_TEST_FAIL_BATCH=0 expect 1 'CL_OUT_OF_RESOURCES' render --integrator=pt --backend=all -o none.exr "$scene"
file_missing none.exr
POCL_MEMORY_LIMIT=1 expect 1 'use --batch=' render --integrator=pt --backend=all --batch=67108864 -o none.exr "$scene"
file_missing none.exr

$with_signals "$program" render --quiet --integrator=pt --resolution=32x32 --time=180s --save-every=0.2s --backend=all --stats=stop.json -o stop.exr \
    "$scene" >out 2>err &
process=$!
wait_for stop.exr
rm -f stop.exr
kill -s INT $process
wait $process
[ $? -eq 130 ]
result 'SIGINT with --backend=all: exit status is not 130' $?
file_exists stop.exr
grep -q '"stopped": true' stop.json && grep -q '"backend": "cpu + opencl"' stop.json
result 'SIGINT with --backend=all: the statistics do not say so' $?

# ---- the trace of several devices ---------------------------------------------------------------------------------

expect 0 '' render --integrator=pt --backend=all --film=device --trace=film.json --resolution=64x48 --samples=4 -o traced.exr "$scene"
for name in film_add 'copy sums' 'add to film'; do
    grep -qF "\"$name\"" film.json
    result "--film=device: no \"$name\" in the trace" $?
done
expect 0 '' render --integrator=pt --backend=all --trace=trace.json --resolution=64x48 --samples=4 -o traced.exr "$scene"
! grep -q film_add trace.json
result '--film=host: the device adds' $?
if command -v python3 >/dev/null 2>&1; then
    python3 - <<'PYTHON' >out 2>err
import json
events = json.load(open("trace.json"))["traceEvents"]
names = {e["pid"]: e["args"]["name"] for e in events if e["name"] == "process_name"}
assert len(names) == 2 and len(set(names.values())) == 2, names
for pid in names:
    spans = [e for e in events if e["pid"] == pid and e["ph"] == "X"]
    assert {"trace_closest", "copy splats", "add to film"} <= {e["name"] for e in spans}
    assert all(e["ts"] >= 0 and e["dur"] >= 0 for e in spans)
PYTHON
    result 'the trace of two devices is not what it should be' $?
fi

# ---- folders ------------------------------------------------------------------------------------------------------

TWINLIGHT_KERNELS=$work/nowhere expect 1 'nowhere/kernels.cl' render --verify "$scene"
# PoCL keeps its own files there, and offers no device if it cannot.
touch file
XDG_CACHE_HOME=$work/file expect 1 'POCL_CACHE_DIR' render --integrator=pt --backend=opencl "$scene"
# root may write anywhere
if [ "$(id -u)" -ne 0 ]; then
    mkdir sealed
    chmod a-w sealed
    POCL_CACHE_DIR=$work/sealed XDG_CACHE_HOME=$work/file expect 1 'set POCL_CACHE_DIR to a writable folder' render --integrator=pt --backend=opencl \
        "$scene"
fi
POCL_CACHE_DIR=$work/pocl
export POCL_CACHE_DIR
XDG_CACHE_HOME=$work/file expect 0 '' render --integrator=pt --backend=opencl --resolution=8x6 --samples=1 \
    -o unkept.exr environment.pbrt
(
    unset XDG_CACHE_HOME HOME
    expect 0 '' render --integrator=pt --backend=opencl --resolution=8x6 --samples=1 \
        -o homeless.exr environment.pbrt
    [ "$failures" -eq 0 ]
)
result 'without a home' $?

checks_end
