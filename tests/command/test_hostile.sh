#!/bin/sh
# Large invalid scene files, read in bounded memory: 8 MiB each or, with TWINLIGHT_TEST_EFFORT (as in `make
# check-long`), 1 GiB each, which needs as much room in TMPDIR. Input that is rejected at a limit takes no more memory
# if the file is larger; lists of numbers, which may be of any length, take twice the file plus spare capacity.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

if [ -n "${TWINLIGHT_TEST_EFFORT-}" ]; then mebibytes=1024; else mebibytes=8; fi
bytes=$((mebibytes * 1048576))

# within KIB COMMAND...: runs the command with this much address space.
within() {
    # shellcheck disable=SC3045 # dash and bash have it
    (ulimit -v "$1" && shift && exec "$@")
}

# For the program, its libraries and what the reader's limits allow. Sanitizers reserve terabytes: with them only
# messages are checked.
fixed=524288
within $fixed "$program" --version >out 2>&1 || fixed=unlimited

# refused TEXT [KIB]: reads hostile.pbrt, with KIB more memory than any scene may take; it must be rejected with TEXT.
refused() {
    memory=$fixed
    [ "$fixed" = unlimited ] || memory=$((fixed + ${2-0}))
    within "$memory" "$program" info hostile.pbrt >out 2>err
    [ $? -eq 1 ] && grep -qF "hostile.pbrt:$1" err
    result "$1" $?
}

# Copies of a text until the file is full, each on its own line, or all on one line.
lines() {
    yes "$1" | head -c $bytes
}

line() {
    yes "$1" | tr '\n' ' ' | head -c $bytes
}

# One character (in tr's notation) until the file is full.
characters() {
    head -c $bytes /dev/zero | tr '\0' "$1"
}

# ---- rejected at a limit ------------------------------------------------------------------------------------------

{ echo WorldBegin && lines AttributeBegin; } >hostile.pbrt
refused '65538:1: error: AttributeBegin is nested more than 65536 deep'
{ echo WorldBegin && line AttributeBegin; } >hostile.pbrt
refused '2:983041: error: AttributeBegin is nested more than 65536 deep'
{ echo WorldBegin && lines 'ObjectBegin "a"'; } >hostile.pbrt
refused '3:1: error: ObjectBegin is inside an object definition'
{ echo WorldBegin && line '['; } >hostile.pbrt
refused '2:1: error: expected a directive, found ['
{ echo 'WorldBegin Shape "sphere"' && lines '"float a" 1'; } >hostile.pbrt
refused '1026:1: error: the directive has more than 1024 parameters'
{ echo 'WorldBegin Shape "sphere" "string a" [' && line '""'; } >hostile.pbrt
refused '2:3073: error: the directive has more than 1024 strings'
{ echo WorldBegin && lines 'Attribute "shape" "float a" 1'; } >hostile.pbrt
refused '1026:1: error: more than 1024 parameters of Attribute directives are in force'
{ echo WorldBegin && seq -f 'CoordinateSystem "%.0f"' $((mebibytes * 40000)); } >hostile.pbrt
refused '65537:1: error: more than 65536 coordinate systems'
echo >empty.inc
{ echo WorldBegin && lines 'Include "empty.inc"'; } >hostile.pbrt
refused '65537:9: error: the scene includes more than 65536 files'

# ---- endless tokens -----------------------------------------------------------------------------------------------

characters a >hostile.pbrt
refused '1:1: error: a word of more than 65536 characters'
characters '\0' >hostile.pbrt
refused '1:1: error: a word of more than 65536 characters'
{ printf '"' && characters a; } >hostile.pbrt
refused '1:1: error: a string of more than 65536 characters'
{ printf '#' && characters a; } >hostile.pbrt
refused "1:$((bytes + 2)): error: the file ends before WorldBegin"
characters ' ' >hostile.pbrt
refused "1:$((bytes + 1)): error: the file ends before WorldBegin"
characters '\n' >hostile.pbrt
refused "$((bytes + 1)):1: error: the file ends before WorldBegin"

# ---- lists as long as the file ------------------------------------------------------------------------------------

{ echo 'WorldBegin Shape "trianglemesh" "point3 P" [' && line 1; } >hostile.pbrt
refused "2:$((bytes + 1)): error: expected a value or ], found the end of the file" $((mebibytes * 4096))
{ echo 'WorldBegin Shape "trianglemesh" "integer indices" [' && line 1; } >hostile.pbrt
refused "2:$((bytes + 1)): error: expected a value or ], found the end of the file" $((mebibytes * 4096))

checks_end
