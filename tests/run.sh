#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests that a developer needs before a commit. With --all first: every test.
# Other arguments go to ctest, e.g. ./tests/run.sh -L core
# PRESET=asan ./tests/run.sh does the same under the sanitizers. WARNINGS=errors: a warning of the compiler ends it.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${PRESET:-release}
part=(--label-exclude slow)
groups=(tests)
handbook=OFF # whose man pages a slow test reads
if [ "${1:-}" = --all ]; then
  part=()
  groups=(tests docs)
  handbook=ON
  shift
fi
./jobs/install-dependencies.sh "${groups[@]}"
errors=OFF
if [ "${WARNINGS:-}" = errors ]; then errors=ON; fi
cmake --preset "$preset" -DCLOG_TESTS=ON -DCLOG_HANDBOOK=$handbook -DCMAKE_COMPILE_WARNING_AS_ERROR=$errors
# Tests wait for mpirun and timers, so three at a time on each core finish soonest.
TIMEFORMAT='%R s, processor time %U s'
time cmake --build --preset "$preset"
time ctest --preset "$preset" --parallel $((3 * $(nproc))) "${part[@]}" "$@"
