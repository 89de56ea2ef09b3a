# Sourced by the scripts for batch systems.
# shellcheck shell=bash
# shellcheck source=jobs/mpi-settings.sh
. "$(dirname "${BASH_SOURCE[0]}")/mpi-settings.sh"

# run_sweep PROGRAM ARGS...: runs it by mpirun. A warning of the batch system (SIGUSR1, or SIGTERM) goes on to the ranks as SIGUSR1:
# Open MPI forwards that one and leaves them the time to write what they have. Returns the sweep's exit code, 75 when it
# is not complete and the same command goes on; was_cancelled is 1 if SIGTERM came, which is no warning but the end.
run_sweep() {
  local code warned=0 sweep
  # shellcheck disable=SC2034  # the scripts that source this one read it
  was_cancelled=0
  # Set before the sweep begins, since a warning may come at any time: either $! is there, or the sweep sees `warned`.
  trap 'warned=1; kill -USR1 "${!:-}" 2>/dev/null || true' USR1
  trap 'warned=1; was_cancelled=1; kill -USR1 "${!:-}" 2>/dev/null || true' TERM
  {
    ((!warned)) || exit 75
    exec mpirun "$@"
  } &
  sweep=$!
  while true; do
    code=0
    wait "$sweep" || code=$?
    # A signal to this script ends the waiting, not the sweep.
    if ((warned && code > 128)) && kill -0 "$sweep" 2>/dev/null; then
      warned=0
      continue
    fi
    ((warned && code > 128)) || break
    warned=0
  done
  trap - USR1 TERM
  # Killed by the warning, before mpirun or a rank could take it as one. Nothing has begun, or what has is kept.
  if ((code > 128)) && [[ $(kill -l "$code") == USR1 ]]; then code=75; fi
  return "$code"
}
