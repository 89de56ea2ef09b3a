#!/usr/bin/env bash
# tests/gates/run.sh [--all] [GATE...]: installs what is missing, then looks at the sources by every gate, or those named.
# clang++ and clang-tidy look at what changed, with --all at everything. Exit code 1: a gate has found something. See README.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
every=(format width spelling codespell phrases ages scripts types docs warnings tidy)
limits=(--changed --most 20)
if [ "${1:-}" = --all ]; then
  limits=()
  shift
fi
if [ $# -eq 0 ]; then set -- "${every[@]}"; fi
for gate in "$@"; do
  [[ " ${every[*]} " == *" $gate "* ]] || { echo "no gate is called $gate; there are: ${every[*]}" >&2; exit 2; }
done
./jobs/install-dependencies.sh gates

look() {
  case $1 in
    format | scripts) "tests/gates/$1.sh" ;;
    codespell)
      git ls-files -z --cached --others --exclude-standard -- ':!*.ipynb' ':!tests/faults/fuzz/corpus' |
        xargs -0 codespell --ignore-words tests/gates/codespell.txt
      ;;
    types) mypy --config-file tests/gates/mypy.ini analysis/clogsweep ;;
    ages) python3 tests/gates/ages.py ;;
    docs) docs/build.sh && /usr/bin/python3 tests/gates/site.py build/docs/html ;;
    width | spelling | phrases) python3 "tests/gates/$1.py" ;;
    warnings | tidy) python3 tests/gates/clang.py "$1" "${limits[@]}" ;;
  esac
}

verdicts=()
code=0
TIMEFORMAT='%R s, CPU %U s'
for gate in "$@"; do
  echo "== $gate"
  verdict=clean
  { time look "$gate"; } 2>&1 || { verdict="FINDS SOMETHING"; code=1; }
  verdicts+=("$gate: $verdict")
done
echo "== verdicts"
printf '%s\n' "${verdicts[@]}"
exit $code
