#!/usr/bin/env bash
# A real Slurm on this machine alone, started for the test: `sheaf submit --run` gives it a picture in parts
# whose merge has the bytes of one machine, and a job that is requeued goes on.
#
#   tests/slurm.sh SHEAF            the command
#
# Needs munge and slurm-wlm (Debian), and root, as slurmd does. Without them it says so and exits with 77, as a
# skipped test does. Nothing outside a temporary folder is touched; the daemons end with the script.
set -euo pipefail
sheaf=$(realpath "$1")
scene=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../scenes/crystal-ball.json")
PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch squeue scontrol; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool" >&2; exit 77; }
done
[[ $(id -u) -eq 0 ]] || { echo "skipped: slurmd needs root" >&2; exit 77; }

folder=$(mktemp -d)
daemons=()
finish() {
  [[ ${#daemons[@]} -eq 0 ]] || kill "${daemons[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
cd "$folder"
host=$(hostname -s)
mkdir state spool
(umask 077 && head -c 1024 /dev/urandom >munge.key)
# Ports that no other run of this test has.
port=$((20000 + $$ % 20000))
cat >slurm.conf <<END
ClusterName=sheaf
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 20000))
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,sched_min_interval=0
MpiDefault=none
KillWait=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
export SLURM_CONF=$folder/slurm.conf
munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munge.pid" --log-file="$folder/munge.log" --seed-file="$folder/munge.seed" &>munged.log &
daemons+=($!)
slurmctld -D -c &>slurmctld.log &
daemons+=($!)
for _ in $(seq 100); do [[ -S munge.socket ]] && break; sleep 0.1; done
slurmd -D &>slurmd.log &
daemons+=($!)
is_idle() { [[ $(sinfo --noheader --format=%t 2>/dev/null) == idle ]]; }
for _ in $(seq 150); do is_idle && break; sleep 0.2; done
is_idle || { echo "skipped: Slurm does not start here:" >&2; tail -n 3 slurmctld.log slurmd.log >&2; exit 77; }

# Until no job is left, or a minute and a half.
await_all() {
  for _ in $(seq 450); do [[ -z $(squeue --noheader) ]] && return; sleep 0.2; done
  squeue
  return 1
}
fail() {
  echo "failed: $1" >&2
  tail -n 5 slurm-*.out >&2
  exit 1
}

# A picture with layers beside it, in more parts than the node has slots.
options=(--size 320x240 --spp 4 --aov depth,normal --exposure auto)
"$sheaf" render "$scene" -o one.png "${options[@]}" --quiet
"$sheaf" submit "$scene" -o 'the whole.png' --parts 6 "${options[@]}" --run --sbatch=--time=5 --sbatch=--cpus-per-task=2
await_all
for name in png depth.png normal.png; do
  cmp "the whole.$name" "one.$name" || fail "other bytes than one machine's"
done
compgen -G '*part-*' >/dev/null && fail "parts are left"

# A part that is requeued while it renders takes what it had from its journal.
slow=(--size 512x1024 --spp 64)
"$sheaf" render "$scene" -o slow-one.exr "${slow[@]}" --quiet
"$sheaf" submit "$scene" -o slow.exr --parts 2 "${slow[@]}" --run --sbatch=--job-name=slow >submitted
job=$(sed -n 's/^parts: \([0-9]*\).*/\1/p' submitted)
journal=.slow.part-1-of-2.exr.sheaf-journal
for _ in $(seq 600); do [[ -s $journal && $(stat -c %s "$journal") -gt 100000 ]] && break; sleep 0.05; done
scontrol requeue "${job}_1"
await_all
grep -q "goes on after" slurm-"${job}"_1.out || fail "the requeued part began anew"
cmp slow.exr slow-one.exr || fail "other bytes after a requeue"

# Where a part fails nothing is merged, and the merge does not wait for ever.
cp "$scene" gone.json
"$sheaf" submit gone.json -o gone.png --parts 2 --run --sbatch=--begin=now+2 >/dev/null
rm gone.json
await_all
[[ ! -e gone.png ]] || fail "a picture without its parts"
echo "Slurm: parts, merge, requeue and a failed part are as they should be"
