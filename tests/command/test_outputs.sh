#!/bin/sh
# Results reach the disk in all circumstances, and nothing else is overwritten: memory, signals, failing saves,
# temporary files of dead processes, different names of one file. Runs as tests/command/test_cli.sh does.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

milliseconds() {
    echo $(($(date +%s%N) / 1000000))
}

# no_temporary WHAT: there must be no temporary file.
no_temporary() {
    [ -z "$(find . -name '*~')" ]
    result "$1: a temporary file is left" $?
}

# ---- different names of one file ----------------------------------------------------------------------------------

expect 1 'the statistics would overwrite the image: ./o.exr' render --stats=./o.exr -o o.exr "$scene"
mkdir there
ln -s there linked
expect 1 'the statistics would overwrite the image' render --stats=linked/o.exr -o there/o.exr "$scene"
expect 1 'the statistics would overwrite the image' render "--stats=$work/o.exr" -o o.exr "$scene"
ln -s o.exr dangling.exr
expect 1 'the statistics would overwrite the image' render --stats=dangling.exr -o o.exr "$scene"
file_missing o.exr
[ -L dangling.exr ]
result 'a symbolic link is gone' $?

# A symbolic link is followed, whether its target exists or not.
for turn in first second; do
    render -o dangling.exr "$scene"
    file_exists o.exr
    [ -L dangling.exr ]
    result "the $turn rendering replaced a symbolic link" $?
done
rm -f o.exr dangling.exr dangling.png

# Files of the scene: the scene file, included files, textures.
render -o texture.exr "$scene"
cp texture.png kept.png
printf 'Include "part.exr"\n' >whole.pbrt
printf '%s\n' 'WorldBegin Texture "t" "spectrum" "imagemap" "string filename" "texture.png"' \
    'Material "diffuse" "texture reflectance" "t" LightSource "infinite" Shape "sphere"' >part.exr
cp part.exr kept.pbrt
expect 1 'the PNG would overwrite a file that the scene reads: texture.png' \
    render --resolution=4x4 --samples=1 -o texture.exr whole.pbrt
expect 1 'the image would overwrite a file that the scene reads: part.exr' \
    render --resolution=4x4 --samples=1 -o part.exr whole.pbrt
expect 1 'the sheet would overwrite a file that the scene reads' \
    pyramid --resolution=4x4 --samples=1 --max-depth=2 -o ./texture.png whole.pbrt
cmp -s texture.png kept.png && cmp -s part.exr kept.pbrt
result 'a file of the scene was overwritten' $?
# shellcheck disable=SC2094 # that is the test
"$program" render --quiet --resolution=4x4 --samples=1 -o streams.exr "$scene" >out 2>streams.exr
[ $? -eq 1 ]
result 'the image overwrites the messages' $?
rm -f streams.exr

render --seed=2 -o a.exr "$scene"
render --seed=3 -o b.exr "$scene"
cp a.exr kept.exr
ln a.exr hard.exr
expect 1 'the error image would overwrite the image' compare -o ./a.exr a.exr b.exr
expect 1 'the error image would overwrite the image' compare -o hard.exr a.exr b.exr
expect 1 'the error image would overwrite the reference' compare -o b.exr a.exr b.exr
expect 1 'the pictures side by side would overwrite the error image' compare -o c.png --side-by-side=./c.png a.exr b.exr
cmp -s a.exr kept.exr
result 'compare has overwritten an image' $?
cp "$scene" bench.json
expect 1 'the data would overwrite a scene' bench -o bench.html --times=1s bench.json
cmp -s bench.json "$scene"
result 'bench has overwritten a scene' $?

# ---- temporary files of dead processes ----------------------------------------------------------------------------

: >a.exr.999999-0~
: >a.exr.12-x~
: >aa.exr.999999-0~
: >held.exr.999999-0~
flock held.exr.999999-0~ sleep 60 &
holder=$!
tries=0
while flock -n held.exr.999999-0~ true && [ "$tries" -lt 100 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
render -o a.exr "$scene"
render -o held.exr "$scene"
file_missing a.exr.999999-0~
[ -e a.exr.12-x~ ] && [ -e aa.exr.999999-0~ ]
result 'a file that is no stray of this name is removed' $?
[ -e held.exr.999999-0~ ]
result 'the temporary file of a living process is removed' $?
kill $holder
wait $holder 2>/dev/null
rm -f ./*~

# ---- memory -------------------------------------------------------------------------------------------------------

# Sanitizers reserve terabytes of address space.
# shellcheck disable=SC3045 # dash and bash have it
if (ulimit -v 921600 && "$program" --version) >out 2>&1; then
    (
        ulimit -v 921600
        "$program" render --quiet --integrator=pt --resolution=3000x2000 --samples=1 --max-depth=2 --threads=2 -o large.exr "$scene"
    ) >out 2>err
    result '3000 x 2000 pixels in 900 MB: exit status' $?
    file_exists large.exr
    file_exists large.png
    rm -f large.*
else
    echo 'skipped: no limit of address space'
fi

# ---- stopping -----------------------------------------------------------------------------------------------------

# begin ARGUMENT...: starts a long rendering in the background, process number in $process.
begin() {
    rm -f s.exr s.png s.json
    $with_signals "$program" render --time=180s --threads=2 --stats=s.json -o s.exr "$@" >out 2>err &
    process=$!
}

# ended WHAT MILLISECONDS: the rendering must end with an image and status 130, at most this long after `sent`.
ended() {
    wait $process
    status=$?
    took=$(($(milliseconds) - sent))
    [ $status -eq 130 ]
    result "$1: exit status $status" $?
    [ $took -le "$2" ]
    result "$1: it took $took ms" $?
    file_exists s.exr
    file_exists s.png
    grep -q '"stopped": true' s.json
    result "$1: the statistics do not say so" $?
    no_temporary "$1"
}

# Images whose first sample of every pixel takes longer than the two seconds after which they are stopped, on two cores
# that are idle: glossy surfaces, and long paths. Writing takes a moment as well.
slow=${scene%/*}/glossy.pbrt
for integrator in pt bdpt ibpt mmlt; do
    case $integrator in pt) size=2500x2000 ;; *) size=1000x2000 ;; esac
    begin --quiet --integrator=$integrator --resolution=$size --max-depth=31 "$slow"
    sleep 2
    sent=$(milliseconds)
    kill -s TERM $process
    ended "SIGTERM during the first sample, $integrator" 9000
    grep -qE 'warning: [0-9]+ of (2|5)000000 pixels have no sample' err
    result "$integrator: no warning about pixels without samples" $?
done

# `timeout` signals its child and then the child's group: two signals count as one. The last two are for failing writes.
for signal in INT TERM HUP XFSZ PIPE; do
    begin --quiet --resolution=32x32 "$scene"
    sleep 1
    sent=$(milliseconds)
    kill -s "$signal" $process
    kill -s TERM $process
    ended "SIG$signal and SIGTERM at once" 20000
done

# A stop before anything is rendered, detected by the list of chains, does not replace an existing image.
begin --quiet --threads=1 --resolution=400x400 --max-depth=31 --dump-bad=bad.json "$slow"
cp a.exr s.exr
list=
until [ -n "$list" ] && sleep 0.02 && [ -e "$list" ]; do # a file that only tries the folder is gone by then
    kill -s 0 $process || break
    list=$(find . -name 'bad.json.*~' | head -n 1)
done
kill -s TERM $process
wait $process
[ $? -eq 130 ]
result 'a stop before the first sample: exit status' $?
cmp -s a.exr s.exr
result 'an image without samples has replaced another' $?
grep -q 'warning: s.exr is left unchanged' err
result 'no warning about an image that is left unchanged' $?

# The photons of a small lamp over water take some seconds of two cores. Without them there is nothing to render yet.
sed -e 's/"rgb L" \[ 440 405 335 \]/"rgb L" [ 4400000 4050000 3350000 ]/' -e 's/\[ 0.22 \]/[ 0.0022 ]/' \
    "${scene%/*}/pool.pbrt" >small.pbrt
grep -q 'radius" \[ 0.0022 \]' small.pbrt
result 'the lamp of pool.pbrt is not what this script takes it for' $?
for integrator in pt mmlt; do
    begin --integrator=$integrator --resolution=32x32 --photons=1048576 small.pbrt
    sleep 0.5
    sent=$(milliseconds)
    kill -s INT $process
    ended "SIGINT while photons are made, $integrator" 3000
    grep -q '"photons": 0' s.json
    result "$integrator: the stop came after the photons" $?
    grep -q 'warning: 1024 of 1024 pixels have no sample' err
    result "$integrator: no warning about an image without samples" $?
done

# Nobody reads the messages any more: all files are written, the statistics included.
("$program" render --time=1s --resolution=32x32 --stats=s.json -o s.exr "$scene" 2>&1 >/dev/null; echo $? >status) | true
wait_for status
[ "$(cat status)" -eq 0 ]
result "messages that nobody reads: exit status $(cat status)" $?
file_exists s.exr
file_exists s.json

# An inherited ignored signal stays ignored.
(
    trap '' INT HUP
    exec "$program" render --quiet --resolution=32x32 --time=3s --stats=s.json -o s.exr "$scene"
) >out 2>err &
process=$!
sleep 1
kill -s INT $process
kill -s HUP $process
wait $process
result 'ignored signals end a rendering' $?
grep -q '"stopped": false' s.json
result 'ignored signals end a rendering' $?

# ---- writing ------------------------------------------------------------------------------------------------------

# Writing to a pipe takes long if its reader waits.
mkfifo late.png
{ sleep 3 && cat >/dev/null; } <late.png &
reader=$!
"$program" render --resolution=400x400 --samples=1 --threads=2 --integrator=pt --png=late.png -o late.exr "$scene" >out 2>err
result 'a PNG to a pipe: exit status' $?
wait $reader
grep -q '^writing late.png' err
result 'a long write does not say so' $?

# A second signal during a write ends the program without leaving a temporary file. The one checked here is that of
# --dump-bad, which is open all the time; the image's would be removed in the same way.
# shellcheck disable=SC2217 # it only has to keep the pipe open
sleep 60 <late.png &
reader=$!
begin --quiet --resolution=400x400 --png=late.png --dump-bad=bad.json "$scene"
sleep 2
[ -n "$(find . -name 'bad.json.*~')" ]
result 'there is no temporary file to be left' $?
kill -s TERM $process
wait_for s.exr
sleep 2
kill -s TERM $process
wait $process
[ $? -eq 130 ]
result 'a second signal: exit status' $?
no_temporary 'a second signal'
kill $reader
wait $reader 2>/dev/null
rm -f late.* bad.json

# ---- failing saves ------------------------------------------------------------------------------------------------

# The folder does not exist for a while.
mkdir disk
$with_signals "$program" render --time=180s --threads=2 --resolution=32x32 --save-every=0.2s --stats=s.json -o disk/s.exr \
    "$scene" >out 2>err &
process=$!
wait_for disk/s.exr
mv disk gone
sleep 1
mv gone disk
sleep 1
rm -f disk/s.exr
wait_for disk/s.exr
kill -s TERM $process
wait $process
[ $? -eq 130 ]
result 'saves that fail for a while: exit status' $?
file_exists disk/s.exr
[ "$(grep -c 'warning: cannot write disk/s.exr.*saving will be tried again' err)" -eq 1 ]
result 'saves that fail: not one warning' $?
grep -q 'saving the image succeeded again' err
result 'nothing says that saving works again' $?

# If the last write fails, that is an error, and the existing file stays.
"$program" render --quiet --time=2s --threads=2 --resolution=32x32 -o disk/t.exr "$scene" >out 2>err &
process=$!
sleep 1
cp a.exr disk/t.exr
mv disk gone
wait $process
[ $? -eq 1 ]
result 'the last save fails: exit status' $?
cmp -s a.exr gone/t.exr
result 'a save that failed has changed the old file' $?

checks_end
