#!/usr/bin/env bash
# docs/paper/figures.sh [NAME...]: makes the paper's figures anew, in results/paper: clogging-length clogs mesh (all).
# CLOG_BIN is the folder of the programs (build/release/bin). The same command resumes a stopped sweep.
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=${CLOG_BIN:-build/release/bin}
[ -x "$bin/clogsweep" ] || { echo "no clogsweep in $bin: build it with ./jobs/laptop.sh, or set CLOG_BIN" >&2; exit 2; }
. jobs/mpi-settings.sh
if [ $# -eq 0 ]; then set -- clogging-length clogs mesh; fi
folder=results/paper
mkdir -p "$folder"

export PYTHONPATH=$PWD/analysis
draw() { /usr/bin/python3 -m clogsweep "$@" --programs "$bin"; }

for name in "$@"; do
  case $name in
    clogging-length) # little more than a minute on two idle cores; docs/pictures/clogging-length.png
      sweep=(mpirun -np 2 "$bin/clogsweep" --config jobs/laptop.cfg --output "$folder/sweep.h5")
      "${sweep[@]}"
      "${sweep[@]}" friction=0 line-tension=0.35,0.4,0.5,0.6
      draw clogging-length "$folder/sweep.h5" --output "$folder/clogging-length"
      ;;
    clogs) # docs/pictures/figure-5.png, 6a and 6b
      sets=()
      for key in line-tension=0.1,0.5 friction=0.1 obstacle-gap=0.3 obstacle-density=65% vertices=512 seeds=1..3 \
        box=50 boxes=4 max-time=6000; do sets+=(--set "clogging-friction:$key"); done
      draw figures 5 6a 6b --output "$folder/clogs" "${sets[@]}"
      ;;
    mesh) draw figures W1 --output "$folder/mesh" ;; # docs/pictures/figure-W1.png
    *) echo "no figure is called $name; there are: clogging-length clogs mesh" >&2; exit 2 ;;
  esac
done
