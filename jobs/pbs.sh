#!/usr/bin/env bash
# A sweep on a cluster with PBS; see slurm.sh. The sweep's options are lines of a file, because qsub cannot pass commas
# in variables:
#   printf '%s\n' --config sweep.cfg --output sweep.h5 > sweep.options
#   qsub -v SWEEP=sweep.options jobs/pbs.sh
# If the first two lines of the file are `refine` and KEY, python3 -m clogsweep refine chooses the values. HOURS, a
# little less than the walltime below, stops the sweep cleanly; then the job queues itself again with the resources
# below. So change resources in a copy of this script, whose name is given by JOB_SCRIPT, not on the command line.
#PBS -N clogsweep
#PBS -l select=1:ncpus=32:mpiprocs=32
#PBS -l walltime=24:00:00
set -euo pipefail
cd "${PBS_O_WORKDIR:-.}"
# Other scripts are found beside the programs, because the batch system runs a copy of this script in another folder.
bin=${CLOG_BIN:-build/release/bin}
if [ ! -x "$bin/clogsweep" ]; then
  type -P clogsweep >/dev/null || { echo "no clogsweep in $bin or the PATH; set CLOG_BIN to its folder" >&2; exit 2; }
  bin=$(dirname "$(type -P clogsweep)")
fi
# shellcheck source=jobs/batch.sh
. "$bin/../share/clogsweep/jobs/batch.sh"
mapfile -t options <"$SWEEP"
code=0
run_sweep "$bin/clogsweep" "${options[@]}" --max-hours "${HOURS:-23.9}" || code=$?
if ((code == 75 && !was_cancelled)); then
  count=${REQUEUES:-0}
  export SWEEP HOURS="${HOURS:-23.9}" CLOG_BIN="$bin" JOB_SCRIPT="${JOB_SCRIPT:-jobs/pbs.sh}" REQUEUES=$((count + 1)) MAX_REQUEUES
  requeue "$count" qsub -v SWEEP,HOURS,CLOG_BIN,JOB_SCRIPT,REQUEUES,MAX_REQUEUES "$JOB_SCRIPT"
fi
exit "$code"
