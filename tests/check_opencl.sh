#!/bin/sh
# Compiles every file of shared/ as OpenCL C 1.2: each alone (so that it includes what it needs), and all kernel files
# together, with features read at run time, all on, and all off. Exit 77 (skipped) only if there is no clang.
srcdir=${srcdir:-$(dirname "$0")/..}

clang=
for candidate in "$OPENCL_CLANG" clang clang-19 clang-18 clang-17 clang-16 clang-15 clang-14; do
    if [ -n "$candidate" ] && command -v "$candidate" >/dev/null 2>&1; then
        clang=$candidate
        break
    fi
done
if [ -z "$clang" ]; then
    echo "skipped: no clang; fix: apt-get install clang"
    exit 77
fi

# compile DIRECTORY TEXT [OPTION...]: compiles TEXT as a program. It is passed on standard input so that functions of a
# header that the program does not use cause no warnings.
compile() {
    compile_directory=$1
    compile_text=$2
    shift 2
    printf '%s\n' "$compile_text" | "$clang" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only \
        -nostdlibinc -Wall -Wextra -Werror -I"$compile_directory" "$@" -
}

# check DIRECTORY: status 1 if any of its files does not compile.
check() {
    check_status=0
    check_kernels=
    for check_name in $(cd "$1" && find . -name '*.h' -o -name '*.cl' | sed 's/^\.\///' | sort); do
        check_file=$1/$check_name
        if ! compile "$1" "#include \"$check_name\""; then
            echo "$check_file: does not compile as OpenCL C 1.2"
            check_status=1
        fi
        case $check_name in
        *.cl) check_kernels="$check_kernels#include \"$check_name\"
" ;;
        esac
    done
    for check_features in "" -DTWINLIGHT_FEATURES=0xfffffffffffffffful -DTWINLIGHT_FEATURES=0ul; do
        if [ -n "$check_kernels" ] && ! compile "$1" "$check_kernels" $check_features; then
            echo "$1: the kernels do not compile together $check_features"
            check_status=1
        fi
    done
    return $check_status
}

# The check itself must be able to fail: texts that are C11 but not OpenCL C 1.2, or not self-contained.
planted() {
    plant=$(mktemp -d) || exit 99
    cp -r "$srcdir/shared/math" "$plant"
    printf '%s\n' "$2" >"$plant/$1"
    if check "$plant" >/dev/null 2>&1; then
        echo "self-test: a planted fault passed as OpenCL C: $2"
        status=1
    fi
    rm -r "$plant"
}

status=0
planted bad.h '#include <math.h>'
planted bad.h 'static inline float f(float x) { return sinf(x); }'
planted bad.h 'static inline float f(Vec3 a) { return a.x; }'
planted bad.h 'static inline float f(void) { float half = 0.5f; return half; }'
planted bad.cl '#include "math/platform.h"
__kernel void k(__global float *a) { float *b = a; b[0] = 1.0f; }'
check "$srcdir/shared" || status=1
exit $status
