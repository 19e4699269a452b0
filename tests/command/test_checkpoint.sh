#!/bin/sh
# Checkpoints: a rendering of --samples that is interrupted anywhere, any number of times, and resumed, on other thread
# counts and by another backend, gives the same file as one that is not. Runs in the build folder, like
# command/test_cli.sh; with TWINLIGHT_TEST_EFFORT (as in `make check-long`) 30 signals for each integrator instead of 3.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

if [ -n "${TWINLIGHT_TEST_EFFORT-}" ]; then signals=30; else signals=3; fi
signalled=0

# small ARGUMENT...: a small rendering; its messages are in err.
small() {
    "$program" render --resolution=48x36 --no-png --threads=2 "$@" >out 2>err
}

# random LOW HIGH: a number of milliseconds from LOW on, below HIGH, as seconds.
random() {
    printf '0.%03d' $(($(od -An -N2 -tu2 /dev/urandom) % ($2 - $1) + $1))
}

same() {
    cmp -s "$1" "$2"
    result "$3: other bytes" $?
}

says() {
    grep -qF -- "$1" err
    result "$2: says nothing of \"$1\"" $?
}

# ---- signals ------------------------------------------------------------------------------------------------------

# begin FILE ARGUMENT...: begins or resumes a rendering in the background.
begin() {
    begun=$1
    shift
    $with_signals "$program" render --resolution=48x36 --no-png --checkpoint="$begun.ck" --resume="$begun.ck" \
        --checkpoint-every=0.05s -o "$begun.exr" "$@" >out 2>err &
    process=$!
}

# interrupted NAME ARGUMENT...: compares renderings to which `signals` signals were sent with one that ran through. Each
# process but the last gets one; a rendering that ends before it does is compared, and another begins.
interrupted() {
    name=$1
    shift
    sent=0
    turn=0
    small -q -o "$name-through.exr" "$@"
    while [ "$sent" -lt "$signals" ]; do
        turn=$((turn + 1))
        begin "$name" --threads=$((turn % 3 + 1)) "$@"
        sleep "$(random 100 500)"
        case $((turn % 4)) in 0) signal=INT ;; 2) signal=TERM ;; *) signal=KILL ;; esac
        kill -s $signal $process 2>/dev/null && sent=$((sent + 1))
        wait $process 2>/dev/null
        status=$?
        case $status in
        0)
            same "$name.exr" "$name-through.exr" "$name, done in turn $turn"
            rm -f "$name.ck" "$name.ck.previous"
            ;;
        130 | 137) signalled=$((signalled + 1)) ;;
        *) result "$name: exit status $status after $signal" 1 ;;
        esac
    done
    begin "$name" "$@"
    wait $process
    result "$name: exit status $?" $?
    same "$name.exr" "$name-through.exr" "$name, after $sent signals"
}

interrupted pt --integrator=pt --samples=256 "$scene"
interrupted ibpt --integrator=ibpt --samples=80 "$scene"
interrupted bdpt --integrator=bdpt --samples=64 "$scene"
interrupted mmlt --integrator=mmlt --samples=256 "$scene"
if [ -n "${TWINLIGHT_TEST_EFFORT-}" ]; then
    interrupted layers --layers=direct,indirect,halves,variance,albedo,depth --samples=256 "$scene"
    interrupted depths --layers=by-depth --samples=256 "$scene"
    interrupted paper --mlt=scheme=paper,chains=512 --samples=256 "$scene"
    interrupted chains --mlt=combine=off --samples=256 "$scene"
fi
[ "$signalled" -gt 0 ]
result 'no rendering was interrupted' $?
[ -z "$(find . -name '*~')" ]
result 'a temporary file is left' $?

# ---- all that a generation hands on --------------------------------------------------------------------------------

# Stopped and resumed after every few generations, by other thread counts.
small -q -o all-through.exr --layers=halves,variance,albedo --seed=5 --samples=96 "$scene"
turn=0
begin all --layers=halves,variance,albedo --seed=5 --samples=96 --threads=2 "$scene"
while [ "$turn" -lt 6 ] && [ ! -s all.done ]; do
    turn=$((turn + 1))
    sleep 0.12
    kill -s INT $process 2>/dev/null
    wait $process && : >all.done
    begin all --layers=halves,variance,albedo --seed=5 --samples=96 --threads=$turn "$scene"
done
wait $process
same all.exr all-through.exr 'mmlt with layers, stopped six times'

# ---- more samples, and time ---------------------------------------------------------------------------------------

small -q -o more-through.exr --integrator=pt --samples=16 "$scene"
small -o more.exr --integrator=pt --samples=6 --checkpoint=more.ck "$scene"
says 'more.ck holds a checkpoint of 6 samples per pixel' 'a finished rendering'
file_exists more.ck
file_missing more.ck.previous
small -o more.exr --integrator=pt --samples=11 --resume=more.ck --checkpoint-every=1h "$scene"
says 'going on from more.ck: 6 samples per pixel' 'a resumed rendering'
file_exists more.ck.previous
cp more.ck eleven.ck
small -o more.exr --integrator=pt --samples=16 --resume=more.ck "$scene"
same more.exr more-through.exr '6, 11 and 16 samples of pt'
cmp -s eleven.ck more.ck.previous
result 'the previous checkpoint is not the one before' $?
small -o again.exr --integrator=pt --samples=16 --resume=more.ck "$scene"
same again.exr more-through.exr 'a rendering that was done'
expect 1 'more.ck already has 16 samples per pixel' render --integrator=pt --resolution=48x36 --no-png --samples=15 \
    --resume=more.ck -o fewer.exr "$scene"
file_missing fewer.exr
small -o more.exr --integrator=pt --time=0.2s --resume=more.ck "$scene"
result 'more time of pt' $?
! grep -q 'more.ck holds a checkpoint of 16 samples per pixel' err
result 'nothing was rendered in that time' $?

small -o metropolis.exr --samples=16 --checkpoint=metropolis.ck --stats=sixteen.json "$scene"
small -o metropolis.exr --samples=64 --resume=metropolis.ck --stats=more.json "$scene"
result 'more samples of mmlt' $?
small -q -o all-metropolis.exr --samples=64 "$scene"
"$program" compare metropolis.exr all-metropolis.exr | grep -qE 'relMSE +0\.0'
result 'mmlt with more samples is another picture' $?
small -o metropolis.exr --time=0.3s --resume=metropolis.ck "$scene"
result 'more time of mmlt' $?
says 'going on from metropolis.ck: 64' 'more time of mmlt'

# ---- refusals -----------------------------------------------------------------------------------------------------

# refused TEXT ARGUMENT...: resuming with other arguments is an error that says what differs, and leaves all files alone.
refused() {
    text=$1
    shift
    cp metropolis.ck kept.ck
    expect 1 "$text" render --resolution=48x36 --samples=999 --no-png --resume=metropolis.ck -o refused.exr "$@"
    file_missing refused.exr
    cmp -s kept.ck metropolis.ck
    result "$text: the checkpoint has changed" $?
}
refused 'metropolis.ck is of --seed=0, and this rendering of --seed=1' --seed=1 "$scene"
refused 'is of --integrator=mmlt, and this rendering of --integrator=pt' --integrator=pt "$scene"
refused ', and this rendering of --max-depth=3' --max-depth=3 "$scene"
refused 'is of --resolution=48x36, and this rendering of --resolution=48x37' --resolution=48x37 "$scene"
refused 'is of --crop=0,0,48,36, and this rendering of --crop=0,0,9,9' --crop=0,0,9,9 "$scene"
refused ', and this rendering of --layers=none' --layers=none "$scene"
refused ', and this rendering of --sampler=independent' --sampler=independent "$scene"
refused ', and this rendering of --photons=7' --photons=7 "$scene"
refused 'is of --mlt=steps=default, and this rendering of --mlt=steps=32' --mlt=steps=32 "$scene"
refused 'is of --mlt=mutations=default, and this rendering of --mlt=mutations=all+camera' --mlt=mutations=all+camera "$scene"
refused 'is of --mlt=sort=strategy, and this rendering of --mlt=sort=none' --mlt=sort=none "$scene"
refused 'is of --layers=albedo,normal,depth,alpha, and this rendering of --layers=albedo,depth' --layers=albedo,depth "$scene"
sed 's/0\.72 0\.70/0.72 0.71/' "$scene" >other.pbrt
refused 'metropolis.ck is of another scene' other.pbrt

expect 2 'there is no file to write to' render --checkpoint-every=1m "$scene"
expect 2 '--dump-bad cannot be used with --checkpoint' render --checkpoint=a.ck --dump-bad=a.json "$scene"
expect 2 'cannot be used with --verify' render --verify --checkpoint=a.ck "$scene"
expect 1 'the checkpoint would overwrite the image' render --checkpoint=a.exr -o a.exr "$scene"
expect 1 'cannot write no/a.ck' render --checkpoint=no/a.ck -o a.exr --resolution=8x8 --samples=1 "$scene"
expect 1 '--resume=none.ck: there is no such file' render --resume=none.ck "$scene"
expect 1 '--checkpoint=metropolis.ck: there is such a file' render --checkpoint=metropolis.ck "$scene"
mv metropolis.ck.previous only.ck.previous
expect 1 'or one named only.ck.previous' render --checkpoint=only.ck "$scene"
small -o a.exr --samples=1 --integrator=pt --checkpoint=new.ck --resume=new.ck "$scene"
says 'there is no new.ck yet: the rendering starts anew' 'a first run of a script'
small -o a.exr --samples=1 --integrator=pt --frame=7 --checkpoint=f.%03d.ck "$scene"
file_exists f.007.ck

# Light so bright that squares of it are infinite is no damage.
sed 's/\("rgb L" \[[^]]*\]\)/\1 "float scale" [ 1e24 ]/' "$scene" >bright.pbrt
small -o bright.exr --samples=48 --checkpoint=bright.ck bright.pbrt
small -o bright.exr --samples=96 --resume=bright.ck bright.pbrt
result 'bright light: exit status' $?
says 'going on from bright.ck' 'bright light'

# ---- damage -------------------------------------------------------------------------------------------------------

# damaged WHAT: more.ck was damaged; its previous one leads to the same picture, and stays until there is a new one.
damaged() {
    cp more.ck.previous former.ck
    small -o damaged.exr --integrator=pt --samples=16 --resume=more.ck "$scene"
    result "$1: exit status" $?
    says 'going on from more.ck.previous' "$1"
    same damaged.exr more-through.exr "$1"
    cmp -s former.ck more.ck.previous
    result "$1: the previous one is replaced by a damaged one" $?
    cp whole.ck more.ck
}
rm -f more.ck more.ck.previous
small -o more.exr --integrator=pt --samples=11 --checkpoint=more.ck "$scene"
small -o more.exr --integrator=pt --samples=14 --resume=more.ck "$scene"
cp more.ck whole.ck
size=$(wc -c <whole.ck)
head -c $((size / 2)) whole.ck >more.ck
damaged 'a half'
: >more.ck
damaged 'an empty file'
rm more.ck
damaged 'a missing file'
{
    head -c $((size - 3)) whole.ck
    printf 'abc'
} >more.ck
damaged 'another checksum'
cp "$scene" more.ck
damaged 'a text'
: >more.ck
: >more.ck.previous
expect 1 'more.ck cannot be resumed: its end is missing' render --integrator=pt --resolution=48x36 --samples=16 \
    --resume=more.ck -o no.exr "$scene"
file_missing no.exr
if command -v zstd >/dev/null; then
    zstd -dqf whole.ck -o state
    sed 's/version=/version=9/' state | zstd -qf -o more.ck
    expect 1 'more.ck is of Twinlight ' render --integrator=pt --resolution=48x36 --samples=16 --resume=more.ck \
        -o no.exr "$scene"
    head -c 9000 state | zstd -qf -o more.ck
    expect 1 'more.ck cannot be resumed: it ends too early' render --integrator=pt --resolution=48x36 --samples=16 \
        --resume=more.ck -o no.exr "$scene"
    head -c 100000 /dev/zero | zstd -qf -o more.ck
    expect 1 'more.ck cannot be resumed: it is no checkpoint of Twinlight' render --integrator=pt --resolution=48x36 \
        --samples=16 --resume=more.ck -o no.exr "$scene"
    file_missing no.exr

    # planted OFFSET BYTES TEXT: a value that no rendering saves, in a file whose checksum is right. One sentence says so, and
    # what has been written stays. (Of state, tests/render/test_restore.c.)
    planted() {
        cp state wrong
        # shellcheck disable=SC2059 # the bytes are a format
        printf "$2" | dd of=wrong bs=1 seek="$1" conv=notrunc 2>copied
        zstd -qf wrong -o more.ck
        cp more.ck kept.ck
        cp more.exr kept.exr
        expect 1 "more.ck cannot be resumed: $3" render --integrator=pt --resolution=48x36 --samples=16 --no-png \
            --resume=more.ck -o more.exr "$scene"
        [ "$(grep -c 'error: ' err)" -eq 1 ]
        result "$3: not one sentence" $?
        cmp -s kept.ck more.ck && cmp -s kept.exr more.exr && [ ! -e more.ck.previous ]
        result "$3: files have changed" $?
    }
    rm -f more.ck.previous
    planted 2088 '\377\377\377\177' "the film's quantum is out of range"
    planted 2100 '\377\377\377\377\377\377\377\377' 'seconds of rendering: NaN was saved, but there can be 0 to 1e+15'
    planted 2112 '\001\000\020\000' 'photons: 1048577 were saved, but there can be 0 to 1048576'
else
    echo 'skipped: there is no zstd to make checkpoints that differ'
fi

# ---- another backend ----------------------------------------------------------------------------------------------

if "$program" devices --json 2>/dev/null | sed -n '/"opencl"/,$p' | grep -q '"same_bits": true'; then
    for place in host device; do
        rm -f device.ck device.ck.previous
        small -q -o device.exr --integrator=pt --samples=5 --checkpoint=device.ck "$scene"
        small -q -o device.exr --integrator=pt --samples=12 --resume=device.ck --backend=opencl --film=$place "$scene"
        result "resumed by OpenCL, film on $place: exit status" $?
        small -q -o device.exr --integrator=pt --samples=16 --resume=device.ck "$scene"
        same device.exr more-through.exr "resumed by OpenCL, film on $place, and by the CPU again"
    done
else
    echo 'skipped: there is no OpenCL device with the same bits'
fi

checks_end
