#!/usr/bin/env bash
# From a fresh Debian 12 or 13 to a clogging-length curve: installs what is missing, builds, runs the sweep of
# jobs/laptop.cfg on two ranks, fits and draws. Results go to a new folder under results/.
set -euo pipefail
cd "$(dirname "$0")/.."
./jobs/install-dependencies.sh
# tests/run.sh uses the same build folder. If it has configured the folder with tests, the tests stay enabled.
[ -f build/release/build.ninja ] || cmake --preset release -DCLOG_TESTS=OFF >/dev/null
cmake --build --preset release --target clogsweep clogrun clogfit
. jobs/mpi-settings.sh

results=results/laptop-$(date +%Y%m%d-%H%M%S)
mkdir -p "$results"
bin=build/release/bin
sweep=(mpirun -np 2 "$bin/clogsweep" --config jobs/laptop.cfg --output "$results/sweep.h5")
"${sweep[@]}"
# Without friction only stiff droplets are run: softer ones would not clog in this time.
"${sweep[@]}" friction=0 line-tension=0.35,0.4,0.5,0.6
# Debian's own Python has the packages, but another Python may come first in the path.
PYTHONPATH=analysis /usr/bin/python3 -m clogsweep clogging-length "$results/sweep.h5" --programs "$bin" \
    --output "$results/clogging-length"
echo
"$bin/clogfit" "$results/sweep.h5" | tee "$results/fit.txt"
echo
echo "runs:    $results/sweep.h5"
echo "picture: $results/clogging-length.png (and .pdf)"
echo "the programs themselves: export PATH=$PWD/$bin:\$PATH PYTHONPATH=$PWD/analysis"
