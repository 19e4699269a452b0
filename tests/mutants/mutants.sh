#!/bin/sh
# Do the tests detect faults? Plants those of mutants/mutants.txt, all in one build that selects one of them at run
# time, and for each runs the tests that might detect it until one fails.
set -u

usage() {
    cat <<'TEXT'
usage: tests/mutants/mutants.sh [OPTION]... [NUMBER]...
Runs the tests against planted faults: those with the numbers given, or all that the results of earlier runs in the folder lack.

  -w FOLDER   work there (mutants.work): the sources with faults, their build, results.tsv
  -p PROGRAM  an ordinary build of twinlight: without a fault, pictures must have the same bits as its pictures
  -j JOBS     of make (1); tests run one after the other
  -t TABLE    write results as a table (mutants.md in the working folder)
  -l          what `make check` does not see, show to `make check-long`, too: hours
  -n          plant and compare with the list only; build and run nothing
  -b          plant and build; run nothing
  -h          this text

A fault is killed when a test program fails, crashes or runs out of time. The build is of the CPU backend alone: faults in
shared/ are not in the sources of an OpenCL program, and a difference between the two backends would be no merit of a test.
TEXT
}

work=mutants.work program='' jobs=1 table='' long='' dry='' built=''
while getopts w:p:j:t:lnbh option; do
    case $option in
    w) work=$OPTARG ;;
    p) program=$OPTARG ;;
    j) jobs=$OPTARG ;;
    t) table=$OPTARG ;;
    l) long=yes ;;
    n) dry=yes ;;
    b) built=yes ;;
    h) usage && exit 0 ;;
    *) usage >&2 && exit 2 ;;
    esac
done
shift $((OPTIND - 1))

top=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
list=$top/tests/mutants/mutants.txt
mkdir -p "$work" && work=$(cd "$work" && pwd) || exit 1
table=${table:-$work/mutants.md}
case $table in /*) ;; *) table=$(pwd)/$table ;; esac
case $program in "" | /*) ;; *) program=$(pwd)/$program ;; esac
source=$work/source planted=$work/planted build=$work/build results=$work/results.tsv header=$work/mutant.h

# ---- planting ---------------------------------------------------------------------------------------------------------

# plant FILE: prints the file with its faults. An expression becomes (MUTANT(n) ? (faulty) : (original)).
plant() {
    awk -v name="$1" '
    function complain(text) { print "mutants/mutants.txt: [" number "]: " text | "cat >&2"; failed = 1 }
    function occurrences(text, part,    count, at) {
        for (count = 0; (at = index(text, part)) > 0; ++count)
            text = substr(text, at + length(part))
        return count
    }
    function balanced(text) { return gsub(/\(/, "", text) == gsub(/\)/, "", text) }
    # Whether `text` remains in force in parentheses or, with its semicolon, in braces; finds most that do not.
    function plantable(text) {
        if (text ~ /;$/)
            return text !~ /^(const )?[A-Za-z_][A-Za-z0-9_]* \**[a-z_]+(\[.*)? = / # a declaration
        return balanced(text) && text !~ /^(if |else|return |#|[?|\/,.:={]|&&|\* )/ && text !~ /([?|\/,:=]|&&)$/
    }
    function finish(    from, at) {
        if (number == "" || file != name)
            return
        if (!plantable(original))
            complain("not an expression or a statement: " original)
        from = 1
        if (context != "") {
            if (occurrences(text, context) != 1)
                complain("not once in " name ": " context)
            from = index(text, context) + length(context)
        } else if (occurrences(text, original) != 1) {
            complain("not once in " name ": " original)
        }
        at = index(substr(text, from), original)
        if (at == 0)
            complain("not in " name ": " original)
        at += from - 1
        if (!(at in originals)) {
            originals[at] = original
            order[++places] = at
        } else if (originals[at] != original) {
            complain("begins where another does: " original)
        }
        numbers[at] = numbers[at] " " number
        faults[number] = faulty
    }
    function rendered(at,    part, count, i, n, statement, head, tail) {
        part = originals[at]
        statement = part ~ /;$/
        count = split(numbers[at], n, " ")
        head = statement ? "{ " : "("
        for (i = 1; i <= count; ++i)
            head = head (statement ? "if (MUTANT(" n[i] ")) { " faults[n[i]] " } else " : "MUTANT(" n[i] ") ? (" faults[n[i]] ") : ")
        return head (statement ? "{ " part " } }" : "(" part "))")
    }
    BEGIN { number = "" }
    FNR == NR { text = text $0 "\n"; next } # the source, before the list
    /^\[/ {
        finish()
        number = substr($1, 2, length($1) - 2)
        file = substr($2, 1, length($2) - 1)
        if (number in seen)
            complain("twice")
        seen[number] = 1
        context = original = faulty = ""
    }
    /^@ / { context = substr($0, 3) }
    /^- / { original = substr($0, 3) }
    /^\+/ { faulty = substr($0, 3) }
    END {
        finish()
        for (i = 2; i <= places; ++i) # by place
            for (k = i; k > 1 && order[k - 1] > order[k]; --k) {
                at = order[k]
                order[k] = order[k - 1]
                order[k - 1] = at
            }
        from = 1
        for (i = 1; i <= places; ++i) {
            at = order[i]
            if (at < from) {
                number = numbers[at]
                complain("overlaps another")
            }
            printf "%s%s", substr(text, from, at - from), rendered(at)
            from = at + length(originals[at])
        }
        printf "%s", substr(text, from)
        exit failed
    }' "$top/$1" "$list"
}

files=$(sed -n 's/^\[[0-9]*\] \([^:]*\): .*/\1/p' "$list" | sort -u)
numbers=$(sed -n 's/^\[\([0-9]*\)\] .*/\1/p' "$list")
rm -rf "$planted" # of an earlier list
mkdir -p "$source" "$planted/shared" "$planted/host"
for file in $files; do
    plant "$file" >"$planted/new" || exit 1
    mkdir -p "$planted/${file%/*}"
    cmp -s "$planted/new" "$planted/$file" || mv "$planted/new" "$planted/$file"
done
echo "planted: $(echo "$numbers" | wc -l) faults in $(echo "$files" | wc -l) files"
[ ! "$dry" ] || exit 0
# Later copies update only files that differ, with the current time, so that what was built from older text is rebuilt.
(cd "$top" && {
    for folder in shared host backend_cpu backend_ocl tests scenes bench man docs m4 build-aux; do
        [ ! -d $folder ] || find $folder -type f
    done
    find . -maxdepth 1 -type f
} | while read -r file; do
    mkdir -p "$source/${file%/*}"
    if [ ! -f "$source/$file" ]; then
        cp -p "$file" "$source/$file"
    elif [ ! -f "$planted/$file" ]; then
        cmp -s "$file" "$source/$file" || cp "$file" "$source/$file"
    fi || exit 1
done) || exit 1
rm -f "$source/config.status" # where the sources were built in place
for file in $files; do
    cmp -s "$planted/$file" "$source/$file" || cp "$planted/$file" "$source/$file" || exit 1
done

# Every unit reads the number; the linker merges the variables into one.
cat >"$header.new" <<'TEXT'
extern int mutant_chosen;
__attribute__((weak)) int mutant_chosen;
#define MUTANT(number) (mutant_chosen == (number))
extern char *getenv(const char *name);
extern int atoi(const char *text);
__attribute__((constructor)) static void mutant_choose(void)
{
    const char *text = getenv("TWINLIGHT_MUTANT");
    mutant_chosen = text ? atoi(text) : 0;
}
TEXT
cmp -s "$header.new" "$header" || mv "$header.new" "$header"

# ---- building ---------------------------------------------------------------------------------------------------------

# One build for all, without the kernels for other processors, which contain the same faults.
[ -x "$source/configure" ] || (cd "$source" && autoreconf -fi) >"$work/configure.log" 2>&1 || exit 1
mkdir -p "$build" && cd "$build" || exit 1
[ -f Makefile ] || "$source/configure" -q --without-opencl --enable-native CFLAGS="-O2 -DNDEBUG" >>"$work/configure.log" 2>&1 || {
    echo "configure failed: $work/configure.log"
    exit 1
}
for goal in all check; do # one after the other: both make the libraries
    make -s -j"$jobs" CPPFLAGS="-include $header" $goal TESTS= >"$work/make.log" 2>&1 || {
        tail -n 20 "$work/make.log"
        exit 1
    }
done
[ ! "$built" ] || exit 0

# ---- running ----------------------------------------------------------------------------------------------------------

# Which programs, or PROGRAM:CASE, might detect a fault in FILE: first those that are likely to or quick, then the
# others.
likely() {
    case $1 in
    shared/kernels/ibpt.cl) echo test_verify test_partition test_bidirectional ;;
    shared/kernels/*.cl | shared/path/bd_start.h) echo test_partition test_chain:shown test_layers test_bidirectional:film ;;
    shared/path/mis.h | shared/path/strategy.h) echo test_light:mis test_bidirectional:weights test_bidirectional:walks ;;
    shared/chain/mutation.h) echo test_chain:shown test_partition test_chain test_shift test_layers ;;
    shared/chain/shift.h) echo test_shift:kept test_chain test_shift ;;
    shared/bsdf/phase.h) echo test_bsdf:phase ;;
    shared/geometry/media_walk.h | shared/geometry/medium.h | shared/path/passage.h) echo test_analytic:media test_bidirectional:sums ;;
    host/pbrt/* | host/scene/media_setup.c) echo test_import ;;
    shared/bsdf/*.h) echo test_bsdf:inverse test_shift ;;
    shared/path/partition.h) echo test_chain:shown test_partition test_chain test_layers test_pool ;;
    host/render/photon_lights.c | host/render/photon_lobe.c | host/render/photon_grid.c) echo test_photon_lights test_caustic ;;
    host/render/photon_map.c) echo test_caustic:photons test_caustic:search command/test_outputs.sh test_caustic ;;
    shared/path/caustic.h | shared/path/caustic_rest.h | shared/path/photon.h | host/render/photon_*.c) echo test_caustic:photons test_caustic ;;
    shared/chain/pool.h) echo test_chain:shown test_partition test_chain_population test_pool test_layers ;;
    shared/chain/chain_light.h) echo test_chain:shown test_partition test_layers test_shift ;;
    shared/layout/scene_types.h) echo test_emit test_light ;;
    shared/light/emit.h) echo test_emit test_bidirectional:walks test_bidirectional:hard ;;
    shared/light/light_tree.h | host/scene/light_tree.c) echo test_light:tree test_bidirectional:walks ;;
    shared/light/*.h | shared/camera/camera.h) echo test_light test_emit test_partition test_bidirectional:walks test_analytic ;;
    shared/path/bd_walk.h | shared/path/bd_connect.h | shared/path/bd_vertex.h) echo test_bidirectional:walks test_partition test_emit ;;
    host/scene/light_setup.c | host/scene/aim_setup.c) echo test_light test_emit test_numerics:lights ;;
    shared/math/*.h | shared/layout/distribution.h | shared/path/path_random.h) echo test_math test_light test_emit ;;
    shared/chain/chain_numbers.h) echo test_chain test_partition test_emit ;;
    shared/camera/film_s*.h | shared/camera/splat_offset.h | host/film/*) echo test_film test_restore test_layers test_emit test_shard ;;
    shared/camera/pixel_filter.h | shared/layout/item.h) echo test_film test_bidirectional:film ;;
    host/mmlt/chain_population.c) echo test_chain_population test_restore test_layers ;;
    host/mmlt/plan.c) echo test_plan test_combination:known ;;
    host/base/key_sort.c) echo test_key_sort ;;
    host/base/parallel.c) echo test_mmlt:threads test_combination ;;
    host/ranks/* | host/base/processors.c | host/main.c) echo test_ranks command/test_mpi.sh ;;
    host/backend/shares.c) echo test_group ;;
    host/render/render.c) echo test_render:determinism ;;
    host/render/shard.c | host/render/merge.c | host/render/part.c | host/command/part_output.c | host/command/cmd_merge.c)
        echo test_shard command/test_merge.sh ;;
    host/base/archive* | host/render/checkpoint.c | host/render/identity.c | host/mmlt/mmlt_archive.c)
        echo test_archive test_restore test_checkpoint command/test_checkpoint.sh command/test_merge.sh ;;
    host/render/run.c | host/mmlt/mmlt.c) echo test_progress test_combination test_restore test_checkpoint test_pool test_layers ;;
    host/render/progress.c) echo test_options ;;
    host/base/sample_statistics.c) echo test_bench ;;
    host/render/error_watch.c | host/render/layers.c | host/render/aov_image.c) echo test_restore test_layers test_error ;;
    host/*) echo test_combination test_restore test_pool test_layers ;;
    esac
}
others() {
    case $1 in
    shared/path/mis.h | shared/path/strategy.h | shared/light/*.h | shared/camera/camera.h)
        echo test_bidirectional test_numerics test_render test_scenes test_mmlt command/test_cli.sh ;;
    shared/camera/film_sum.h)
        echo test_combination test_render test_group test_verify command/test_cli.sh test_numerics test_bidirectional test_mmlt ;;
    *) echo test_mmlt test_checkpoint test_layers test_light_guide test_numerics test_scenes command/test_merge.sh command/test_cli.sh ;;
    esac
}
# Those that take more samples or have more cases in `make check-long`.
longer() {
    case $1 in
    shared/camera/film_sum.h) echo test_film test_mmlt test_bidirectional test_numerics ;;
    shared/path/mis.h | shared/path/strategy.h | shared/light/*.h | shared/camera/camera.h)
        echo test_bidirectional test_numerics test_scenes test_reference test_mmlt ;;
    *) echo test_mmlt test_numerics test_scenes test_reference ;;
    esac
}

# Tolerates other work on the machine.
export CK_TIMEOUT_MULTIPLIER="${CK_TIMEOUT_MULTIPLIER:-4}"

# test_fails PROGRAM NUMBER EFFORT: runs it, with output to $work/out. 77: skipped.
test_fails() {
    run=tests/${1%%:*} limit=600 case=''
    case $1 in *.sh) run=$source/tests/$1 ;; *:*) case=${1#*:} ;; esac
    [ "$3" = 1 ] || limit=7200
    CK_RUN_CASE=$case
    if [ "$case" ]; then export CK_RUN_CASE; else unset CK_RUN_CASE; fi
    TWINLIGHT_MUTANT=$2 TWINLIGHT_TEST_EFFORT=$3 srcdir=$source XDG_CACHE_HOME=$work/cache \
        timeout -k 10 $limit "$run" >"$work/out" 2>&1
    case $? in 0 | 77) return 1 ;; esac
}

# What failed first, by Check's names: CASE/TEST.
failed_case() {
    sed -n 's/^[^ ]*:[0-9]*:[FE]:\([^:]*\):\([^:]*\):.*/\1\/\2/p' "$work/out" | head -n 1
}

# control: without a fault everything passes, and images have the bits of PROGRAM's.
control() {
    for name in $(for file in $files; do likely "$file" && others "$file"; done | tr ' ' '\n' | sort -u); do
        if test_fails "$name" 0 1; then
            echo "without a fault $name fails:"
            tail -n 20 "$work/out"
            return 1
        fi
    done
    [ "$program" ] || return 0
    for integrator in pt ibpt bdpt mmlt; do
        for one in "$program" ./twinlight; do
            TWINLIGHT_MUTANT=0 "$one" render --integrator=$integrator --samples=8 --resolution=64x64 \
                -o "$work/picture.exr" "$source/scenes/cornell.pbrt" >"$work/out" 2>&1 || return 1
            [ "$one" = ./twinlight ] || mv "$work/picture.exr" "$work/expected.exr"
        done
        cmp "$work/expected.exr" "$work/picture.exr" || return 1
    done
}

# killer NUMBER EFFORT PROGRAM...: prints the first program that fails, a tab, and the test that failed; returns false
# if none does.
killer() {
    killer_number=$1 killer_effort=$2
    shift 2
    for killer_name; do
        if test_fails "$killer_name" "$killer_number" "$killer_effort"; then
            printf '%s\t%s' "${killer_name%%:*}" "$(failed_case)"
            return 0
        fi
    done
    return 1
}

file_of() {
    sed -n "s/^\[$1\] \([^:]*\): .*/\1/p" "$list"
}

# record NUMBER VERDICT KILLER: writes a line of the results, replacing an older one. VERDICT is check, check-long,
# survives or, before the other tests have run, open.
record() {
    grep -v "^$1	" "$results" >"$results.new"
    printf '%s\t%s\t%s\t%s\n' "$1" "$(file_of "$1")" "$2" "$3" >>"$results.new"
    sort -n "$results.new" >"$results" && rm "$results.new"
    printf '[%s] %s: %s %s\n' "$1" "$(file_of "$1")" "$2" "$(echo "$3" | tr '\t' ' ')"
}

# step VERDICT EFFORT TESTS NEXT: tests faults with this verdict (-: none yet) by the programs that the function TESTS
# lists; survivors get the verdict NEXT.
step() {
    for number in $chosen; do
        verdict=$(awk -F '\t' -v number="$number" '$1 == number { print $3 }' "$results")
        [ "${verdict:--}" = "$1" ] || continue
        # shellcheck disable=SC2046 # a list
        if by=$(killer "$number" "$2" $("$3" "$(file_of "$number")")); then
            if [ "$2" = 1 ]; then record "$number" check "$by"; else record "$number" check-long "$by"; fi
        else
            record "$number" "$4" ''
        fi
    done
}

touch "$results"
# The control is repeated if anything was built since.
if [ ! -f "$work/control" ] || find tests twinlight -type f -newer "$work/control" | grep -q .; then
    control || exit 1
    touch "$work/control"
fi
chosen=${*:-$numbers}
if [ $# -gt 0 ]; then
    for number in $chosen; do
        sed "/^$number	/d" "$results" >"$results.new" && mv "$results.new" "$results"
    done
fi
step - 1 likely open
step open 1 others survives
[ ! "$long" ] || step survives 8 longer survives

# ---- the table --------------------------------------------------------------------------------------------------------

awk -F '\t' '
FNR == NR { verdict[$1] = $3; program[$1] = $4; what[$1] = $5; next }
function cell(text) { gsub(/\|/, "\\|", text); return text }
function finish(    by) {
    if (number == "")
        return
    by = verdict[number] == "check" ? program[number] : verdict[number] == "check-long" ? program[number] ", long" : reason != "" ? "none: " reason : verdict[number] == "survives" ? "none" : "not run"
    if (what[number] != "")
        by = by ", `" what[number] "`"
    rows = rows sprintf("| %s | %s | %s | `%s` | `%s` | %s |\n", number, file, kind, cell(original), faulty == "" ? " " : cell(faulty), by)
    ++count
    ++sums[verdict[number]]
    equivalent += verdict[number] == "survives" && reason != ""
}
/^\[/ {
    finish()
    number = substr($0, 2, index($0, "]") - 2)
    file = substr($0, index($0, "] ") + 2)
    kind = substr(file, index(file, ": ") + 2)
    file = substr(file, 1, index(file, ": ") - 1)
    original = faulty = reason = ""
}
/^- / { original = substr($0, 3) }
/^\+/ { faulty = substr($0, 3) }
/^= / { reason = substr($0, 3) }
END {
    finish()
    print "# Planted faults\n"
    print "Made by `make mutants` (`tests/mutants/mutants.sh`, the faults: `tests/mutants/mutants.txt`). Each fault is built into the program and"
    print "chosen when it runs; the test named is the first that failed with it, on the CPU backend.\n"
    printf "%d faults: %d killed by `make check`, %d more by `make check-long`, %d survive, of which %d have a reason.\n\n", count, sums["check"], sums["check-long"], sums["survives"], equivalent
    print "| | file | kind of fault | original | faulty | killed by |\n|---|---|---|---|---|---|"
    printf "%s", rows
}' "$results" "$list" >"$table"
grep '^[0-9]* faults: ' "$table"
