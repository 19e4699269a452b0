#!/bin/sh
# Compiles FILE of the source tree for the fuzzers: compile.sh FILE SOURCES WIDE COMMAND...
# WIDE: more options for kernels on wide vectors.
set -eu
file=$1 sources=$2 wide=$3
shift 3
case $file in
*_wide.c) ;;
*) wide= ;;
esac
# shellcheck disable=SC2086 # several options
exec "$@" $wide -c "$sources/$file" -o "fuzz-objects/$(echo "${file%.c}" | tr / _).o"
