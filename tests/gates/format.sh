#!/usr/bin/env bash
# C++ as clang-format with .clang-format would write it. `clang-format -i FILE` mends.
set -euo pipefail
cd "$(dirname "$0")/../.."
git ls-files -z --cached --others --exclude-standard -- '*.cpp' '*.hpp' | xargs -0 clang-format --dry-run --Werror
