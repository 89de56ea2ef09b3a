#!/usr/bin/env bash
# tests/faults/fuzz/run.sh SECONDS [TARGET...]: every fuzz target, or those named, for so long, each from the same seed.
# What they find is written to build/fuzz/findings, inputs of new coverage to build/fuzz/corpus. Exit code 1: a finding.
set -euo pipefail
cd "$(dirname "$0")/../../.."
seconds=${1:?usage: run.sh SECONDS [TARGET...]}
shift
seeds=tests/faults/fuzz/corpus
if [ $# -eq 0 ]; then
  set -- "$seeds"/*
  set -- "${@##*/}"
fi

code=0
for target in "$@"; do
  echo "== $target"
  mkdir -p "build/fuzz/corpus/$target" build/fuzz/findings
  leaks=1
  if [ "$target" = sweep_file ]; then leaks=0; fi  # HDF5 keeps memory of what it could not read
  log=build/fuzz/findings/$target.log
  # HDF5 asks for 4 GB where a damaged size says so, in the process that may die, and never touches them: no finding.
  # A timeout is of the clock: so long that no busy machine is taken for an input that never ends.
  ASAN_OPTIONS=detect_leaks=$leaks "build/fuzz/bin/fuzz_$target" -seed=1 -max_total_time="$seconds" -timeout=300 \
    -rss_limit_mb=2048 -malloc_limit_mb=65536 -dict=tests/faults/fuzz/words.dict -print_final_stats=1 \
    -artifact_prefix="build/fuzz/findings/$target-" "build/fuzz/corpus/$target" "$seeds/$target" > "$log" 2>&1 || code=1
  grep -aE "ERROR|SUMMARY|runtime error|Test unit|number_of_executed_units|average_exec_per_sec|peak_rss" "$log"
done
exit $code
