#!/bin/sh
# Who may include whom:
#   shared/      shared; system headers in platform.h alone (it knows the language)
#   backend_*/   itself, shared, host/{backend,bvh,error,instance_bounds,log,ray_reach}.h
#   host/        host, shared; main.c alone may name a backend's header
# An include that this tree does not resolve is a fault too. config.h, build_commit.h (both made by the build) and
# <system headers> are free outside shared/.
srcdir=${srcdir:-$(dirname "$0")/..}

# resolve ROOT DIRECTORY NAME: the file that #include "NAME" in DIRECTORY means, relative to ROOT, in the order of the
# build's include path. Prints nothing when there is none.
resolve() {
    for resolve_directory in "$2" shared host backend_cpu backend_ocl; do
        if [ -f "$1/$resolve_directory/$3" ]; then
            printf '%s/%s\n' "$resolve_directory" "$3" | sed -e ':again' -e 's#[^/]*/\.\./##' -e 't again'
            return
        fi
    done
}

# allowed FROM TO: may file FROM include file TO (both relative to the root)?
allowed() {
    case $1:$2 in
    shared/*:shared/*) return 0 ;;
    shared/*:*) return 1 ;;
    host/main.c:backend_*/*.h) return 0 ;;
    host/*:host/* | host/*:shared/*) return 0 ;;
    backend_*/*:shared/*) return 0 ;;
    backend_*/*:host/backend.h | backend_*/*:host/bvh.h) return 0 ;;
    backend_*/*:host/error.h | backend_*/*:host/instance_bounds.h | backend_*/*:host/log.h | \
        backend_*/*:host/ray_reach.h) return 0 ;;
    backend_*/*:backend_*/*) [ "${1%%/*}" = "${2%%/*}" ] ;;
    *) return 1 ;;
    esac
}

# One line "path:line:include" for every include of the layers below ROOT.
includes() {
    (cd "$1" && for includes_directory in shared host backend_cpu backend_ocl; do
        [ -d "$includes_directory" ] && find "$includes_directory" -name '*.[ch]' -o -name '*.cl'
    done | sort | xargs grep -nE '^[[:space:]]*#[[:space:]]*include' /dev/null)
}

# check ROOT: prints "file:line: why" for every fault and fails when there is one.
check() {
    includes "$1" | while IFS=: read -r file line text; do
        name=$(printf '%s\n' "$text" | sed -n 's/^[^"<]*\(["<][^">]*\)[">].*/\1/p')
        case $name in
        '') echo "$file:$line: cannot tell what this includes: $text" ;;
        '<'*)
            case $file in
            shared/platform.h) ;;
            shared/*) echo "$file:$line: only shared/platform.h may include system headers" ;;
            esac
            ;;
        '"config.h' | '"build_commit.h')
            case $file in shared/*) echo "$file:$line: shared/ may not depend on ${name#?}" ;; esac
            ;;
        *)
            target=$(resolve "$1" "${file%/*}" "${name#?}")
            if [ -z "$target" ]; then
                echo "$file:$line: ${name#?} is not in the tree"
            elif ! allowed "$file" "$target"; then
                echo "$file:$line: ${file%%/*}/ may not include $target"
            fi
            ;;
        esac
    done >"$work/faults"
    cat "$work/faults"
    [ ! -s "$work/faults" ]
}

# planted FILE INCLUDE: a small tree with this line as line 2 of FILE must be refused, naming file and line.
planted() {
    rm -rf "$work/tree"
    mkdir -p "$work/tree/shared" "$work/tree/host" "$work/tree/backend_cpu" "$work/tree/backend_ocl"
    for file in shared/vec.h shared/platform.h host/main.c host/scene.c host/scene.h host/backend.h host/error.h \
        host/log.h backend_cpu/backend_cpu.h backend_cpu/rays.c backend_ocl/backend_ocl.h; do
        echo '/* a file */' >"$work/tree/$file"
    done
    echo '#include <math.h>' >>"$work/tree/shared/platform.h"
    echo '#include "backend_cpu.h"' >>"$work/tree/host/main.c"
    echo '#include "../host/backend.h"' >>"$work/tree/backend_cpu/backend_cpu.h"
    if ! check "$work/tree" >"$work/output"; then
        echo "self-test: a tree without fault is refused:"
        cat "$work/output"
        status=1
    fi
    printf '/* a file */\n%s\n' "$2" >"$work/tree/$1"
    if check "$work/tree" >"$work/output"; then
        echo "self-test: $1 may contain $2"
        status=1
    elif ! grep -q "^$1:2: " "$work/output"; then
        echo "self-test: the fault in line 2 of $1 is reported as:"
        cat "$work/output"
        status=1
    fi
}

work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
status=0
planted shared/vec.h '#include "scene.h"'
planted shared/vec.h '#include "../host/scene.h"'
planted shared/vec.h '#include <math.h>'
planted shared/vec.h '#include "config.h"'
planted shared/vec.h '#include "backend_cpu.h"'
planted host/scene.c '#include "backend_cpu.h"'
planted host/scene.h '  #  include "../backend_ocl/backend_ocl.h"'
planted host/scene.c '#include "missing.h"'
planted backend_cpu/rays.c '#include "scene.h"'
planted backend_cpu/rays.c '#include "backend_ocl.h"'
planted backend_ocl/backend_ocl.h '#include "../backend_cpu/backend_cpu.h"'
check "$srcdir" || status=1
exit $status
