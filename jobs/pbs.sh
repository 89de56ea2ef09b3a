#!/usr/bin/env bash
# The same with PBS. The sweep's options are lines of a file, since qsub cannot pass commas in variables:
#   printf '%s\n' --config sweep.cfg --output sweep.h5 > sweep.options
#   qsub -v SWEEP=sweep.options jobs/pbs.sh
# HOURS, a little less than the walltime below, ends the sweep in good order; then the job queues itself again with the
# resources below: edit them here rather than on the command line.
#PBS -N clogsweep
#PBS -l select=1:ncpus=32:mpiprocs=32
#PBS -l walltime=24:00:00
set -euo pipefail
cd "${PBS_O_WORKDIR:-.}"
# From the source tree, or as installed; the batch system runs a copy of this script from somewhere else.
jobs=./jobs
bin=${CLOG_BIN:-build/release/bin}
if [ ! -e jobs/batch.sh ]; then
  called=$(command -v clogsweep) || { echo "no clogsweep in the PATH, and this is not its source tree" >&2; exit 2; }
  bin=${CLOG_BIN:-$(dirname "$called")}
  jobs=$(dirname "$called")/../share/clogsweep/jobs
fi
# shellcheck source=jobs/mpi-settings.sh
. "$jobs/mpi-settings.sh"
# shellcheck source=jobs/batch.sh
. "$jobs/batch.sh"
mapfile -t options <"$SWEEP"
code=0
run_sweep "$bin/clogsweep" "${options[@]}" --max-hours "${HOURS:-23.9}" || code=$?
if ((code == 75 && !was_cancelled)); then
  echo "not complete; it queues again"
  export SWEEP HOURS="${HOURS:-23.9}" CLOG_BIN="$bin"
  qsub -v SWEEP,HOURS,CLOG_BIN "$jobs/pbs.sh"
fi
exit "$code"
