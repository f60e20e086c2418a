#!/usr/bin/env bash
# Splits a turntable over a Slurm array of four tasks on two nodes, kills one task on the way, requeues it, and compares every
# frame with those of one unsplit run, byte for byte.
#
#   cli/tests/slurm.sh [PROGRAM]        default: target/release/basrelief
#
# Starts a cluster of its own in a temporary folder: munged, slurmctld and two slurmd, as root, on this machine. Debian has
# them in the packages munge, slurmctld, slurmd and slurm-client. Exit code 77: skipped, since they are not here.
set -euo pipefail
cd "$(dirname "$0")/../.."

program=$(realpath "${1:-${CARGO_TARGET_DIR:-target}/release/basrelief}")
num_frames=${NUM_FRAMES:-120}
scene=(--size 320x180 --turntable "$num_frames")

for tool in munged slurmctld slurmd sbatch scontrol squeue; do
    if ! PATH="$PATH:/usr/sbin" command -v "$tool" >/dev/null; then echo "skipped: $tool is not installed"; exit 77; fi
done
if [ "$(id -u)" -ne 0 ]; then echo "skipped: slurmd needs root"; exit 77; fi
export PATH="$PATH:/usr/sbin"

folder=$(mktemp -d)
chmod 755 "$folder"
daemons=()
clean_up() {
    for pid in "${daemons[@]}"; do kill "$pid" 2>/dev/null || true; done
    for pid in "${daemons[@]}"; do wait "$pid" 2>/dev/null || true; done
    rm -rf "$folder"
}
trap clean_up EXIT

# What a condition is waited for, at most two minutes.
await() {
    local -i i
    for ((i = 0; i < 1200; i++)); do
        if "${@:2}"; then return; fi
        sleep 0.1
    done
    echo "failed: $1" >&2
    tail -n 20 "$folder"/*.log >&2
    exit 1
}

free_port() {
    local -i port=$1
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port+=1; done
    echo "$port"
}

start_cluster() {
    local host port
    host=$(hostname -s)
    port=$(free_port 16817)
    dd if=/dev/urandom of="$folder/key" bs=1024 count=1 status=none
    chmod 400 "$folder/key"
    cat >"$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool.%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/linear
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=2
MpiDefault=none
MailProg=/bin/true
JobRequeue=1
ReturnToService=2
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES State=UP
CONF
    export SLURM_CONF="$folder/slurm.conf"
    mkdir "$folder/state" "$folder/spool.n1" "$folder/spool.n2"
    munged --foreground --force --key-file="$folder/key" --socket="$folder/munge.socket" --pid-file="$folder/munge.pid" \
        --log-file="$folder/munge.log" --seed-file="$folder/munge.seed" &
    daemons+=($!)
    await "munged starts" test -S "$folder/munge.socket"
    slurmctld -D & daemons+=($!)
    slurmd -D -N n1 & daemons+=($!)
    slurmd -D -N n2 & daemons+=($!)
    await "both nodes are idle" both_idle
}

both_idle() { [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -eq 2 ]; }
num_drawn() { find "$folder/frames" -name 'frame_*.png' | wc -l; }
has_begun() { [ -s "$folder/pid.1" ] && [ "$(num_drawn)" -ge 6 ]; }
state_of() { scontrol show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | head -1; }
is_failed() { [ "$(state_of "$1")" = FAILED ]; }
is_empty() { [ -z "$(squeue -h 2>/dev/null)" ]; }

mkdir "$folder/whole" "$folder/frames"
"$program" "${scene[@]}" -q -o "$folder/whole/frame_####.png"

start_cluster >"$folder/daemons.log" 2>&1
cat >"$folder/job.sh" <<JOB
#!/bin/sh
#SBATCH --array=0-3
#SBATCH --requeue
#SBATCH --output=$folder/task_%a.txt
#SBATCH --open-mode=append
echo \$\$ >$folder/pid.\$SLURM_ARRAY_TASK_ID
exec $program ${scene[*]} --skip-existing -o $folder/frames/frame_####.png
JOB
job=$(sbatch --parsable "$folder/job.sh")

await "task 1 draws" has_begun
kill -KILL "$(cat "$folder/pid.1")"
await "task 1 has failed" is_failed "${job}_1"
before=$(num_drawn)
scontrol requeue "${job}_1"
await "all tasks are done" is_empty

echo "killed after $before of $num_frames frames; restarts: $(scontrol show job "${job}_1" | sed -n 's/.*Restarts=\([0-9]*\).*/\1/p')"
sed 's/^/task /' "$folder"/task_*.txt
[ "$(num_drawn)" -eq "$num_frames" ] || { echo "failed: $(num_drawn) frames"; exit 1; }
[ "$before" -lt "$num_frames" ] || { echo "failed: killed after all was done"; exit 1; }
diff -r "$folder/whole" "$folder/frames"
echo "passed: $num_frames frames are the same bytes"
