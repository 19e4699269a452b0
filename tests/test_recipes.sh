#!/bin/sh
# The recipes of ARCHITECTURE.md, followed to the letter in a copy of the sources: a BSDF of six files at most and an
# integrator of five. The copy builds, renders both on every backend with the same image, and passes the tests that a
# new BSDF is in by its case. Runs in the build folder; srcdir is the source folder.
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
edit shared/layout/material_list.h 's/^\(    X(DIFFUSE_TRANSMISSION, .*[^\\ ]\) *$/\1 \\\n    X(PLASTER, plaster, "plaster", TRAIT_COSINE)/'
edit shared/bsdf/bsdf.h 's/^#include "bsdf\/lobe.h"\|^#include "bsdf\/diffuse.h"/&\n#include "bsdf\/plaster.h"/'
edit shared/bsdf/sources.mk 's/^\tshared\/bsdf\/material.h \\$/&\n\tshared\/bsdf\/plaster.h \\/'
edit host/pbrt/materials.c 's/^static void coated_diffuse_read/static void plaster_read(MaterialReader *r)\n{\n    diffuse_read(r);\n}\n\n&/'
edit tests/support/bsdf_cases.h 's/{"diffuse", MATERIAL_DIFFUSE, 1.0f, 0.5f, 0.0f, 1},/&\n    {"plaster", MATERIAL_PLASTER, 1.0f, 0.5f, 0.0f, 1},/'
files 6 'a BSDF'

# ---- an integrator --------------------------------------------------------------------------------------------------

sed 's/integrator_pt/integrator_twin/; s/\.name = "pt"/.name = "twin"/' host/render/integrator_pt.c >host/render/integrator_twin.c
edit host/render/integrator.h 's/X(pt) /X(pt) X(twin) /'
edit host/render/sources.mk 's/^\thost\/render\/integrator_pt.c \\$/&\n\thost\/render\/integrator_twin.c \\/'
files 5 'an integrator'

# ---- both of them at work -------------------------------------------------------------------------------------------

sed 's/"string type" \[ "diffuse" \]/"string type" [ "plaster" ]/' scenes/cornell.pbrt >"$work/plaster.pbrt"
cmp -s scenes/cornell.pbrt "$work/plaster.pbrt" && fail 'the scene has nothing to be made of plaster'
if ! { autoreconf -i && cd "$work/build" && ../copy/configure -q CFLAGS=-O1 && make -s twinlight tests/test_bsdf; } \
    >"$work/log" 2>&1; then
    tail -n 30 "$work/log"
    echo 'FAILED: the copy does not build'
    exit 1
fi
srcdir=../copy tests/test_bsdf >"$work/log" 2>&1 || {
    tail -n 10 "$work/log"
    fail 'the tests of BSDFs'
}
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
if ! ./twinlight devices --json | grep -q '"opencl": *\[\]'; then
    for integrator in twin bdpt mmlt; do
        render --backend=cpu --integrator=$integrator -o cpu.exr "$work/plaster.pbrt"
        render --backend=opencl --integrator=$integrator -o opencl.exr "$work/plaster.pbrt"
        cmp -s cpu.exr opencl.exr || fail "$integrator: the backends disagree about plaster"
    done
fi
cd "$here" || exit 99
[ $status -ne 0 ] || echo 'the recipes hold'
exit $status
