# Sourced by the scripts for batch systems.
# shellcheck shell=bash
# shellcheck source=jobs/mpi-settings.sh
. "$(dirname "${BASH_SOURCE[0]}")/mpi-settings.sh"
# A sweep that never completes, such as one with --max-hours 0.01, ends after so many jobs.
MAX_REQUEUES=${MAX_REQUEUES:-100}
if [[ ! $MAX_REQUEUES =~ ^(0|[1-9][0-9]*)$ ]]; then
  echo "MAX_REQUEUES=$MAX_REQUEUES is not a whole number; set it to the number of times that the job may requeue itself" >&2
  exit 2
fi

# Where the Python module is: of the sources, or installed beside the programs.
jobs=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
for folder in "$jobs/../analysis" "$jobs/../../../lib/python3/dist-packages"; do
  if [ -d "$folder/clogsweep" ]; then export PYTHONPATH="${PYTHONPATH:+$PYTHONPATH:}$folder"; fi
done

# The first python3 of the PATH; the system's, if only that one has the libraries.
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

# run_sweep PROGRAM ARGS...: runs it by mpirun; if the first of ARGS is `refine`, runs python3 -m clogsweep refine, which
# starts mpirun for each of its rounds. A batch system's warning (SIGUSR1, SIGUSR2, SIGXCPU) or SIGTERM goes on to the ranks as
# SIGUSR1: mpirun forwards that one and leaves them the time to write what they have. Returns the sweep's exit code, 75 when it
# may not be complete and the same command resumes it; was_cancelled is 1 if SIGTERM came, which is no warning but the end.
run_sweep() {
  local code was_warned=0 interrupted=0 sweep
  # shellcheck disable=SC2034  # the scripts that source this one read it
  was_cancelled=0
  # Set before the sweep begins, since a warning may come at any time: either $! is there, or the sweep sees `was_warned`.
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
    # A signal to this script ends the waiting, not the sweep. Where both have ended it is asked once more for its own code.
    ((interrupted && code > 128)) || break
    interrupted=0
  done
  trap - USR1 USR2 XCPU TERM
  # A warning may end mpirun or a rank before they can take it as one: by the signal, or, while daemons start on other nodes, by an
  # error of Open MPI, 244. MPICH's mpirun may end with 0 then, whatever the sweep said. So after a warning only the sweep's own
  # failures, 1 and 2, stay what they are. If nothing was left to do, the same command ends at once. 205: Open MPI has lost a daemon on
  # another node, as in a preemption of which Slurm warns the daemons only.
  if ((code == 205 || code == 128 + $(kill -l USR1) || (was_warned && code != 1 && code != 2))); then code=75; fi
  return "$code"
}

# requeue COUNT COMMAND...: queues the job again by COMMAND, unless it has been requeued COUNT times and may not be again.
requeue() {
  if (($1 >= MAX_REQUEUES)); then
    echo "not complete after $1 requeues, as many as MAX_REQUEUES allows; submit the job again to resume the sweep"
    return
  fi
  echo "not complete; the job queues again"
  "${@:2}"
}
