#!/bin/sh
# Runs the fuzzer of a reader: run.sh NAME SOURCES SECONDS. What breaks it is left in fuzz-found.
set -eu
mkdir -p "fuzz-found/$1"
dictionary=$2/tests/corpus/$1.dict
option=
[ ! -f "$dictionary" ] || option=-dict=$dictionary
exec "./fuzz_$1" -max_total_time="$3" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -close_fd_mask=1 \
    -artifact_prefix="fuzz-found/$1-" ${option:+"$option"} "fuzz-found/$1" "$2/tests/corpus/$1"
