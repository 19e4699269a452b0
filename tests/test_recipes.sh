#!/bin/sh
# The recipes of ARCHITECTURE.md, followed to the letter in a copy of the sources: a BSDF, a light, an integrator and two
# layers, each of at most as many files as its recipe says. The copy builds, renders all of them on every backend with
# the same image, and passes the tests that they are in by their cases. Runs in the build folder; srcdir is the source
# folder.
srcdir=${srcdir:-$(dirname "$0")/..}
top=$(cd "$srcdir" && pwd) || exit 99
here=$(pwd)
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
status=0

fail() {
    echo "FAILED: $*"
    status=1
}

# edit FILE SED: changes a file of the copy; an edit that changes nothing is a recipe that no longer holds.
edit() {
    cp "$1" "$work/before"
    sed -i "$2" "$1"
    ! cmp -s "$1" "$work/before" || fail "$1 has no place for: $2"
}

# files AT_MOST WHAT: how many files of the copy differ from those before, which are then the same.
files() {
    changed=$(diff -rq "$work/last" "$work/copy" | grep -c .)
    [ "$changed" -le "$1" ] || fail "$2 takes $changed files, not $1"
    echo "$2: $changed files"
    rm -rf "$work/last"
    cp -r "$work/copy" "$work/last"
}

mkdir "$work/copy" "$work/build"
for part in shared host backend_cpu backend_ocl tests scenes bench man docs m4 build-aux; do
    [ ! -d "$top/$part" ] || cp -r "$top/$part" "$work/copy/"
done
find "$top" -maxdepth 1 -type f -exec cp {} "$work/copy/" \;
cp -r "$work/copy" "$work/last"
cd "$work/copy" || exit 99

# ---- a BSDF ---------------------------------------------------------------------------------------------------------

sed 's/TWINLIGHT_BSDF_DIFFUSE_H/TWINLIGHT_BSDF_PLASTER_H/; s/diffuse_/plaster_/g' shared/bsdf/diffuse.h >shared/bsdf/plaster.h
edit shared/layout/material_list.h 's/^    X(DIFFUSE, diffuse, .*\\$/&\n    X(PLASTER, plaster, "plaster", TRAIT_COSINE) \\/'
edit shared/bsdf/bsdf.h 's/^#include "bsdf\/lobe.h"\|^#include "bsdf\/diffuse.h"/&\n#include "bsdf\/plaster.h"/'
edit shared/bsdf/sources.mk 's/^\tshared\/bsdf\/material.h \\$/&\n\tshared\/bsdf\/plaster.h \\/'
edit host/pbrt/materials.c 's/^static void coated_diffuse_read/static void plaster_read(MaterialReader *r)\n{\n    diffuse_read(r);\n}\n\n&/'
edit tests/support/bsdf_cases.h 's/{"diffuse", MATERIAL_DIFFUSE, 1.0f, 0.5f, 0.0f, 1},/&\n    {"plaster", MATERIAL_PLASTER, 1.0f, 0.5f, 0.0f, 1},/'
files 6 'a BSDF'

# ---- a light --------------------------------------------------------------------------------------------------------

sed -n '/^\/\* ---- point -/,/^\/\* ---- spot -/p' shared/light/delta.h | sed '$d; s/light_point/light_bulb/g; s/ point -/ bulb -/' >"$work/bulb.h"
edit shared/layout/scene_types.h 's/^    X(SPOT, spot, .*/&\n    X(BULB, bulb, "bulb", FEATURE_DELTA_LIGHT, 1u) \\/'
edit shared/light/delta.h "/^\/\* ---- point -.*/{
r $work/bulb.h
N
}"
edit host/scene/light_setup.c 's/^static double distant_power/static double bulb_power(const LightDetail *light, double disk)\n{\n    return point_power(light, disk);\n}\n\n&/'
edit host/pbrt/lights.c 's/^static void distant_read/static void bulb_read(LightReader *r)\n{\n    point_read(r);\n    r->light.kind = LIGHT_BULB;\n}\n\n&/'
edit tests/light/test_emit_direction.c 's/^    POINT,$/    BULB,\n    POINT,/; s/^    case POINT:$/    case BULB:\n        fixture_add_light(f, (LightData){.kind = LIGHT_BULB, .emission = {2, 2, 2}, .detail.position = {1, 2, 3}});\n        break;\n&/'
files 5 'a light'

# ---- an integrator --------------------------------------------------------------------------------------------------

sed 's/integrator_pt/integrator_twin/; s/\.name = "pt"/.name = "twin"/' host/render/integrator_pt.c >host/render/integrator_twin.c
edit host/render/integrator.h 's/X(pt) /X(pt) X(twin) /'
edit host/render/sources.mk 's/^\thost\/render\/integrator_pt.c \\$/&\n\thost\/render\/integrator_twin.c \\/'
files 3 'an integrator'

# ---- layers: a variable of the first visible surface, and a part of the picture's light ------------------------------

edit shared/layout/aov_list.h 's/^    X(NORMAL, .*/&\n    X(FACING, facing, "facing", AOV_LIGHTLIKE, "facing", "", "") \\/'
edit shared/kernels/aov.cl 's/^SHARED_FUNCTION Vec3 aov_depth/SHARED_FUNCTION Vec3 aov_facing(const SceneView *scene, const AovHit *hit)\n{\n    return vec3_splat(vec3_dot(aov_normal(scene, hit), hit->back));\n}\n\n&/'
files 2 'a layer of a variable'
edit host/render/layers.h 's/^    X(DIRECT, .*/&\n    X(AGAIN, again, "again", 1) \\/'
edit host/render/picture.c 's/^static void indirect_add/static void again_add(Picture *picture, const Film *film)\n{\n    LIGHT_ADD(picture, "again", film, FILM_ALL);\n}\n\n&/'
files 2 'a layer of light'

# ---- all of them at work --------------------------------------------------------------------------------------------

sed 's/"string type" \[ "diffuse" \]/"string type" [ "plaster" ]/' scenes/cornell.pbrt >"$work/plaster.pbrt"
cmp -s scenes/cornell.pbrt "$work/plaster.pbrt" && fail 'the scene has nothing to be made of plaster'
lamp='LightSource "point" "rgb I" [ 2 1 1 ] "point3 from" [ 0 0.5 0 ]'
sed "s/^WorldBegin/&\n$lamp/" "$work/plaster.pbrt" >"$work/point.pbrt"
sed 's/LightSource "point"/LightSource "bulb"/' "$work/point.pbrt" >"$work/bulb.pbrt"
cmp -s "$work/point.pbrt" "$work/bulb.pbrt" && fail 'the scene has no place for a bulb'
if ! { autoreconf -i && cd "$work/build" && ../copy/configure -q CFLAGS=-O1 && make -s twinlight tests/test_bsdf tests/test_emit tests/test_light tests/test_layers; } \
    >"$work/log" 2>&1; then
    tail -n 30 "$work/log"
    echo 'FAILED: the copy does not build'
    exit 1
fi
for test in test_bsdf test_emit test_light test_layers; do
    srcdir=../copy tests/$test >"$work/log" 2>&1 || {
        tail -n 10 "$work/log"
        fail "$test"
    }
done
render() {
    ./twinlight render --quiet --no-png --resolution=32x32 --samples=16 "$@" || fail "render $*"
}
# same A B WHAT: no pixel differs (the files say which integrator made them).
same() {
    [ "$(./twinlight compare --json "$1" "$2" | sed -n 's/^ *"mse": *\([0-9.e+-]*\),*/\1/p')" = 0 ] || fail "$3"
}
render --backend=cpu --integrator=twin -o twin.exr "$work/plaster.pbrt"
render --backend=cpu --integrator=pt -o pt.exr "$work/plaster.pbrt"
render --backend=cpu --integrator=pt -o diffuse.exr "$work/copy/scenes/cornell.pbrt"
same twin.exr pt.exr 'the new integrator renders another image than the one it was copied from'
same pt.exr diffuse.exr 'plaster is not what diffuse is'
for integrator in pt bdpt mmlt; do
    render --backend=cpu --integrator=$integrator -o point.exr "$work/point.pbrt"
    render --backend=cpu --integrator=$integrator -o bulb.exr "$work/bulb.pbrt"
    same point.exr bulb.exr "$integrator: a bulb is not what a point light is"
done
if ! ./twinlight devices --json | grep -q '"opencl": *\[\]'; then
    for integrator in twin bdpt mmlt; do
        layers=facing$([ $integrator != mmlt ] || echo ,again)
        render --backend=cpu --integrator=$integrator --layers="$layers" -o cpu.exr "$work/bulb.pbrt"
        render --backend=opencl --integrator=$integrator --layers="$layers" -o opencl.exr "$work/bulb.pbrt"
        cmp -s cpu.exr opencl.exr || fail "$integrator: the backends disagree"
        grep -aq "${layers##*,}" cpu.exr || fail "$integrator: the image has no layer ${layers##*,}"
    done
fi
cd "$here" || exit 99
[ $status -ne 0 ] || echo 'the recipes hold'
exit $status
