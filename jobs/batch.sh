# Sourced by the scripts for batch systems.
# shellcheck shell=bash
# shellcheck source=jobs/mpi-settings.sh
. "$(dirname "${BASH_SOURCE[0]}")/mpi-settings.sh"
# A sweep that never completes, such as one with --max-hours 0.01, is given up after so many requeues.
MAX_REQUEUES=${MAX_REQUEUES:-100}
if [[ ! $MAX_REQUEUES =~ ^(0|[1-9][0-9]*)$ ]]; then
  echo "MAX_REQUEUES=$MAX_REQUEUES is not a whole number; set it to the number of times that the job may requeue itself" >&2
  exit 2
fi

# The Python module is in the source tree, or installed beside the programs.
jobs=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
for folder in "$jobs/../analysis" "$jobs/../../../lib/python3/dist-packages"; do
  if [ -d "$folder/clogsweep" ]; then export PYTHONPATH="${PYTHONPATH:+$PYTHONPATH:}$folder"; fi
done

# Prints the first python3 of the PATH, or the system's python3 if only that one has the libraries.
python_with_libraries() {
  local python
  for python in python3 /usr/bin/python3; do
    if "$python" -c "import h5py, pandas, scipy" 2>/dev/null; then
      echo "$python"
      return
    fi
  done
  echo python3
}

# run_sweep PROGRAM ARGS...: runs PROGRAM by mpirun. If the first of ARGS is `refine`, it runs python3 -m clogsweep
# refine, which starts mpirun for each of its rounds. A batch system's warning (SIGUSR1, SIGUSR2, SIGXCPU) or SIGTERM
# goes on to the ranks as SIGUSR1, because mpirun forwards this signal and gives the ranks time to write what they have.
# Returns the sweep's exit code, which is 75 if the sweep may be incomplete and the same command resumes it.
# was_cancelled is 1 if SIGTERM came: then the job has been cancelled and must not be queued again.
run_sweep() {
  local code was_warned=0 interrupted=0 sweep
  # shellcheck disable=SC2034  # the scripts that source this one read it
  was_cancelled=0
  # The traps are set before the sweep begins, because a warning may come at any time: either $! exists, or the sweep
  # sees `was_warned`.
  trap 'was_warned=1; interrupted=1; kill -USR1 "${!:-}" 2>/dev/null || true' USR1 USR2 XCPU
  trap 'was_warned=1; interrupted=1; was_cancelled=1; kill -USR1 "${!:-}" 2>/dev/null || true' TERM
  {
    ((!was_warned)) || exit 75
    if [ "${2-}" = refine ]; then exec "$(python_with_libraries)" -m clogsweep "${@:2}" --programs "$(dirname "$1")" -- mpirun; fi
    exec mpirun "$@"
  } &
  sweep=$!
  while true; do
    code=0
    wait "$sweep" || code=$?
    # A signal to this script ends the waiting, not the sweep. So wait is called once more, for the sweep's own exit
    # code.
    ((interrupted && code > 128)) || break
    interrupted=0
  done
  trap - USR1 USR2 XCPU TERM
  # A warning may kill mpirun or a rank before these have installed their handlers, or, while daemons start on other
  # nodes, cause an error of Open MPI, 244. MPICH's mpirun may then end with 0, whatever the sweep returned. So after a
  # warning only the exit codes 1 and 2, the sweep's own failures, are kept, and all others become 75. If nothing was
  # left to do, the same command ends at once. 205 means that Open MPI has lost a daemon on another node, as in a
  # preemption of which Slurm warns the daemons only.
  if ((code == 205 || code == 128 + $(kill -l USR1) || (was_warned && code != 1 && code != 2))); then code=75; fi
  return "$code"
}

# requeue COUNT COMMAND...: queues the job again by COMMAND, unless it has been requeued MAX_REQUEUES times. COUNT is the
# number of times so far.
requeue() {
  if (($1 >= MAX_REQUEUES)); then
    echo "not complete after $1 requeues, as many as MAX_REQUEUES allows; submit the job again to resume the sweep"
    return
  fi
  echo "not complete; the job queues again"
  "${@:2}"
}
