#!/usr/bin/env bash
# Installs what is missing, builds, runs every test. Arguments go to ctest, e.g. ./tests/run.sh -L core
# PRESET=asan ./tests/run.sh does the same under the sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${PRESET:-release}
./jobs/install-dependencies.sh
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel "$(nproc)" "$@"
