#!/usr/bin/env bash
# tests/slurm.sh [TEST...]: sweeps as jobs of a real Slurm, whose controller and two nodes are all on this machine: slurm.py says what is
# done to them. Needs root; installs `slurm-wlm` and `munge` if they are missing. Run by hand, about ten minutes. CLOG_BIN names
# the folder of the programs, build/release/bin by default. Exit code 1: something of it fails.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

if [ "${1:-}" != "--inside" ]; then
  [ "$(id -u)" -eq 0 ] || { echo "needs root, for namespaces and Slurm's daemons" >&2; exit 2; }
  CLOG_BIN=$(realpath "${CLOG_BIN:-$here/../build/release/bin}")
  [ -x "$CLOG_BIN/clogsweep" ] || { echo "no clogsweep in $CLOG_BIN; build it, or set CLOG_BIN to its folder" >&2; exit 2; }
  export CLOG_BIN
  for command in munged slurmctld slurmd; do
    command -v $command >/dev/null && continue
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge >/dev/null
    break
  done
  # Everything that is begun here, and the folder, which is in memory, end with this process, however it ends.
  exec unshare --mount --pid --net --uts --fork --kill-child --mount-proc "$here/slurm.sh" --inside "$@"
fi
shift

# The first process of its namespace gets no signal that it has not asked for.
trap 'exit 130' INT TERM
folder=/var/lib/slurm
mount -t tmpfs -o mode=755 tmpfs $folder
mkdir $folder/munge $folder/state $folder/spool $folder/node1 $folder/node2 $folder/sweeps
export SLURM_CONF=$folder/slurm.conf TMPDIR=$folder/sweeps
hostname controller
# Neither Slurm nor Open MPI starts where there is no network but the host's own.
ip link set lo up
ip link add cable type veth peer name end
ip address add 10.77.0.1/24 dev cable
ip link set cable up
ip link set end up
printf '127.0.0.1 localhost\n10.77.0.1 controller node1 node2\n' >$folder/hosts
mount --bind $folder/hosts /etc/hosts

cat >$SLURM_CONF <<CONF
ClusterName=clogsweep
SlurmctldHost=controller
SlurmUser=root
AuthType=auth/munge
# On a busy machine.
MessageTimeout=100
# A job that queued again waits until the credentials of its last time have expired.
AuthInfo=socket=$folder/munge/socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/%n.pid
# PMIx of a node has its sockets here, under a name that would be the same for both.
TmpFS=$folder/%n
# Needs no control groups, which containers have not.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
NodeName=node1 Port=6821 CPUs=2
NodeName=node2 Port=6822 CPUs=2
# Jobs of the last partition preempt those of the second and third.
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SlurmctldParameters=preempt_send_user_signal
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE PreemptMode=OFF
PartitionName=requeue Nodes=ALL
PartitionName=cancel Nodes=ALL PreemptMode=CANCEL GraceTime=60
PartitionName=urgent Nodes=ALL PriorityTier=2 PreemptMode=OFF
CONF

head --bytes 1024 /dev/urandom >$folder/munge/key
chmod 400 $folder/munge/key
munged --key-file=$folder/munge/key --socket=$folder/munge/socket --seed-file=$folder/munge/seed \
  --pid-file=$folder/munge/pid --log-file=$folder/munge/log
slurmctld -D >$folder/slurmctld.log 2>&1 &
for node in node1 node2; do
  # A node's host has its name.
  unshare --uts sh -c "hostname $node; exec slurmd -D -N $node" >$folder/$node.log 2>&1 &
done

cd "$here"
code=0
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m unittest -v "${@:-slurm}" || code=1
((code == 0)) || tail -n +1 $folder/*.log >&2
exit $code
