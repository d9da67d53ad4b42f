#!/usr/bin/env bash
#SBATCH --job-name=sweep
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=1G
#SBATCH --time=01:00:00
#SBATCH --output=%x-%A-%a.log
#
# Runs a study as an array job with one task per shard, then a job that merges the results when all tasks have ended:
#
#   SANDBOX=target/release/sandbox ./slurm.sh study.json 8 [sbatch options …]
#
# The same command runs only the cells again that failed or hit a time limit.
set -euo pipefail
study=${1:?a study, JSON}
shards=${2:?how many shards}
: "${SANDBOX:=sandbox}"
export SANDBOX

case ${SWEEP_STEP:-submit} in
  submit)
    options=("${@:3}")
    array=$(sbatch --parsable --array="1-$shards" --export=ALL,SWEEP_STEP=shard "${options[@]}" \
      "$0" "$study" "$shards")
    # afterany, not afterok: a failed cell fails its shard, but the finished cells must be merged anyway.
    merge=$(sbatch --parsable --dependency="afterany:${array%%;*}" --export=ALL,SWEEP_STEP=merge \
      --output=%x-%j-merge.log "${options[@]}" "$0" "$study" "$shards")
    echo "array job ${array%%;*}: shards 1 to $shards of $study; then job ${merge%%;*} puts them together"
    ;;
  shard)
    exec "$SANDBOX" sweep "$study" --shard "$SLURM_ARRAY_TASK_ID/$shards" \
      --threads "${SLURM_CPUS_PER_TASK:-1}"
    ;;
  merge)
    exec "$SANDBOX" sweep "$study" --merge
    ;;
esac
