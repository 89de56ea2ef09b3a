#!/usr/bin/env bash
# Installs what is missing, builds, runs every test. Arguments go to ctest, e.g. ./tests/run.sh -L core
# PRESET=asan ./tests/run.sh does the same under the sanitizers. WARNINGS=errors: a warning of the compiler ends it.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${PRESET:-release}
./jobs/install-dependencies.sh tests
errors=OFF
if [ "${WARNINGS:-}" = errors ]; then errors=ON; fi
cmake --preset "$preset" -DCMAKE_COMPILE_WARNING_AS_ERROR=$errors
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel "$(nproc)" "$@"
