#!/bin/sh
# End-to-end tests of the program: exit statuses, messages, files and signals. Runs in the build folder; srcdir is the
# source folder (both set by `make check`).
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

# ---- help, version, usage -----------------------------------------------------------------------------------------

expect 0 'Usage: twinlight COMMAND' --help
expect 0 'Usage: twinlight COMMAND' -h
expect 0 'Backends: cpu' --version
expect 0 'Usage: twinlight render' render --help
expect 0 '--save-every=TIME' render --help
expect 0 'Usage: twinlight info' info --help
expect 0 'twinlight compare' compare --help
expect 0 'Usage: twinlight devices' devices --help
expect 0 '--max-depth=D' pyramid --help
expect 0 '--reference-time=TIME' bench --help
expect 2 'no command is given'
expect 2 'unknown command paint' paint
expect 2 'did you mean render?' rander
expect 0 '(commit ' --version
expect 2 'unknown option --verbose' --verbose

# ---- bad options --------------------------------------------------------------------------------------------------

expect 2 'no scene is given' render
expect 2 'more than one scene' render "$scene" "$scene"
expect 2 'option --fast' render --fast "$scene"
expect 2 'did you mean --seed?' render --sedd=1 "$scene"
expect 2 'is ambiguous: it may stand for --strategy, --stats' render --st=1 "$scene"
expect 2 'unknown option --verbose' render --verbose "$scene"
expect 2 'add --frame=N' render -o a.%04d.exr "$scene"
expect 2 '--frame=-1: not a whole number' render --frame=-1 "$scene"
expect 2 '--frame=3: no file name has a place for the number' render --frame=3 -o frame.exr "$scene"
expect 1 'write it as %04d' render --frame=3 --samples=1 --resolution=8x6 "$scene"
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
expect 2 '--batch is for devices' render --batch=64 "$scene"
expect 2 '--film is for devices' render --film=device "$scene"
expect 2 '--film=gpu: there is no such place' render --film=gpu "$scene"
expect 2 '--device is for devices' render --device=0 "$scene"
expect 2 '--trace is for devices' render --trace=trace.json --backend=cpu "$scene"
expect 2 '--tev=localhost: not an address and a port' render --tev=localhost "$scene"
expect 2 '--serve' render --serve=8080 "$scene"
expect 2 '--tev cannot be used with --verify' render --verify --backend=cpu --tev=localhost:9 "$scene"
expect 1 'cannot look up the host' render --samples=1 --tev=no.such.host.invalid:14158 "$scene"
expect 2 '--batch=0: out of range' render --batch=0 "$scene"
expect 2 'devices takes no file' devices "$scene"
expect 0 '  shift=on|off: ' render --help
! grep -q -e '--no-shift' -e '--chains' out
result '--help lists deprecated options' $?
expect 2 'unknown option --no-s' render --no-s "$scene"
expect 2 '--mlt is for mmlt' render --integrator=pt --mlt=chains=64 "$scene"
expect 2 '--mlt=large-step is for scheme=paper' render --integrator=mmlt --mlt=large-step=0.5 "$scene"
expect 2 '--mlt=sort=pool: there is no such value' render --integrator=mmlt --mlt=sort=pool "$scene"
expect 2 '--chains is for mmlt' render --integrator=pt --chains=64 "$scene"
expect 2 'warning: --sort is deprecated; write --mlt=sort=pool' render --integrator=mmlt --sort=pool "$scene"
expect 2 '--heuristic is not for mmlt' render --integrator=mmlt --heuristic=balance "$scene"
expect 0 '524288 chains of up to 8 segments' render --integrator=mmlt --memory "$scene"
expect 2 'use one of: pt' render --integrator=bpt "$scene"
expect 2 '--layers=normals: there is no layer normals' render --layers=normals "$scene"
expect 2 'the image of pt has no layers of light' render --integrator=pt --layers=albedo,halves "$scene"
expect 2 'the image of bdpt has no layers of light' render --integrator=bdpt --layers=by-depth "$scene"
expect 2 '--despeckle=0: out of range' render --despeckle=0 "$scene"
expect 2 '--sampler=best: there is no such sampler' render --sampler=best "$scene"
expect 2 '--reconstruction=best: there is no such reconstruction' render --reconstruction=best "$scene"
expect 2 '--heuristic=best: there is no such heuristic' render --heuristic=best "$scene"
expect 2 '--heuristic is for bidirectional integrators' render --integrator=pt --heuristic=balance "$scene"
expect 2 '--strategy is for bidirectional integrators' render --integrator=pt --strategy=1,2 "$scene"
for strategy in 1 '1,' ',2' 1,0 0,1 1,2,3 -1,2 a,b 1.5,2; do
    expect 2 "--strategy=$strategy: not a strategy" render --integrator=bdpt "--strategy=$strategy" "$scene"
done
expect 2 'bdpt has no such strategy' render --integrator=bdpt --strategy=1,1 "$scene"
expect 2 'ibpt has no such strategy' render --integrator=ibpt --strategy=2,2 "$scene"
expect 2 'add --max-depth=7' render --integrator=bdpt --strategy=4,4 --max-depth=5 "$scene"
expect 2 'paths of bdpt have at most 31 segments' render --integrator=bdpt --strategy=20,20 --max-depth=60 "$scene"
expect 2 '--unweighted without --strategy' render --integrator=bdpt --unweighted "$scene"
expect 2 'no scene is given' info
expect 2 'more than one scene' info "$scene" "$scene"
expect 2 'no scene is given' pyramid
expect 2 'does not end in .png' pyramid -o sheet.exr "$scene"
expect 2 '--max-depth=13: out of range' pyramid --max-depth=13 "$scene"
expect 2 'unknown option --crop' pyramid --crop=0,0,1,1 "$scene"
expect 2 '--device is for devices' pyramid --device=0 "$scene"
expect 2 '' compare
expect 2 '' compare one.exr

# ---- files that cannot be read or written -------------------------------------------------------------------------

expect 1 'missing.pbrt' render missing.pbrt
expect 1 'missing.pbrt' info missing.pbrt

# What emissive media send is not shown by chains.
cat >fire.pbrt <<'TEXT'
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
MakeNamedMedium "fire" "string type" "homogeneous" "rgb Le" [ 1 1 1 ]
Camera "perspective"
WorldBegin
LightSource "point"
MediumInterface "fire" ""
Material "interface"
Shape "sphere" "float radius" 0.5
TEXT
expect 2 'has a medium that emits light (Le), which chains alone do not show' render --mlt=combine=off --samples=1 fire.pbrt
expect 2 'leave --mlt=scheme=paper out' render --mlt=scheme=paper --samples=1 fire.pbrt
expect 0 '' render --samples=1 -o fire.exr fire.pbrt
expect 0 '' render --integrator=bdpt --samples=1 -o fire.exr fire.pbrt
expect 0 'media         1' info fire.pbrt
expect 1 'nowhere/image.exr' render -o nowhere/image.exr "$scene"
expect 1 'nowhere/stats.json' render --stats=nowhere/stats.json "$scene"
cp "$scene" scene.exr
expect 1 'the image would overwrite the scene: scene.exr' render -o scene.exr scene.exr
expect 1 'the statistics would overwrite the image: ./new.exr' render --stats=./new.exr -o new.exr "$scene"
expect 1 'the statistics would overwrite the scene: scene.exr' render --stats=scene.exr scene.exr
cmp -s scene.exr "$scene"
result 'the scene was overwritten' $?
file_missing new.exr
rm -f scene.exr
mkdir folder.exr
expect 1 'it is a folder' render -o folder.exr "$scene"
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked
    chmod a-w locked
    expect 1 'locked/image.exr' render -o locked/image.exr "$scene"
fi
file_missing cornell.exr

# ---- files that are no scenes, and scenes with errors -------------------------------------------------------------

not_a_scene() {
    printf '%b' "$1" >other
    expect 1 "but $2" info other
    "$program" info - <other >out 2>err
    grep -qF "but $2" err
    result "$2 on standard input" $?
}
not_a_scene '\n{ "asset": { "version": "2.0" } }' 'a JSON file'
not_a_scene 'glTF\0002' 'a binary glTF file'
not_a_scene '<?xml version="1.0"?>' 'an XML file'
not_a_scene 'ply\nformat ascii 1.0' 'a PLY mesh'
printf '\037\213\010' | "$program" info - >out 2>err
grep -qF 'but compressed by gzip' err
result 'compressed data on standard input' $?
not_a_scene 'Kaydara FBX Binary  ' 'an FBX file'
printf 'Film "image"\nWorldBegin\nMaterial "matte"\n' >v3.pbrt
expect 1 "this is a scene for pbrt-v3, as the film \"image\" shows" info v3.pbrt
[ "$(grep -c 'error: ' err)" -eq 1 ]
result 'a scene for pbrt-v3 is more than one error' $?
for line in 'MakeNamedMaterial "a" "string type" "plastic"' 'Texture "t" "color" "constant"' 'Material "uber"'; do
    printf 'WorldBegin\n%s\nShape "sphere" "float radius" -1\n' "$line" >v3.pbrt
    expect 1 'convert it by pbrt --upgrade' info v3.pbrt
    [ "$(grep -c 'error: ' err)" -eq 1 ]
    result "not one error: $line" $?
done

# Formats without a mark at their beginning are known by their names.
named_other() {
    printf '# by some program\nv 1 2 3\n' >"$1"
    expect 1 "but $2" info "$1"
}
named_other mesh.obj 'a Wavefront OBJ mesh'
named_other scene.lxs 'a LuxRender scene'
named_other scene.usdc 'a USD file'

# info --needs lists all that a scene uses, without its files, and what of that is not supported.
printf '%s\n' 'Film "rgb"' 'WorldBegin' 'LightSource "point"' 'Material "diffuse"' 'Shape "sphere"' 'Shape "sphere"' \
    'Material "diffuse" "string normalmap" "no.png"' 'Shape "plymesh" "string filename" "no.ply"' >needs.pbrt
expect 0 '' info --needs needs.pbrt
grep -q '^ *2  supported      Shape               sphere$' out && grep -q 'Shape               plymesh$' out
result 'what a scene uses' $?
printf '%s\n' 'Film "rgb" "float maxcomponentvalue" 3' 'Camera "realistic"' 'WorldBegin' 'Material "measured"' 'Shape "sphere"' \
    'Material "measured"' 'Shape "nosuch"' 'Include "missing.pbrt"' 'Shape "sphere" "float radius" -1' \
    'TransformTimes 0 1 ActiveTransform EndTime' 'Translate 1 0 0' 'Shape "disk"' 'Shape "disk"' >needs.pbrt
expect 1 'needs.pbrt needs what is not supported' info --needs needs.pbrt
for row in '1  approximated   Film                rgb  (needs.pbrt:1:' '1  not supported  Camera              realistic' \
    '2  not supported  Material            measured  (needs.pbrt:4:1; diffuse' '2  supported      Shape               sphere' \
    '1  not supported  Shape               nosuch  (needs.pbrt:7:1; use' \
    '1  error          error               cannot read missing.pbrt' \
    '2  not supported  feature             motion (a transform that differs'; do
    grep -qF " $row" out
    result "a need is missing: $row" $?
done
[ "$(grep -c 'error: ' err)" -eq 1 ]
result 'a list of needs with other messages' $?
expect 1 '--needs lists what pbrt scenes use' info --needs none.gltf
printf 'Camera "realistic"\nWorldBegin\nShape "sphere"\n' | "$program" info --needs - >out 2>err
[ $? -eq 1 ]
result 'a scene that is not supported, without errors, is' $?
"$program" info --needs --json needs.pbrt >out 2>err
tr -d ' \n' <out | grep -qF '"kind":"Material","name":"measured","count":2,"status":"notsupported"'
result 'needs as JSON' $?

# A coat that scatters is approximated, and its texture is not read.
printf '%s\n' 'WorldBegin' 'Texture "t" "float" "imagemap" "string filename" "no.png"' \
    'Material "coatedconductor" "texture thickness" "t" "rgb albedo" [ 0.1 0.1 0.1 ]' 'Shape "sphere"' 'Material "none"' \
    'Shape "sphere"' >needs.pbrt
expect 0 '' info --needs needs.pbrt
grep -qF ' 1  supported      Material            none' out
result 'an older name of a material is supported' $?
grep -qF ' 1  approximated   Material            coatedconductor  (needs.pbrt:3:1' out
result 'a scattering coat is approximated' $?

# Every error is reported once, in order, but not what follows from another, such as the material that line 5 fails to
# make.
printf '%s\n' 'Film "rgb" "integer xresolution" [ -3 ]' 'Camera "perspectiv"' 'WorldBegin' 'Material "matted"' \
    'MakeNamedMaterial "a" "string type" "diffus"' 'NamedMaterial "a"' 'Shape "sphere" "float radius" [ x ]' \
    'Shape "sphere"' 'AttributeBegin' 'LightSource "pointy"' 'WorldBegin' >wrong.pbrt
expect 1 '' info wrong.pbrt
grep -o '^wrong.pbrt:[0-9]*' err | cut -d: -f2 | tr '\n' ' ' >lines
[ "$(cat lines)" = '1 2 4 5 7 10 11 9 ' ]
result "errors of lines $(cat lines), not of 1 2 4 5 7 10 11 9" $?
[ "$(grep -c '  fix: ' err)" -eq 8 ]
result 'not every error says what to do' $?
# So are the errors of what a scene includes, and of its meshes.
printf '%s\n' 'WorldBegin' 'Shape "sphere" "float radius" -1' 'Include "part.inc"' \
    'Shape "plymesh" "string filename" "bad.ply"' 'LightSource "pointy"' >wrong.pbrt
printf '%s\n' 'Shape "disk" "float radius" -1' 'Shape "sphere" "float radius" -2' >part.inc
printf 'ply\nformat ascii 1.0\nelement vertex 3\n' >bad.ply
expect 1 '' info wrong.pbrt
grep -o '^[a-z.]*:[0-9]*' err | tr '\n' ' ' >lines
[ "$(cat lines)" = 'wrong.pbrt:2 part.inc:1 part.inc:2 wrong.pbrt:4 wrong.pbrt:5 ' ]
result "errors at $(cat lines)" $?
for directive in Shape Shape Shape; do
    printf "WorldBegin\n%s\n" "$directive"
done | "$program" info - >out 2>err
[ "$(grep -c 'error: ' err)" -lt 6 ]
result 'one missing string is many errors' $?
{
    echo WorldBegin
    for i in $(seq 40); do
        echo "Material \"m$i\""
    done
} >many.pbrt
expect 1 'there may be more errors than these 20' info many.pbrt
[ "$(grep -c 'error: unknown material' err)" -eq 20 ]
result 'not 20 errors' $?
echo 'Shape "sphere" Material "diffuse" LightSource "point"' >early.pbrt
expect 1 'Shape must stand after WorldBegin' info early.pbrt
[ "$(grep -c 'error: ' err)" -eq 1 ]
result 'a missing WorldBegin is several errors' $?

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
render -o upper.EXR "$scene"
file_exists upper.EXR
file_exists upper.png

render --stats=- --frame=7 -o 'frame%d.%04d.exr' - <"$scene"
result 'a scene from standard input: exit status' $?
file_exists frame7.0007.exr
file_exists frame7.0007.png
grep -q '"image": "frame7.0007.exr"' out
result 'no statistics on standard output' $?
file_missing -
grep -v '"string filename"' "$scene" | render -
file_exists stdin.exr
render -o plain2.exr "$scene"
"$program" render --integrator=pt --resolution=16x12 --spp=1 -j 2 -o short.exr "$scene" >out 2>err
cmp plain2.exr short.exr
result '--spp and -j are not --samples and --threads' $?

# shellcheck disable=SC2016 # for bash to expand
completes() {
    bash -c 'compopt() { :; }; source "$1"; shift; program=$1; shift
        COMP_WORDS=(twinlight "$@"); COMP_CWORD=$#; _twinlight "$program"; echo "${COMPREPLY[*]}"' \
        bash "$completion" "$program" "$@"
}
completion=${scene%/scenes/*}/man/bash/twinlight
[ "$(completes pyr)" = pyramid ] && [ "$(completes render --integ)" = --integrator= ] &&
    [ "$(completes render --unw)" = --unweighted ] && [ "$(completes render --png)" = --png= ] &&
    [ "$(completes render --backend = op)" = opencl ] && [ "$(completes compare --no)" = "$(
        "$program" compare --help | grep -o -- '--no[a-z-]*' | paste -s -d ' ')" ]
result 'completion in bash' $?

render --threads=1 -o one.exr "$scene"
render --threads=3 -o three.exr "$scene"
cmp one.exr three.exr
result 'the image depends on the number of threads' $?
render --seed=7 -o seed.exr "$scene"
! cmp -s one.exr seed.exr
result '--seed changes nothing' $?
[ -z "$(find . -name '*~')" ] # see base/output_file.c
result 'a temporary file is left' $?

render --integrator=bdpt --max-depth=40 -o deep.exr "$scene"
result 'bdpt: exit status' $?
[ "$(grep -c 'warning: bdpt makes paths of up to 31 segments' err)" -eq 1 ]
result '--max-depth=40 for bdpt: not one warning' $?
render --integrator=bdpt --max-depth=31 --quiet -o limit.exr "$scene"
[ ! -s err ]
result '--max-depth=31 for bdpt: a warning' $?
cmp deep.exr limit.exr
result 'the image beyond the limit of depth is not that at the limit' $?
render --integrator=bdpt --heuristic=balance --max-depth=3 -o balance.exr "$scene"
render --integrator=bdpt --heuristic=power --max-depth=3 -o power.exr "$scene"
! cmp -s balance.exr power.exr
result '--heuristic changes nothing' $?
render --integrator=bdpt --sampler=independent --max-depth=3 -o independent.exr "$scene"
render --integrator=bdpt --sampler=sobol --max-depth=3 -o sobol.exr "$scene"
! cmp -s independent.exr sobol.exr
result '--sampler changes nothing' $?
cmp -s sobol.exr power.exr
result 'sobol is not the default' $?
render --integrator=mmlt --sampler=independent --max-depth=3 -o independent.exr "$scene"
render --integrator=mmlt --max-depth=3 -o sobol.exr "$scene"
! cmp -s independent.exr sobol.exr
result '--sampler changes nothing of mmlt' $?
# of a filter that covers neighbouring pixels
grep -v PixelFilter "$scene" | sed 's/^WorldBegin/PixelFilter "gaussian"\nWorldBegin/' >gaussian.pbrt
grep -v PixelFilter "$scene" | sed 's/^WorldBegin/PixelFilter "box"\nWorldBegin/' >box.pbrt
for integrator in pt ibpt mmlt; do
    for reconstruction in sample splat; do
        render --integrator=$integrator --reconstruction=$reconstruction --max-depth=3 -o $reconstruction.exr gaussian.pbrt
        render --integrator=$integrator --reconstruction=$reconstruction --max-depth=3 -o box_$reconstruction.exr box.pbrt
    done
    render --integrator=$integrator --max-depth=3 -o default.exr gaussian.pbrt
    cmp -s splat.exr default.exr
    result "splat is not the default of $integrator" $?
    ! cmp -s sample.exr splat.exr
    result "--reconstruction changes nothing of $integrator" $?
    cmp -s box_sample.exr box_splat.exr
    result "--reconstruction changes a box of one pixel ($integrator)" $?
done
render --integrator=bdpt --strategy=1,2 --max-depth=3 -o weighted.exr "$scene"
render --integrator=bdpt --strategy=1,2 --unweighted --max-depth=3 -o unweighted.exr "$scene"
! cmp -s weighted.exr unweighted.exr
result '--unweighted changes nothing' $?

render --crop=4,2,12,10 -o crop.exr "$scene"
result '--crop: exit status' $?
file_exists crop.exr

for threads in 1 2; do
    "$program" pyramid --resolution=16x12 --samples=1 --max-depth=3 --threads=$threads --quiet -o sheet$threads.png "$scene"
    result 'pyramid: exit status' $?
done
cmp sheet1.png sheet2.png
result 'the sheet depends on the number of threads' $?
"$program" pyramid --resolution=16x12 --samples=1 --max-depth=3 --unweighted --quiet -o sheet3.png "$scene"
! cmp -s sheet1.png sheet3.png
result 'pyramid: --unweighted changes nothing' $?

expect 0 'lights        2' info "$scene"
expect 0 '"feature_mask"' info --json "$scene"

# A single vertex far from all others causes a warning.
far() {
    {
        echo 'LookAt 0 -3 2  0 0 0  0 0 1 Camera "perspective" WorldBegin LightSource "infinite" AttributeBegin'
        for _ in 1 2 3 4 5 6 7 8 9; do
            echo 'Translate .1 0 0 Shape "sphere" "float radius" .05'
        done
        echo "AttributeEnd Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 $1 0 ] \"integer indices\" [ 0 1 2 ]"
    } >far.pbrt
}
far 1e6
expect 0 '1 of the primitives and instances reaches as far as 1e+06' render --resolution=4x4 --spp=1 -o far.exr far.pbrt
far 10
expect 0 '' render --resolution=4x4 --spp=1 -o far.exr far.pbrt
! grep -q 'of the primitives' err
result 'a vertex that is not far is said to be' $?

# A warning says that light is missing if no path can carry it: the glass is smooth and the sun a point. Not if it is
# rough.
pool() {
    printf '%s\n' 'WorldBegin LightSource "distant"' 'Material "diffuse"' \
        'Shape "bilinearmesh" "point3 P" [ -9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9 ]' \
        "Material \"dielectric\" \"float roughness\" $1" \
        'Shape "bilinearmesh" "point3 P" [ -9 0 -9  9 0 -9  -9 0 9  9 0 9 ]' >pool.pbrt
}
pool 0
expect 0 'is found by photons alone' render --resolution=4x4 --samples=1 --integrator=pt -o pool.exr pool.pbrt
sed 's/radius" \[ 0.22 \]/radius" [ 0.0022 ]/; s/440 405 335/4400000 4050000 3350000/' "${scene%/*}/pool.pbrt" >small.pbrt
expect 0 'caustic photons predict miss the light' render --resolution=4x4 --samples=1 --photons=256 --integrator=pt -o pool.exr small.pbrt
expect 0 '' render --resolution=4x4 --samples=1 --photons=65536 --integrator=pt -o pool.exr small.pbrt
! grep -q 'miss the light' err
result 'a warning of photons that predict well' $?
pool 0.3
expect 0 '' render --resolution=4x4 --samples=1 --integrator=pt -o pool.exr pool.pbrt
! grep -q 'is found by photons alone' err
result 'rough glass is taken for smooth' $?
pool 0
for by in --integrator=mmlt '--integrator=pt --photons=4096'; do
    # shellcheck disable=SC2086 # two options
    expect 0 '' render --resolution=4x4 --samples=1 $by -o pool.exr pool.pbrt
    ! grep -q 'is found by photons alone' err
    result "photons are not counted with $by" $?
    ! grep -q 'is scattered in a medium' err
    result "a medium that is not there scatters with $by" $?
done
printf '%s\n' 'MakeNamedMedium "mist" "string type" "homogeneous" MediumInterface "mist" ""' \
    'Material "interface" Shape "sphere" "float radius" 0.1' >>pool.pbrt
expect 0 'is scattered in a medium and passes others after that is missing' \
    render --resolution=4x4 --samples=1 --integrator=mmlt -o pool.exr pool.pbrt

# Contributions too faint compared with the rest count as black, and a message says for how much of the image.
printf '%s\n' 'LookAt 0 1 -6  0 0 0  0 1 0 Camera "perspective" WorldBegin' \
    'LightSource "infinite" "rgb L" [ 1e-12 1e-12 1e-12 ]' 'LightSource "point" "point3 from" [ 0 2 0 ]' \
    'Material "diffuse" Shape "bilinearmesh" "point3 P" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]' >faint.pbrt
expect 0 'too faint for the film' render --resolution=8x8 --samples=4 --integrator=bdpt --stats=faint.json \
    -o faint.exr faint.pbrt
! grep -q '"film_vanished": 0' faint.json
result 'film_vanished is 0' $?
expect 0 '' render --resolution=8x8 --samples=4 --integrator=bdpt -o one.tmp.exr "$scene"
! grep -q 'too faint' err
result 'a picture is said to be too faint' $?

# ---- compare ------------------------------------------------------------------------------------------------------

expect 0 '' compare one.exr three.exr
expect 1 '' compare one.exr crop.exr
expect 1 'missing.exr' compare one.exr missing.exr
expect 2 'does not end in .png' compare --side-by-side=sheet.exr one.exr three.exr
expect 2 '--pixels-per-degree=0: out of range' compare --pixels-per-degree=0 one.exr three.exr
expect 0 'FLIP             0  (exposure 1, 30 pixels per degree)' compare --exposure=1 --pixels-per-degree=30 one.exr three.exr
expect 0 'SSIM             1' compare one.exr three.exr
expect 0 'z-test           none' compare one.exr three.exr
for seed in 1 2; do
    render --integrator=mmlt --layers=halves --seed=$seed -o halves$seed.exr "$scene"
done
render --integrator=mmlt -o usual.exr "$scene"
expect 0 'z-test           none' compare usual.exr halves1.exr
# header CHANNEL FILE: whether the EXR has the channel; a name ends with a zero byte, so that A is not all that ends in it
header() {
    head -c 4096 "$2" | tr '\0' '\n' | grep -aqx "$1"
}
header albedo.R usual.exr && header normal.X usual.exr && header Z usual.exr && header A usual.exr && ! header halfA.R usual.exr
result 'mmlt has other layers than albedo, normal, depth and alpha by default' $?
render --integrator=mmlt --max-depth=2 --layers=direct,indirect -o short.exr "$scene"
header direct.R short.exr && header indirect.R short.exr
result 'no layers of light where no path is long enough for chains' $?
expect 0 'z-test           no difference found' compare --side-by-side=sheet.png halves1.exr halves2.exr
file_exists sheet.png
expect 0 '"z_test": {' compare --json halves1.exr halves2.exr

# ---- statistics ---------------------------------------------------------------------------------------------------

render --seed=18446744073709551615 --stats=stats.json -o stats.exr "$scene"
result '--stats: exit status' $?
for key in format version scene file width height crop max_depth primitives instances materials lights bytes \
    integrator backend device seed threads samples_per_pixel samples samples_per_second photons openings stopped seconds load build \
    render write total rays closest shadow seconds_all_threads per_second peak_memory_bytes backend_bytes diagnostics \
    film_saturated film_full_pixels film_vanished film_not_finite degenerate_triangles zero_area_lights substitutions warnings kernels image png; do
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

# ---- OpenCL ---------------------------------------------------------------------------------------------------------

expect 0 'the same image, bit for bit      promised' devices
expect 0 '"same_bits": true' devices --json

# opencl ARGUMENT...: a small rendering on device 0.
opencl() {
    render --backend=opencl "$@"
}

if ! "$program" --version | grep -q opencl; then
    expect 2 'configured without OpenCL' render --backend=opencl "$scene"
elif "$program" devices | grep -A1 '^opencl' | grep -q 'no device'; then
    expect 1 'there is no OpenCL device' render --backend=opencl "$scene"
    echo 'skipped: there is no OpenCL device'
else
    for other in "$scene" "${scene%/*}/showcase.pbrt"; do
        for integrator in pt ibpt bdpt mmlt; do
            case $integrator in pt) layers=all ;; mmlt) layers=indirect,by-depth ;; *) layers=none ;; esac
            render --integrator=$integrator "--layers=$layers" --samples=3 -o cpu.exr "$other"
            opencl --integrator=$integrator "--layers=$layers" --samples=3 -o opencl.exr "$other"
            result "$other on OpenCL by $integrator: exit status" $?
            cmp cpu.exr opencl.exr
            result "$other by $integrator: OpenCL's image is not the CPU's" $?
        done
    done
    expect 1 'there is no OpenCL device with that number' render --backend=opencl --device=99 "$scene"
    expect 1 'no OpenCL device has that in its name' render --backend=opencl --device=nonesuch "$scene"
    expect 1 'use --batch=' render --backend=opencl --batch=67108864 --quiet -o batch.exr "$scene"
    file_missing batch.exr
    expect 1 'nowhere/trace.json' render --backend=opencl --trace=nowhere/trace.json "$scene"

    # Another source folder is another program, built from what is there.
    cp -r "${scene%/*/*}"/shared sources
    echo 'this is not OpenCL' >>sources/bsdf/fresnel.h
    line=$(wc -l <sources/bsdf/fresnel.h)
    TWINLIGHT_KERNELS=$work/sources expect 1 "shared/bsdf/fresnel.h:$line" render --backend=opencl "$scene"
    TWINLIGHT_KERNELS=$work/none expect 1 "$work/none/kernels.cl" render --backend=opencl "$scene"

    # A device that fails during rendering: batches 0 ... 63 are the pilot's 4096 paths, followed by three of 64 paths
    # each.
    TWINLIGHT_TEST_FAIL_BATCH=66 expect 1 'what was finished, 0.666667 samples per pixel, is in fail.exr' \
        render --integrator=pt --backend=opencl --batch=64 --resolution=16x12 --samples=1 -o fail.exr "$scene"
    file_exists fail.exr
    file_exists fail.png

    opencl --trace=trace.json --stats=device.json --batch=64 -o traced.exr "$scene"
    result '--trace: exit status' $?
    if command -v python3 >/dev/null 2>&1; then
        python3 - <<'PYTHON'
import json
events = [e for e in json.load(open("trace.json"))["traceEvents"] if e["ph"] == "X"]
names = {e["name"] for e in events}
assert {"trace_closest", "pt_shade_hits", "copy splats", "add to film"} <= names, names
assert all(e["ts"] >= 0 and e["dur"] >= 0 for e in events)
assert {e["args"]["batch"] for e in events} == set(range(67))
stats = json.load(open("device.json"))
assert stats["backend"] == "opencl" and stats["device"] and stats["rays"]["closest"] >= 192
assert stats["rays"]["seconds_all_threads"] > 0
PYTHON
        result 'trace.json or device.json is not what it should be' $?
    fi
fi

# ---- long runs: signals, saving -----------------------------------------------------------------------------------

# long_render ARGUMENT...: renders in the background, process number in $process; ends after three minutes in any case.
long_render() {
    $with_signals "$program" render --quiet --resolution=32x32 --time=180s "$@" "$scene" >out 2>err &
    process=$!
}

for signal in INT TERM; do
    every=0.2s
    [ $signal = INT ] || every=10m # the first image is written at once
    long_render --save-every=$every --stats=$signal.json -o $signal.exr
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

# The given time ends the rendering and is used up; by how much it is exceeded depends on the machine. More than a
# minute counts as hanging.
timeout 60 "$program" render --quiet --resolution=32x32 --time=1s --stats=time.json -o time.exr "$scene"
result '--time: exit status' $?
grep -q '"stopped": false' time.json
result '--time: the statistics say that it was stopped' $?
awk -F'[:,]' '/"render"/ { used = $2 } END { exit !(used >= 0.9) }' time.json
result '--time=1s: rendering took less' $?
file_exists time.exr

# ---- few resources ------------------------------------------------------------------------------------------------

# limited STATUS TEXT LIMIT...: a rendering under bash's ulimit.
limited() {
    expected=$1
    text=$2
    shift 2
    # shellcheck disable=SC2016 # for bash to expand
    bash -c 'program=$1 scene=$2; shift 2; ulimit "$@" && exec "$program" render --spp=1 --resolution=16x16 --no-png -o limited.exr "$scene"' \
        bash "$program" "$scene" "$@" >out 2>err
    status=$?
    [ "$status" -eq "$expected" ] && grep -qF -- "$text" err
    result "ulimit $*: exit status $status, not $expected, or no \"$text\"" $?
}
# A sanitizer needs terabytes of address space, and its own stack.
if ! grep -q '^SANITIZE_CFLAGS = .*fsanitize' "$build/Makefile"; then
    limited 1 'ulimit -s 8192' -s 128
    limited 0 '' -Ss 128
    # Where memory runs out depends on the machine, but there must always be a message.
    for kilobytes in 185000 190000 195000 200000 210000; do
        # shellcheck disable=SC2016 # for bash to expand
        bash -c 'ulimit -v $3 && exec "$1" render --spp=1 --resolution=16x16 --no-png -o limited.exr "$2"' \
            bash "$program" "$scene" $kilobytes >out 2>err
        status=$?
        [ $status -eq 0 ] || { [ $status -eq 1 ] && grep -q 'error: ' err; }
        result "$kilobytes KiB of address space: exit status $status, or no error" $?
    done
fi

# A log line must not land in the image.
"$program" render --spp=1 --resolution=16x16 --no-png -o closed.exr far.pbrt 2>&-
result 'standard error closed: exit status' $?
"$program" compare closed.exr closed.exr >out 2>err
result 'standard error closed: the image cannot be read' $?

# ---- values that floats cannot hold -------------------------------------------------------------------------------

bright() {
    echo "LookAt 0 -3 2  0 0 0  0 0 1 Camera \"perspective\" $1 WorldBegin LightSource \"infinite\" \"rgb L\" [ $2 $2 $2 ]" \
        'Shape "sphere" "float radius" .5' >bright.pbrt
}
bright 'Film "rgb" "float iso" [ 1e22 ]' 1e20
expect 0 '256 of 256 pixels (100 %) exceed the range of a float' render --resolution=16x16 --spp=1 --integrator=pt \
    -o bright.exr bright.pbrt
bright '"float lensradius" [ 1e20 ] "float focaldistance" [ 3 ]' 1
expect 1 "the camera's lens has a radius of 1e+20" render --resolution=16x16 --spp=1 --integrator=pt -o bright.exr bright.pbrt

# Camera space may have any scale.
for scale in 1 1.1368683772161603e-13 9223372036854775808; do # powers of two: not even a bit changes
    {
        echo "Scale $scale $scale $scale"
        cat "$scene"
    } >scaled.pbrt
    render --integrator=bdpt -o scaled$scale.exr scaled.pbrt
done
"$program" compare scaled1.exr scaled1.1368683772161603e-13.exr | grep -q '^relMSE  *0$' &&
    "$program" compare scaled1.exr scaled9223372036854775808.exr | grep -q '^relMSE  *0$'
result 'the image depends on the scale of camera space' $?

checks_end
