#!/bin/sh
# Checks which file includes which:
#   shared/      shared; system headers in math/platform.h alone (it detects the language)
#   backend_*/   itself, shared, the rooms base and backend of host/
#   host/        host, shared; main.c alone may name a backend's header
# Within host/ and shared/ a room may include itself and those before it, in the order below, and no file includes itself by
# way of others (x.c and x.h count as one). A room that is not in the list is a fault, and so is an include that this tree
# does not resolve. config.h, build_commit.h, serve_page.h (made by the build) and <system headers> are free outside shared/.
srcdir=${srcdir:-$(dirname "$0")/..}

shared_rooms='math layout geometry bsdf light camera path chain kernels'
host_rooms='base image film backend ranks compare scene pbrt gltf render mmlt serve bench command'

# resolve ROOT DIRECTORY NAME: prints the file that #include "NAME" in DIRECTORY refers to, relative to ROOT, in the
# order of the build's include path, or nothing if there is none.
resolve() {
    for resolve_directory in "$2" shared host backend_cpu backend_ocl; do
        if [ -f "$1/$resolve_directory/$3" ]; then
            printf '%s/%s\n' "$resolve_directory" "$3" | sed -e ':again' -e 's#[^/]*/\.\./##' -e 't again'
            return
        fi
    done
}

# place ROOM ROOMS: prints its number in the list, or nothing if it is not in it.
place() {
    place_number=0
    for place_room in $2; do
        place_number=$((place_number + 1))
        [ "$place_room" != "$1" ] || echo $place_number
    done
}

# ordered FROM TO ROOMS: for two files of the same layer, "room/file" or a file above all rooms.
ordered() {
    case $1 in
    */*) ordered_from=$(place "${1%%/*}" "$3") ;;
    *) ordered_from=99 ;;
    esac
    case $2 in
    */*) ordered_to=$(place "${2%%/*}" "$3") ;;
    *) ordered_to=99 ;;
    esac
    [ -n "$ordered_from" ] && [ -n "$ordered_to" ] && [ "$ordered_to" -le "$ordered_from" ]
}

# allowed FROM TO: may file FROM include file TO (both relative to the root)?
allowed() {
    case $1:$2 in
    shared/*:shared/*) ordered "${1#shared/}" "${2#shared/}" "$shared_rooms" ;;
    shared/*:*) return 1 ;;
    host/main.c:backend_*/*.h) return 0 ;;
    host/*:host/*) ordered "${1#host/}" "${2#host/}" "$host_rooms" ;;
    host/*:shared/* | backend_*/*:shared/*) return 0 ;;
    backend_*/*:host/base/* | backend_*/*:host/backend/*) return 0 ;;
    backend_*/*:backend_*/*) [ "${1%%/*}" = "${2%%/*}" ] ;;
    *) return 1 ;;
    esac
}

# Prints a line "path:line:include" for every include of the layers below ROOT.
includes() {
    (cd "$1" && for includes_directory in shared host backend_cpu backend_ocl; do
        [ -d "$includes_directory" ] && find "$includes_directory" -name '*.[ch]' -o -name '*.cl'
    done | sort | xargs grep -nE '^[[:space:]]*#[[:space:]]*include' /dev/null)
}

# check ROOT: prints "file:line: why" for every fault; fails if there is one.
check() {
    : >"$work/pairs"
    includes "$1" | while IFS=: read -r file line text; do
        name=$(printf '%s\n' "$text" | sed -n 's/^[^"<]*\(["<][^">]*\)[">].*/\1/p')
        case $name in
        '') echo "$file:$line: cannot tell what this includes: $text" ;;
        '<'*)
            case $file in
            shared/math/platform.h) ;;
            shared/*) echo "$file:$line: only shared/math/platform.h may include system headers" ;;
            esac
            ;;
        '"config.h' | '"build_commit.h' | '"serve_page.h')
            case $file in shared/*) echo "$file:$line: shared/ may not depend on ${name#?}" ;; esac
            ;;
        *)
            target=$(resolve "$1" "${file%/*}" "${name#?}")
            if [ -z "$target" ]; then
                echo "$file:$line: ${name#?} is not in the tree"
            elif ! allowed "$file" "$target"; then
                echo "$file:$line: ${file%/*}/ may not include $target"
            else
                case $file:${target%.[ch]} in
                backend_* | "${file%.[ch]}".?:"${file%.[ch]}") ;;
                *) echo "${file%.[ch]} ${target%.[ch]}" >>"$work/pairs" ;;
                esac
            fi
            ;;
        esac
    done >"$work/faults"
    tsort "$work/pairs" 2>&1 >/dev/null | sed -n 's/^tsort: \([^ ]*\/[^ ]*\)$/\1:2: includes itself by way of others/p' >>"$work/faults"
    (cd "$1" && find shared host -mindepth 2 -name '*.[ch]' -o -mindepth 2 -name '*.cl') | while read -r file; do
        grep -qF "$file" "$1/${file%/*}/sources.mk" 2>/dev/null || echo "$file:1: ${file%/*}/sources.mk does not list it"
    done >>"$work/faults"
    cat "$work/faults"
    [ ! -s "$work/faults" ]
}

# planted FILE INCLUDE: a small tree with this line as line 2 of FILE must be rejected, naming file and line.
planted() {
    rm -rf "$work/tree"
    for folder in shared/math shared/geometry host/base host/scene host/backend backend_cpu backend_ocl; do
        mkdir -p "$work/tree/$folder"
    done
    for file in shared/math/vec.h shared/math/platform.h shared/geometry/ray.h host/main.c host/scene/scene.c \
        host/scene/scene.h host/scene/pack.c host/scene/pack.h host/backend/backend.h host/base/error.h host/base/log.h \
        backend_cpu/backend_cpu.h backend_cpu/rays.c backend_ocl/backend_ocl.h; do
        echo '/* a file */' >"$work/tree/$file"
        echo "$file" >>"$work/tree/${file%/*}/sources.mk"
    done
    echo '#include <math.h>' >>"$work/tree/shared/math/platform.h"
    echo '#include "math/vec.h"' >>"$work/tree/shared/geometry/ray.h"
    echo '#include "scene/scene.h"' >>"$work/tree/host/scene/pack.h"
    echo '#include "backend_cpu.h"' >>"$work/tree/host/main.c"
    echo '#include "backend/backend.h"' >>"$work/tree/backend_cpu/backend_cpu.h"
    if ! check "$work/tree" >"$work/output"; then
        echo "self-test: a tree without fault is refused:"
        cat "$work/output"
        status=1
    fi
    [ -d "$work/tree/${1%/*}" ] || { mkdir "$work/tree/${1%/*}" && echo "$1" >"$work/tree/${1%/*}/sources.mk"; }
    printf '/* a file */\n%s\n' "$2" >"$work/tree/$1"
    if check "$work/tree" >"$work/output"; then
        echo "self-test: $1 may contain $2"
        status=1
    elif ! grep -q "^$1:${3:-2}: \|^${1%.[ch]}:2: " "$work/output"; then
        echo "self-test: the fault in line ${3:-2} of $1 is reported as:"
        cat "$work/output"
        status=1
    fi
}

work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
status=0
planted shared/math/vec.h '#include "scene/scene.h"'
planted shared/math/vec.h '#include "../../host/scene/scene.h"'
planted shared/math/vec.h '#include <math.h>'
planted shared/math/vec.h '#include "config.h"'
planted shared/math/vec.h '#include "backend_cpu.h"'
planted shared/math/vec.h '#include "geometry/ray.h"'
planted shared/math/forgotten.h '#include "math/vec.h"' 1
planted shared/attic/old.h '#include "math/vec.h"'
planted host/base/log.h '#include "scene/scene.h"'
planted host/attic/old.h '#include "base/log.h"'
planted host/scene/scene.c '#include "scene/pack.h"'
planted host/scene/scene.c '#include "backend_cpu.h"'
planted host/scene/scene.h '  #  include "../../backend_ocl/backend_ocl.h"'
planted host/scene/scene.c '#include "missing.h"'
planted backend_cpu/rays.c '#include "scene/scene.h"'
planted backend_cpu/rays.c '#include "backend_ocl.h"'
planted backend_ocl/backend_ocl.h '#include "../backend_cpu/backend_cpu.h"'
check "$srcdir" || status=1
exit $status
