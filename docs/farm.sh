#!/bin/sh
# Renders a picture in N shards as a Slurm array, then merges them (docs/farm.md).
#
# usage: farm.sh N IMAGE.exr OPTION... SCENE
#
# The options are those of `twinlight render`; with --samples, of the whole picture. The folder of IMAGE.exr must be one that
# all nodes see; parts and checkpoints lie beside it. Options of sbatch come from its environment variables (SBATCH_PARTITION,
# SBATCH_TIMELIMIT ...), the program from TWINLIGHT.
set -eu

# A task of the array. Slurm tells it a minute before its time is over; its checkpoint is then written, and it begins again at
# the end of the queue. After a crash of the node, or if preempted, it goes on from the latest checkpoint in the same way.
shard() {
    count=$1 stem=${2%.exr}-$SLURM_ARRAY_TASK_ID
    shift 2
    status=0
    srun "${TWINLIGHT:-twinlight}" render --shard="$SLURM_ARRAY_TASK_ID/$count" --threads="${SLURM_CPUS_ON_NODE:-1}" \
        --checkpoint="$stem.ck" --resume="$stem.ck" -o "$stem.part" "$@" || status=$?
    [ "$status" -ne 130 ] || scontrol requeue "$SLURM_JOB_ID"
    [ "$status" -ne 0 ] || rm -f "$stem.ck" "$stem.ck.previous"
    exit "$status"
}

merge() {
    count=$1 image=$2
    shift 2
    for k in $(seq "$count"); do
        set -- "$@" "${image%.exr}-$k.part"
    done
    srun "${TWINLIGHT:-twinlight}" merge -o "$image" "$@"
}

case ${1-} in
--shard)
    shift
    shard "$@"
    ;;
--merge)
    shift
    merge "$@"
    ;;
*)
    [ $# -ge 3 ] || { sed -n 's/^# usage: /usage: /p' "$0" >&2 && exit 2; }
    array=$(sbatch --parsable --array="1-$1" --requeue --signal=TERM@60 --open-mode=append "$0" --shard "$@")
    sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes "$0" --merge "$1" "$2"
    ;;
esac
