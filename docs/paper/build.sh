#!/usr/bin/env bash
# docs/paper/build.sh [FILE]: the paper as one page of HTML that opens offline (build/paper/paper.html), by pandoc.
# A citation that is not in paper.bib, or a picture that is not there, ends the build.
set -euo pipefail
cd "$(dirname "$0")/../.."
page=${1:-build/paper/paper.html}
./jobs/install-dependencies.sh paper

mkdir -p "$(dirname "$page")"
# The journal's "authors" are not pandoc's "author". The stylesheet goes into the page, with the pictures.
pandoc docs/paper/paper.md --output "$page" --standalone --self-contained --fail-if-warnings --citeproc \
  --resource-path docs/paper --bibliography docs/paper/paper.bib --css docs/paper/page.css \
  --metadata author="The clogsweep developers" --metadata lang=en-GB
echo "$page"
