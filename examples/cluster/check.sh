#!/usr/bin/env bash
# Runs study.json directly, with Snakemake and with Slurm on this machine, and compares the results:
#
#   examples/cluster/check.sh target/release/sandbox
#
# Snakemake comes from PyPI, unless SNAKEMAKE names a program. Slurm comes from Debian's packages and runs only on
# this machine, with its own daemons, ports and key. If Slurm cannot be installed or started, the script says so and
# runs the array script with the variables that Slurm would set.
set -euo pipefail
sandbox=$(realpath "${1:?the program sandbox}")
examples=$(realpath "$(dirname "$0")")
shards=4
folder=$(mktemp -d)
daemons=()

clean_up() {
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  wait
  rm -rf "$folder"
}
trap clean_up EXIT
cd "$folder"

# Checks that everything except run times equals the results of the whole study.
same_as_whole() {
  python3 - whole/study.csv "$1" "$2" <<'PYTHON'
import csv, sys

def rows(path):
    with open(path, newline="") as file:
        return [{k: v for k, v in row.items() if k != "wall_secs"} for row in csv.DictReader(file)]

whole, other = rows(sys.argv[1]), rows(sys.argv[2])
assert len(whole) == 12 and all(row["status"] == "finished" for row in whole)
assert whole == other, f"{sys.argv[3]}: other results"
print(f"{sys.argv[3]}: the same {len(other)} cells, to the last bit")
PYTHON
}

# %% Directly.
cp "$examples/study.json" .
"$sandbox" sweep study.json --out whole

# %% Snakemake.
if [ -z "${SNAKEMAKE:-}" ]; then
  python3 -m venv venv
  venv/bin/pip install --quiet snakemake==9.27.1
  SNAKEMAKE=venv/bin/snakemake
fi
snakemake() {
  "$SNAKEMAKE" --snakefile "$examples/Snakefile" --cores all --quiet all \
    --config study=study.json shards=$shards sandbox="$sandbox" out=snakemake "$@"
}
snakemake
same_as_whole snakemake/study.csv Snakemake
before=$(ls -l --time-style=full-iso snakemake/cases)
touch study.json # a changed study starts its shards again; they run nothing
snakemake
[ "$before" = "$(ls -l --time-style=full-iso snakemake/cases)" ]

# %% Slurm.
installed() {
  local program
  for program in munged slurmctld slurmd sbatch sinfo squeue; do
    command -v "$program" > /dev/null || return 1
  done
}

start_slurm() {
  if ! installed; then
    [ "$(id -u)" = 0 ] && command -v apt-get > /dev/null || { echo "no apt-get, or not root"; return 1; }
    {
      apt-get update -qq
      DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        slurmctld slurmd slurm-client munge
    } > apt.log 2>&1 || { tail -n 5 apt.log; return 1; }
    installed || return 1
  fi
  [ "$(id -u)" = 0 ] || { echo "slurmd needs root"; return 1; }
  local host
  host=$(hostname -s)
  mkdir -p slurm/{state,spool}
  chmod 755 "$folder"
  dd if=/dev/urandom of=slurm/munge.key bs=128 count=1 status=none
  chmod 400 slurm/munge.key
  cat > slurm/slurm.conf <<CONF
ClusterName=check
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/slurm/munge.socket
StateSaveLocation=$folder/slurm/state
SlurmdSpoolDir=$folder/slurm/spool
SlurmctldPidFile=$folder/slurm/slurmctld.pid
SlurmdPidFile=$folder/slurm/slurmd.pid
SlurmctldLogFile=$folder/slurm/slurmctld.log
SlurmdLogFile=$folder/slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=4096 State=UNKNOWN
PartitionName=check Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$folder/slurm/slurm.conf
  munged --foreground --force --key-file slurm/munge.key --socket slurm/munge.socket \
    --pid-file slurm/munged.pid --seed-file slurm/munged.seed > slurm/munged.out 2>&1 &
  daemons+=($!)
  sleep 1
  slurmctld -D > slurm/slurmctld.out 2>&1 &
  daemons+=($!)
  slurmd -D > slurm/slurmd.out 2>&1 &
  daemons+=($!)
  for _ in $(seq 30); do
    sinfo --noheader --format=%t 2>/dev/null | grep -q idle && return 0
    sleep 1
  done
  tail -n 5 slurm/*.out
  return 1
}

mkdir array
cp "$examples"/{study.json,slurm.sh} array/
export SANDBOX=$sandbox
if start_slurm; then
  (cd array && ./slurm.sh study.json $shards --time=10)
  for _ in $(seq 120); do
    [ -z "$(squeue --noheader)" ] && break
    sleep 1
  done
  cat array/*.log
  same_as_whole array/study/study.csv "Slurm $(sbatch --version | cut -d' ' -f2)"
else
  echo "Slurm cannot be had here: the array script runs with the variables that Slurm would set"
  for shard in $(seq $shards); do
    (cd array && SWEEP_STEP=shard SLURM_ARRAY_TASK_ID=$shard ./slurm.sh study.json $shards)
  done
  (cd array && SWEEP_STEP=merge ./slurm.sh study.json $shards)
  same_as_whole array/study/study.csv "the array script without Slurm"
fi
