#!/usr/bin/env bash
# docs/build.sh [FOLDER]: the site of these pages, and the interface of the library by Doxygen (build/docs).
# A warning is an error: a link that leads nowhere, a page that no other names.
set -euo pipefail
cd "$(dirname "$0")/.."
site=${1:-build/docs}
./jobs/install-dependencies.sh docs

mkdir -p "$site"
sphinx-build -W --keep-going -q -t site -b html -d "$site/.doctrees" docs "$site/html"
(cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $site"; echo "HTML_OUTPUT = html/api") | doxygen -
echo "$site/html/index.html"
