#!/usr/bin/env bash
# tests/mpirun.sh N PROGRAM ARGS...: mpirun with the settings the scripts use.
set -euo pipefail
. "$(dirname "$0")/../jobs/mpi-settings.sh"
num_ranks=$1
shift
exec mpirun -np "$num_ranks" "$@"
