#!/usr/bin/env bash
# The same with PBS; options of the sweep go into the variable SWEEP:
#   qsub -v SWEEP="--config sweep.cfg --output sweep.h5" jobs/pbs.sh
#   qsub -l select=8:ncpus=64:mpiprocs=64 -l walltime=48:00:00 -v SWEEP="...",HOURS=47.9 jobs/pbs.sh
# HOURS, a little less than the walltime, ends the sweep in good order; then the job queues itself again.
#PBS -N clogsweep
#PBS -l select=1:ncpus=32:mpiprocs=32
#PBS -l walltime=24:00:00
set -euo pipefail
cd "${PBS_O_WORKDIR:-.}"
. jobs/mpi-settings.sh
. jobs/batch.sh
read -r -a options <<<"$SWEEP"
code=0
run_sweep "${CLOG_BIN:-build/release/bin}/clogsweep" "${options[@]}" --max-hours "${HOURS:-23.9}" || code=$?
if ((code == 75)); then
  echo "not complete; it queues again"
  qsub -v SWEEP="$SWEEP",HOURS="${HOURS:-23.9}" jobs/pbs.sh
fi
exit "$code"
