#!/bin/sh
# Several ranks under mpirun give the file of a single process, whatever their number and backends; what goes wrong on one
# of them ends all. Runs in the build folder, like command/test_cli.sh. Skipped (77) without MPI or mpirun.
set -u

# shellcheck source=tests/support/cli.sh
. "${srcdir:-.}/tests/support/cli.sh"

if ! "$program" --version | grep -q 'Open MPI'; then
    echo "this program was built without MPI"
    exit 77
fi
if ! command -v mpirun >/dev/null; then
    echo "there is no mpirun"
    exit 77
fi

# Containers and virtual machines that test have but root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
mpirun='timeout 60 mpirun --oversubscribe'

if ! $mpirun -n 2 true >out 2>err; then
    echo "mpirun cannot start processes here:"
    cat err
    exit 77
fi

# ranks N ARGUMENT...: a small rendering by N ranks.
ranks() {
    ranks_number=$1
    shift
    $mpirun -n "$ranks_number" "$program" render --resolution=48x36 --no-png --threads=1 "$@" >out 2>err
}

# single ARGUMENT...: the same by a single process.
single() {
    "$program" render --resolution=48x36 --no-png --threads=2 "$@" >out 2>err
}

same() {
    cmp -s "$1" "$2"
    result "$3: other bytes" $?
}

says() {
    [ "$(grep -cF -- "$1" err)" -eq "${3:-1}" ]
    result "$2: does not say once \"$1\"" $?
}

# ended STATUS NAME
ended() {
    status=$?
    [ "$status" -eq "$1" ]
    result "$2: exit status $status, not $1" $?
}

# ---- the same bytes -----------------------------------------------------------------------------------------------

for integrator in pt ibpt bdpt mmlt; do
    single --integrator=$integrator --samples=12 -o single.exr "$scene"
    for number in 1 2 3 4; do
        ranks $number --integrator=$integrator --samples=12 --stats=ranks.json -o ranks.exr "$scene"
        same single.exr ranks.exr "$integrator by $number ranks"
        rm ranks.exr
        [ $number -eq 1 ] || grep -q "\"count\": $number," ranks.json
        result "$integrator by $number ranks: statistics" $?
    done
done

# compare NAME ARGUMENT...: three ranks give the file of a single process.
compare() {
    compare_name=$1
    shift
    single -o single.exr "$@" && ranks 3 -o ranks.exr "$@"
    ended 0 "$compare_name"
    same single.exr ranks.exr "$compare_name"
}

compare "all layers" --samples=12 --layers=all "$scene"
compare "chains without path tracing" --samples=8 --mlt=combine=off "$scene"
compare "photons" --integrator=pt --photons=2000 --samples=4 "${scene%/*}/pool.pbrt"
compare "photons of mmlt, a crop" --samples=4 --crop=5,7,40,29 "${scene%/*}/pool.pbrt"
compare "an error as goal" --integrator=pt --error=20% "$scene"
compare "independent samples" --integrator=bdpt --reconstruction=sample --samples=3 "$scene"
compare "more segments than steps are sent at once" --integrator=pt --max-depth=65535 --samples=2 "$scene"

for shard in 1/2 2/2; do
    single --integrator=pt --samples=8 --shard=$shard -o single.part "$scene"
    ranks 2 --integrator=pt --samples=8 --shard=$shard -o "ranks-${shard%/2}.part" "$scene"
done
"$program" merge --no-png -o merged.exr ranks-1.part ranks-2.part >out 2>err
single --integrator=pt --samples=8 -o single.exr "$scene"
same single.exr merged.exr "shards by two ranks each, merged"

# ---- mixed backends -----------------------------------------------------------------------------------------------

if "$program" devices 2>/dev/null | sed -n '/^opencl/,$p' | grep -q 'bit for bit *promised'; then
    for integrator in pt mmlt; do
        single --integrator=$integrator --samples=12 -o single.exr "$scene"
        for film in host device; do
            $mpirun -n 1 "$program" render -q --resolution=48x36 --no-png --integrator=$integrator --samples=12 --threads=1 \
                -o mixed.exr --stats=mixed.json "$scene" : -n 1 "$program" render --backend=opencl --film=$film "$scene" >out 2>err
            same single.exr mixed.exr "$integrator by a processor and a device, film on the $film"
        done
    done
    grep -q '"device": ".* + .*"' mixed.json
    result "statistics name both devices" $?

    # A device that fails in a pass: what is finished is written, and the error names the rank.
    rm -f failed.exr
    $mpirun -n 1 "$program" render --integrator=pt --resolution=48x36 --no-png --time=20s --threads=1 -o failed.exr "$scene" : \
        -x TWINLIGHT_TEST_FAIL_BATCH=40 -n 1 "$program" render --backend=opencl --batch=512 "$scene" >out 2>err
    ended 1 "a device that fails"
    says 'error: rank 1 on ' "a device that fails"
    says 'is in failed.exr' "a device that fails"
    file_exists failed.exr
else
    echo "no OpenCL device promises the same bits: mixed backends are not tested"
fi

# ---- threads ------------------------------------------------------------------------------------------------------

# Ranks that share their processors share the threads that there are by default.
processors=$(nproc)
for number in 1 2 3; do
    $mpirun --bind-to none -n $number "$program" render -q --integrator=pt --resolution=16x12 --no-png --samples=1 \
        --stats=threads.json -o threads.exr "$scene" >out 2>err
    threads=$((processors / number > 0 ? processors / number * number : number))
    grep -q "\"threads\": $threads," threads.json
    result "$number ranks on $processors processors have $threads threads" $?
done

# ---- what goes wrong ----------------------------------------------------------------------------------------------

$mpirun -n 1 "$program" render --resolution=48x36 --no-png -o bad.exr "$scene" : -n 2 "$program" render --threads=many x >out 2>err
ended 2 "a bad option on two ranks"
says 'error: ' "a bad option on two ranks"
says 'error: rank 1 on ' "a bad option on two ranks"
says '--threads=many: not a whole number' "a bad option on two ranks"
file_missing bad.exr

if "$program" --version | grep -q opencl; then
    $mpirun -n 1 "$program" render --resolution=48x36 --no-png -o bad.exr "$scene" : \
        -n 1 "$program" render --backend=opencl --device=71 x >out 2>err
    ended 1 "no such device on a rank"
    says 'error: rank 1 on ' "no such device on a rank"
    file_missing bad.exr
fi

ranks 3 --samples=many "$scene"
ended 2 "a bad option on all ranks"
says 'error: ' "a bad option on all ranks"
ranks 3 missing.pbrt
ended 1 "a scene that is not there"
says 'error: ' "a scene that is not there"
for option in --verify --trace=trace.json; do
    ranks 2 --backend=all $option "$scene"
    ended 2 "$option"
    says "${option%=*} is for a single process, but there are 2 ranks" "$option"
done

# A launcher whose processes cannot find each other must not make renderings that replace each other's files.
OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 expect 1 'do not find each other' render -o lone.exr "$scene"
OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=1 "$program" render -o lone.exr "$scene" >out 2>err
ended 1 "rank 1 of processes that do not find each other"
[ ! -s err ]
result "rank 1 of processes that do not find each other says something" $?
file_missing lone.exr

# ---- other commands -----------------------------------------------------------------------------------------------

$mpirun -n 3 "$program" info "$scene" >out 2>err
ended 0 info
"$program" info "$scene" >single.info
same single.info out "info by three ranks"
$mpirun -n 3 "$program" render --help >out 2>err
ended 0 --help
"$program" render --help >single.help
same single.help out "render --help by three ranks"

# ---- stops --------------------------------------------------------------------------------------------------------

for integrator in pt mmlt; do
    rm -f stopped.exr
    $mpirun -n 3 "$program" render --integrator=$integrator --resolution=96x64 --no-png --time=50s --save-every=0.1s --threads=1 \
        -o stopped.exr "$scene" >out 2>err &
    process=$!
    wait_for stopped.exr
    kill -s USR2 "$(pgrep -P $process mpirun)"
    wait $process
    ended 130 "$integrator, stopped"
    says 'info: stopped: ' "$integrator, stopped"
    "$program" compare stopped.exr stopped.exr >out 2>err
    result "$integrator, stopped: the image" $?
done

# ---- checkpoints, and a rank that dies ----------------------------------------------------------------------------

# resumed NUMBER ARGUMENT...: goes on from ranks.ck, in the background.
resumed() {
    resumed_ranks="$mpirun -n $1"
    [ "$1" -gt 1 ] || resumed_ranks=
    shift
    rm -f resumed.exr
    # shellcheck disable=SC2086 # words
    $resumed_ranks "$program" render --resolution=48x36 --no-png --threads=1 --save-every=0.1s --checkpoint=ranks.ck \
        --checkpoint-every=0.1s --resume=ranks.ck -o resumed.exr "$@" "$scene" >out 2>err &
    process=$!
}

for integrator in pt mmlt; do
    rm -f ranks.ck*
    single --integrator=$integrator --samples=1000 -o single.exr "$scene"
    for number in 3 2; do
        resumed $number --integrator=$integrator --samples=1000
        wait_for resumed.exr
        wait_for ranks.ck
        kill -s KILL "$(pgrep -P "$(pgrep -P $process mpirun)" twinlight | tail -n 1)"
        if wait $process; then false; else true; fi
        result "$integrator: $number ranks, of which one was killed: exit status 0" $?
    done
    resumed 1 --integrator=$integrator --samples=1000
    wait $process
    ended 0 "$integrator, resumed by a single process"
    same single.exr resumed.exr "$integrator, resumed by fewer and fewer ranks"
done

checks_end
