#!/usr/bin/env bash
# tests/benchmarks/run.sh [FOLDER_OF_PROGRAMS]: runs all benchmarks and prints a table, in under 5 minutes. What the
# numbers mean: docs/developer/speed.md. Compare numbers of one machine, taken side by side.
set -euo pipefail
cd "$(dirname "$0")"
bin=$(realpath "${1:-../../build/release/bin}")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
scheduled() { ../mpirun.sh "$@"; }

echo "== a step (bench_step)"
"$bin/bench_step" --benchmark_min_time=0.3 --benchmark_repetitions=3 --benchmark_report_aggregates_only=true \
  --benchmark_enable_random_interleaving=true 2>/dev/null | grep -E '^-|^Benchmark|_median'
echo "== runs of real sweeps, and the limit of a step without contacts (bench_sweep)"
"$bin/bench_sweep" 3
echo "== a step in a large box (bench_box)"
"$bin/bench_box"
echo "== an obstacle array (bench_array)"
"$bin/bench_array"
echo "== the master: a thousand tasks per second, and waiting (bench_master)"
scheduled 33 "$bin/bench_master" 1200 8
scheduled 5 "$bin/bench_master" 0 8
echo "== the end of a sweep on 64 workers (bench_tail)"
for lengths in run-lengths-dp.csv run-lengths-sp.csv; do
  for seeds in 16 50 150; do
    echo "$lengths: $("$bin/bench_tail" "$lengths" 64 "$seeds")"
  done
done
echo "== two ranks against one (two_ranks.py)"
"$python" two_ranks.py "$bin"
