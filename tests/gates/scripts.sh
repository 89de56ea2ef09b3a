#!/usr/bin/env bash
# Shell scripts by shellcheck, Python by flake8. The width of Python's lines is left to whoever writes them (E501).
set -euo pipefail
cd "$(dirname "$0")/../.."
code=0
git ls-files -z --cached --others --exclude-standard -- '*.sh' '.ci/*' |
  xargs -0 shellcheck --external-sources --source-path=SCRIPTDIR || code=1
git ls-files -z --cached --others --exclude-standard -- '*.py' |
  xargs -0 flake8 --isolated --extend-ignore=E501 || code=1
exit $code
