#!/usr/bin/env bash
# A sweep on a cluster with Slurm, from the folder of clogsweep's sources after ./tests/run.sh or a build, or where it is
# installed (share/clogsweep/jobs):
#   sbatch jobs/slurm.sh --config sweep.cfg --output sweep.h5
#   sbatch --nodes=8 --ntasks-per-node=64 --time=48:00:00 jobs/slurm.sh --config sweep.cfg --output sweep.h5
#   sbatch jobs/slurm.sh refine line-tension --config sweep.cfg --output sweep.h5 --until curve=20%
# One job, on one node or many, runs the whole sweep; job arrays are not needed. Two minutes before the time is up, the
# sweep writes what it has. The job queues itself again until the sweep is complete. See docs/how-to/cluster.md.
#SBATCH --job-name=clogsweep
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=32
#SBATCH --cpus-per-task=1
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
# Other scripts are found beside the programs, because the batch system runs a copy of this script in another folder.
bin=${CLOG_BIN:-build/release/bin}
[ -n "${CLOG_BIN-}" ] || [ -x "$bin/clogsweep" ] || bin=$(dirname "$0")/../build/release/bin  # if another script runs this one
if [ ! -x "$bin/clogsweep" ]; then
  type -P clogsweep >/dev/null || { echo "no clogsweep in ${CLOG_BIN:-build/release/bin} or the PATH; set CLOG_BIN to its folder" >&2; exit 2; }
  bin=$(dirname "$(type -P clogsweep)")
fi
bin=$(realpath "$bin")
# Relative paths refer to the job's folder: that of the sbatch command, or of its --chdir. A script that runs this one
# may have changed the folder.
if [ -n "${SLURM_JOB_ID-}" ]; then
  folder=$(scontrol show job "$SLURM_JOB_ID" | sed -n "s/^ *WorkDir=//p") && cd "${folder:-.}"
fi
# shellcheck source=jobs/batch.sh
. "$bin/../share/clogsweep/jobs/batch.sh"
code=0
run_sweep "$bin/clogsweep" "$@" || code=$?
if ((code == 75 && !was_cancelled)); then requeue "${SLURM_RESTART_COUNT:-0}" scontrol requeue "$SLURM_JOB_ID"; fi
exit "$code"
