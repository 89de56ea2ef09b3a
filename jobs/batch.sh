# Sourced by the scripts for batch systems.

# run_sweep PROGRAM ARGS...: runs it by mpirun. A warning of the batch system (SIGUSR1, or SIGTERM) goes on to the ranks as SIGUSR1:
# Open MPI forwards that one and leaves them the time to write what they have. Returns the sweep's exit code, 75 when it
# is not complete and the same command goes on; was_cancelled is 1 if SIGTERM came, which is no warning but the end.
run_sweep() {
  local code warned=0 sweep
  was_cancelled=0
  mpirun "$@" &
  sweep=$!
  trap 'warned=1; kill -USR1 "$sweep" 2>/dev/null' USR1
  trap 'warned=1; was_cancelled=1; kill -USR1 "$sweep" 2>/dev/null' TERM
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
  return "$code"
}
