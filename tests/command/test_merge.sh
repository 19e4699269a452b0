#!/bin/sh
# Shards: parts of a picture, merged in any order, are the picture; and whatever cannot be merged is refused with a message,
# leaving the image as it was. Runs in the build folder, like command/test_cli.sh.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

# small ARGUMENT...: a small rendering; its messages are in err.
small() {
    "$program" render --resolution=40x30 --no-png "$@" >out 2>err
}

# shards NAME N ARGUMENT...: renders N parts, NAME-1.part ..., each on another number of threads.
shards() {
    name=$1
    count=$2
    shift 2
    for k in $(seq "$count"); do
        small --threads=$((k % 3 + 1)) --shard="$k/$count" -o "$name-$k.part" "$@"
        result "$name: shard $k of $count: exit status" $?
    done
}

# merged FILE.exr PART...: merges; its messages are in err.
merged() {
    "$program" merge --no-png -o "$@" >out 2>err
    result "merge -o $*" $?
}

same() {
    cmp -s "$1" "$2"
    result "$3: other bytes" $?
}

says() {
    grep -qF -- "$1" err
    result "$2: says nothing of \"$1\"" $?
}

# ---- the bytes of a single rendering --------------------------------------------------------------------------------

for integrator in pt ibpt bdpt; do
    small --integrator=$integrator --samples=7 --seed=3 -o single.exr "$scene"
    shards $integrator 3 --integrator=$integrator --samples=7 --seed=3 "$scene"
    merged merged.exr $integrator-2.part $integrator-3.part $integrator-1.part
    same merged.exr single.exr "$integrator, merged"
    merged merged.exr $integrator-3.part $integrator-1.part $integrator-2.part
    same merged.exr single.exr "$integrator, merged in another order"
done
says 'merged 3 of 3 parts: 7 samples per pixel' 'a complete merge'
! grep -q 'warning' err
result 'a complete merge warns' $?

# A sample for each shard, a crop, and layers, whose samples are those of the picture.
small --integrator=pt --samples=5 --crop=3,4,30,21 --layers=all -o single.exr "$scene"
shards crop 5 --integrator=pt --samples=5 --crop=3,4,30,21 --layers=all "$scene"
merged merged.exr crop-5.part crop-1.part crop-4.part crop-2.part crop-3.part
same merged.exr single.exr 'a crop with layers'
# So many samples that each shard has more than the layers need.
small --integrator=pt --samples=20 --layers=all -o single.exr "$scene"
shards layers 2 --integrator=pt --samples=20 --layers=all "$scene"
merged merged.exr layers-2.part layers-1.part
same merged.exr single.exr 'layers of many samples'
# Photons are those of the picture, and the options of the image are merge's.
pool=${scene%/*}/pool.pbrt
"$program" render -q --resolution=40x30 --integrator=pt --photons=2000 --samples=4 --despeckle=2 --exposure=1 -o single.exr "$pool"
shards photons 2 --integrator=pt --photons=2000 --samples=4 "$pool"
"$program" merge -q --despeckle=2 --exposure=1 -o merged.exr photons-2.part photons-1.part
same merged.exr single.exr 'photons and despeckling'
same merged.png single.png 'the PNG'

# ---- by another backend ---------------------------------------------------------------------------------------------

if "$program" devices --json 2>/dev/null | sed -n '/"opencl"/,$p' | grep -q '"same_bits": true'; then
    for integrator in pt ibpt bdpt; do
        small --integrator=$integrator --samples=7 --seed=3 -o single.exr "$scene"
        small --integrator=$integrator --samples=7 --seed=3 --shard=2/3 --backend=opencl -o device.part "$scene"
        merged merged.exr $integrator-1.part device.part $integrator-3.part
        same merged.exr single.exr "$integrator: a shard by OpenCL"
    done
    small --samples=7 --shard=1/2 -o host.part "$scene"
    small --samples=7 --shard=1/2 --backend=opencl -o device.part "$scene"
    merged host.exr host.part
    merged device.exr device.part
    same device.exr host.exr 'mmlt: a shard by OpenCL'
else
    echo 'skipped: there is no OpenCL device with the same bits'
fi

# ---- interruptions --------------------------------------------------------------------------------------------------

small --integrator=pt --samples=1000 -o single.exr "$scene"
begin() {
    $with_signals "$program" render --resolution=40x30 --no-png --integrator=pt --samples=1000 --shard=2/2 --threads=1 \
        --checkpoint=stop.ck --resume=stop.ck --save-every=0.05s -o stop-2.part "$scene" >out 2>err &
    process=$!
}
begin
wait_for stop-2.part
kill -s TERM $process
wait $process
[ $? -eq 130 ]
result 'a shard that is stopped: exit status' $?
small --integrator=pt --samples=1000 --shard=1/2 -o stop-1.part "$scene"
merged merged.exr stop-1.part stop-2.part
says 'of 2 parts are of shards that were stopped early, the first stop-2.part' 'a stopped shard'
begin
wait $process
result 'a shard that goes on: exit status' $?
merged merged.exr stop-1.part stop-2.part
same merged.exr single.exr 'a shard that was stopped and resumed'
expect 1 'stop.ck is of --shard=2/2, and this rendering of --shard=1/2' render --resolution=40x30 --integrator=pt \
    --samples=1000 --shard=1/2 --resume=stop.ck -o no.part "$scene"
expect 1 'stop.ck is of --shard=2/2, and this rendering of --shard=none' render --resolution=40x30 --integrator=pt \
    --samples=1000 --resume=stop.ck -o no.exr "$scene"
file_missing no.part

# ---- time -----------------------------------------------------------------------------------------------------------

# Shards of time have samples of their own: two are not one twice.
for k in 1 2; do
    small --integrator=pt --time=0.1s --shard=$k/2 -o "time-$k.part" "$scene"
    merged time-$k.exr time-$k.part
done
merged merged.exr time-1.part time-2.part
! cmp -s time-1.exr time-2.exr
result 'shards of time are the same samples' $?

# ---- mmlt -----------------------------------------------------------------------------------------------------------

small --samples=600 --layers=all --seed=1 -o single.exr "$scene"
shards mmlt 4 --samples=600 --layers=all "$scene"
merged merged.exr mmlt-1.part mmlt-2.part mmlt-3.part mmlt-4.part
merged again.exr mmlt-4.part mmlt-2.part mmlt-1.part mmlt-3.part
same merged.exr again.exr 'mmlt with halves and variances, in another order'
# By the variance that the halves of both state.
"$program" compare merged.exr single.exr >out
grep -q 'no difference found' out
result 'mmlt: merged parts differ from a single rendering by more than noise' $?
for k in 1 2 3 4; do merged "one-$k.exr" "mmlt-$k.part"; done
for pair in 1,2 1,3 1,4 2,3 2,4 3,4; do
    # Correlated errors would make the halves' differences too small or equal.
    ! cmp -s "one-${pair%,*}.exr" "one-${pair#*,}.exr"
    result "mmlt: shards $pair are the same" $?
done
says 'shards 1 ... 3 of 4 are missing: the picture has 1 of 4 parts' 'three missing shards'
small --samples=60 --layers=by-depth --shard=1/2 -o depths.part "$scene"
merged merged.exr depths.part
says 'shard 2 of 2 is missing' 'a missing shard'

# ---- a pilot --------------------------------------------------------------------------------------------------------

"$program" render --resolution=40x30 --no-png -q --samples=20 --checkpoint=pilot.ck -o pilot.exr "$scene"
shards guided 2 --samples=60 --pilot=pilot.ck "$scene"
says 'beginning with what pilot.ck has learnt' 'a shard with a pilot'
merged guided.exr guided-1.part guided-2.part
small --samples=60 --shard=2/2 --pilot=pilot.ck --threads=1 -o again.part "$scene"
merged one.exr guided-2.part
merged again.exr again.part
same one.exr again.exr 'a shard with a pilot, by one thread'
small --samples=60 --shard=2/2 -o alone.part "$scene"
merged alone.exr alone.part
! cmp -s one.exr alone.exr
result 'a pilot makes no difference' $?
merged first.exr guided-1.part
! cmp -s first.exr one.exr
result 'shards with one pilot are the same' $?
expect 2 'without --shard' render --samples=60 --pilot=pilot.ck -o no.exr "$scene"
expect 2 'for mmlt' render --integrator=pt --samples=60 --shard=1/2 --pilot=pilot.ck -o no.part "$scene"
# refused_pilot TEXT ARGUMENT...: a rendering with a pilot that is refused with that text.
refused_pilot() {
    text=$1
    shift
    expect 1 "$text" render --resolution=40x30 --samples=60 --shard=1/2 -o no.part "$@" "$scene"
}
refused_pilot 'pilot.ck is of --seed=0, and this rendering of --seed=5' --seed=5 --pilot=pilot.ck
refused_pilot 'give the file of a --checkpoint' --pilot=again.part
refused_pilot 'nothing.ck' --pilot=nothing.ck
head -c 2000 pilot.ck >cut.ck
refused_pilot 'cut.ck' --pilot=cut.ck
file_missing no.part

# ---- refusals -------------------------------------------------------------------------------------------------------

merged kept.exr pt-1.part
cp kept.exr image.exr
# refused TEXT PART...: merging is an error, and the image stays.
refused() {
    text=$1
    shift
    expect 1 "$text" merge --no-png -o image.exr "$@"
    same image.exr kept.exr "$text: the image"
}
again() { small --integrator=pt --samples=7 --seed=3 --shard=2/3 -o other.part "$@"; }
refused 'pt-2.part and pt-2.part are the same file' pt-2.part pt-1.part pt-2.part
cp pt-2.part copy.part
refused 'pt-2.part and copy.part are both shard 2 of 3' pt-1.part pt-2.part copy.part
again --seed=4 "$scene"
refused 'other.part is of --seed=4, and pt-1.part of --seed=3' pt-1.part other.part
again --samples=8 "$scene"
refused 'other.part is of --samples=8, and pt-1.part of --samples=7' pt-1.part other.part
again --shard=2/4 "$scene"
refused 'other.part is one of 4 shards, and pt-1.part one of 3' pt-1.part other.part
again --crop=0,0,9,9 "$scene"
refused 'other.part is of --crop=0,0,9,9, and pt-1.part of --crop=0,0,40,30' pt-1.part other.part
again --layers=depth "$scene"
refused 'other.part is of --layers=depth, and pt-1.part of --layers=none' pt-1.part other.part
refused 'bdpt-2.part is of --integrator=bdpt, and pt-1.part of --integrator=pt' pt-1.part bdpt-2.part
sed 's/0\.72 0\.70/0.72 0.71/' "$scene" >other.pbrt
again other.pbrt
refused 'other.part is of another scene than pt-1.part' pt-1.part other.part
refused 'none.part cannot be merged: cannot read none.part' pt-1.part none.part
refused 'kept.exr cannot be merged: it is another kind of file' pt-1.part kept.exr
refused '. cannot be merged: it is not a regular file' pt-1.part .
small --integrator=pt --samples=2 --checkpoint=file.ck -o a.exr "$scene"
refused 'file.ck cannot be merged: it is a checkpoint of Twinlight and no part' pt-1.part file.ck
expect 1 'pt-1.part cannot be resumed: it is a part of Twinlight and no checkpoint' render --integrator=pt \
    --resolution=40x30 --samples=7 --resume=pt-1.part -o no.exr "$scene"
size=$(wc -c <pt-2.part)
head -c $((size / 2)) pt-2.part >cut.part
refused 'cut.part cannot be merged: its end is missing' pt-1.part cut.part
: >cut.part
refused 'cut.part cannot be merged: its end is missing' pt-1.part cut.part
{
    head -c $((size / 2)) pt-2.part
    head -c $((size / 2 + 1)) pt-2.part | tail -c 1 | tr '\000-\377' '\001-\377\000'
    tail -c +$((size / 2 + 2)) pt-2.part
} >flipped.part
refused 'flipped.part cannot be merged: ' pt-1.part flipped.part
if command -v zstd >/dev/null; then
    zstd -dqf pt-2.part -o state
    sed 's/version=/version=9/' state | zstd -qf -o version.part
    refused 'version.part is of Twinlight 9' pt-1.part version.part
    head -c $(($(wc -c <state) - 9)) state | zstd -qf -o short.part
    refused 'short.part cannot be merged: it ends too early' pt-1.part short.part
    { head -c 32 state && printf '\001\002\003\004\005\006\007\010' && tail -c +41 state; } | zstd -qf -o order.part
    refused 'order.part cannot be merged: it was written by a machine of another byte order' pt-1.part order.part
else
    echo 'skipped: there is no zstd to make parts that differ'
fi
expect 1 'the image would overwrite a part' merge -o a.exr a.exr
expect 2 'no name is given for the image' merge pt-1.part
expect 2 'no part is given' merge -o image.exr
expect 2 'with --shard a part is written, which is no image' render --shard=1/2 -o a.exr "$scene"
expect 2 'give --despeckle to twinlight merge' render --shard=1/2 --despeckle=3 "$scene"
expect 2 '--shard cannot be used with --verify' render --shard=1/2 --verify "$scene"
expect 2 'has no whole sample for each of 8 shards' render --integrator=pt --samples=7 --shard=1/8 "$scene"
for wrong in 0/2 3/2 1 1/ /2 1/2/3 1/65537 a/b -1/2; do
    expect 2 "--shard=$wrong: it is not of the form K/N" render --shard=$wrong "$scene"
done
small --integrator=pt --samples=4 --shard=3/4 "$scene"
file_exists cornell-3of4.part
small --integrator=pt --samples=4 --shard=3/4 --frame=7 -o 'f.%03d.part' "$scene"
file_exists f.007.part
[ -z "$(find . -name '*~')" ]
result 'a temporary file is left' $?

checks_end
