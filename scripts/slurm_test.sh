#!/usr/bin/env bash
# Tests scripts/slurm/batch.sbatch on a Slurm of one node that this script starts and stops: 200 pairs in four tasks,
# of which one is killed and requeued, give the bytes of a single run. Usage: slurm_test.sh [the command hangpose]
set -euo pipefail
cd "$(dirname "$0")/.."

hangpose=$(realpath "${1:-${CARGO_TARGET_DIR:-target}/debug/hangpose}")
test -x "$hangpose" || { echo "slurm_test: $hangpose was not found: run cargo build -p hangpose" >&2; exit 1; }
PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch; do
    command -v "$tool" >/dev/null || { echo "slurm_test: $tool was not found: run scripts/setup.sh" >&2; exit 1; }
done

folder=$(mktemp -d)
# munged asks for a folder that everybody can enter.
chmod 755 "$folder"
daemons=()
finish() {
    status=$?
    trap - EXIT
    if [ $status != 0 ]; then
        tail -n 20 "$folder"/*.log >&2 || true
    fi
    scancel --full --user "$(id -un)" 2>/dev/null || true
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do
        kill "${daemons[i]}" 2>/dev/null || true
        wait "${daemons[i]}" 2>/dev/null || true
    done
    rm -rf "$folder"
    exit $status
}
trap finish EXIT

# Waits until a command succeeds. Usage: wait_for SECONDS WHAT COMMAND...
wait_for() {
    local deadline=$((SECONDS + $1)) what=$2
    shift 2
    until "$@"; do
        if [ $SECONDS -ge $deadline ]; then
            echo "slurm_test: gave up waiting for $what" >&2
            return 1
        fi
        sleep 0.1
    done
}

# Slurm without cgroups, which a container may not write: linuxproc finds the processes of a job by their parents.
host=$(hostname -s)
export SLURM_CONF=$folder/slurm.conf
mkdir "$folder/state" "$folder/spool"
# Ports from the number of this process, so that two tests do not meet.
port=$((20000 + $$ % 10000 * 2))
cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
# A requeued job waits until the credential of its first start has expired, for which 5 s is the least that Slurm takes.
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
# Looks each second for jobs that may start.
SchedulerParameters=sched_interval=1
KillWait=1
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=16000 State=UNKNOWN
PartitionName=test Nodes=$host Default=YES State=UP
CONF

dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
chmod 600 "$folder/munge.key"
munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --seed-file="$folder/munge.seed" --log-file="$folder/munged.log" \
    >"$folder/munged.out.log" 2>&1 &
daemons+=($!)
wait_for 10 "munged" test -S "$folder/munge.socket"
slurmctld -D -f "$SLURM_CONF" >"$folder/slurmctld.log" 2>&1 &
daemons+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" >"$folder/slurmd.log" 2>&1 &
daemons+=($!)
is_idle() { [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ]; }
wait_for 30 "the node" is_idle

# 200 pairs of few files: two of the samples, and rings of several sizes.
ring() {
    awk 'BEGIN {
        n = 24; m = 10; R = 0.03; r = 0.003; turn = 8 * atan2(1, 1)
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
            a = turn * i / n; b = turn * j / m
            printf "v %.6f %.6f %.6f\n", (R + r * cos(b)) * cos(a), r * sin(b), (R + r * cos(b)) * sin(a)
        }
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) {
            k = (i + 1) % n; l = (j + 1) % m
            printf "f %d %d %d %d\n", i * m + j + 1, i * m + l + 1, k * m + l + 1, k * m + j + 1
        }
    }'
}
cp samples/scissors.obj samples/hook.ply samples/mug_tree.ply "$folder"
ring >"$folder/ring.obj"
{
    echo object,supporter,object_scale
    for ((i = 0; i < 200; i++)); do
        supporter=hook.ply
        if ((i % 2)); then supporter=mug_tree.ply; fi
        # Every fortieth pair has the scissors, which take longer.
        if ((i % 40 == 7)); then
            echo "scissors.obj,$supporter,"
        else
            echo "ring.obj,$supporter,1.$((i / 20))"
        fi
    done
} >"$folder/pairs.csv"

options=(--top 1)
start=$SECONDS
"$hangpose" batch "$folder/pairs.csv" --output "$folder/single.parquet" "${options[@]}"
echo "single run: $((SECONDS - start)) s"

start=$SECONDS
export HANGPOSE=$hangpose
job=$(sbatch --parsable --chdir="$folder" --array=1-4 --cpus-per-task=1 scripts/slurm/batch.sbatch \
    4 pairs.csv results.parquet "${options[@]}")
journal=$folder/results.2-of-4.parquet.partial
# The first line is a header.
has_rows() { [ -e "$journal" ] && [ "$(wc -l <"$journal")" -gt 6 ]; }
wait_for 60 "rows of the second task" has_rows
scontrol requeue "${job}_2"
is_done() { [ -z "$(squeue --noheader 2>&1)" ]; }
wait_for 120 "the tasks" is_done
echo "four tasks, one of them killed and requeued: $((SECONDS - start)) s"

cat "$folder"/hangpose-*.log
grep -q "50 pairs ([0-9]* of them in an earlier run)" "$folder/hangpose-${job}_2.log" || {
    echo "slurm_test: the requeued task did not go on where it was" >&2
    exit 1
}
"$hangpose" merge "$folder/pairs.csv" "$folder"/results.*-of-4.parquet --output "$folder/results.parquet"
cmp "$folder/single.parquet" "$folder/results.parquet"
echo "the merged result has the $(stat -c %s "$folder/results.parquet") bytes of the single run"
