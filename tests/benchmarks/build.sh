#!/usr/bin/env bash
# tests/benchmarks/build.sh [SOURCE_FOLDER]: processor time of compiling the programs and the tests of a source folder
# (this one) without a compiler cache, and of running the tests of tests/run.sh. Times of compiling are also given as
# multiples of the time of compile_reference.cpp, which is compiled before and after. Takes a quarter of an hour.
set -euo pipefail
here=$(realpath "$(dirname "$0")")
source=$(realpath "${1:-$here/../..}")
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
export CCACHE_DISABLE=1
unset CMAKE_CXX_COMPILER_LAUNCHER CMAKE_C_COMPILER_LAUNCHER

# Prints the processor seconds of a command.
seconds_of() {
  local TIMEFORMAT='%U %S'
  { time "$@" >"$build/log" 2>&1 || { cat "$build/log" >&2; return 1; }; } 2>&1 | awk '{ print $1 + $2 }'
}
reference() { seconds_of g++ -O2 -std=c++20 -I/usr/include/eigen3 -c "$here/compile_reference.cpp" -o "$build/reference.o"; }
configure() { cmake -S "$source" --preset release -B "$build/tree" "$@" >/dev/null; }

before=$(reference)
configure -DCLOG_TESTS=OFF
programs=$(seconds_of cmake --build "$build/tree" --target clogsweep clogrun clogfit)
configure -DCLOG_TESTS=ON
tests=$(seconds_of cmake --build "$build/tree")
after=$(reference)
running=$(seconds_of ctest --test-dir "$build/tree" --parallel "$(nproc)" --label-exclude slow)
awk -v before="$before" -v after="$after" -v programs="$programs" -v tests="$tests" -v running="$running" 'BEGIN {
  reference = (before + after) / 2
  printf "%-32s %8.1f s\n", "reference file", reference
  printf "%-32s %8.1f s  %6.1f times the reference\n", "compiling the programs", programs, programs / reference
  printf "%-32s %8.1f s  %6.1f times the reference\n", "compiling the tests after that", tests, tests / reference
  printf "%-32s %8.1f s\n", "running the tests", running
}'
