#!/usr/bin/env bash
# tests/two_hosts.sh N PROGRAM ARGS...: like mpirun.sh, with N ranks on each of two hosts made for the occasion: namespaces with network
# interfaces and host names of their own (host1, host2), a cable between them, and mpirun's daemon started on the second as ssh would.
# Where the kernel forbids namespaces (most containers) both daemons run side by side and mpirun takes them for hosts.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

if [ "${1:-}" != "--inside" ]; then
  if unshare --user --map-root-user --net --uts ip link add cable type veth peer name end 2>/dev/null; then
    exec unshare --user --map-root-user --net --uts "$here/two_hosts.sh" --inside namespaces "$@"
  fi
  exec "$here/two_hosts.sh" --inside daemons "$@"
fi
kind=$2
num_ranks=$3
echo "hosts are $kind" >&2
shift 3

. "$here/../jobs/mpi-settings.sh"
agent=$(mktemp)
trap 'rm -f "$agent"' EXIT
chmod +x "$agent"
if [ "$kind" = namespaces ]; then
  hosts=10.77.0.1:$num_ranks,10.77.0.2:$num_ranks
  hostname host1
  ip link set lo up
  # shellcheck disable=SC2034  # second is the name that coproc gives
  coproc second { exec unshare --net --uts cat; }  # until this script is gone, however it goes
  # shellcheck disable=SC2154  # coproc sets second_PID
  until [ "$(readlink "/proc/$second_PID/ns/net")" != "$(readlink /proc/self/ns/net)" ]; do sleep 0.02; done
  ip link add cable type veth peer name cable netns "$second_PID"
  ip address add 10.77.0.1/24 dev cable
  ip link set cable up
  second_host="nsenter --target $second_PID --net --uts"
  $second_host sh -c 'hostname host2; ip link set lo up; ip address add 10.77.0.2/24 dev cable; ip link set cable up'
else
  hosts=127.0.0.1:$num_ranks,127.0.0.2:$num_ranks
  second_host=
fi
# Stands in for ssh: the host's name, then a command for its shell.
printf '#!/bin/sh\nshift\nexec %s /bin/sh -c "$*"\n' "$second_host" >"$agent"

export OMPI_MCA_plm_rsh_agent=$agent
mpirun --host "$hosts" -np $((2 * num_ranks)) "$@" &
sweep=$!
# A signal to this script is meant for mpirun, and ends only the waiting.
trap 'kill -USR1 $sweep 2>/dev/null' USR1
code=0
wait $sweep || code=$?
while kill -0 $sweep 2>/dev/null; do
  code=0
  wait $sweep || code=$?
done
exit $code
