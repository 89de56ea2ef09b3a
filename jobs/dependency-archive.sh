#!/usr/bin/env bash
# dependency-archive.sh ARCHIVE.tar.gz: makes an archive of dependencies, which jobs/install-user.sh builds if they are
# not installed. Run it on a Debian or Ubuntu machine with a network and dpkg-dev; root is not needed. The archive
# contains Debian's sources of Eigen, Boost (the headers that we need, Program_options), fmt, Highway, nlohmann-json and
# zlib, with their licences.
set -euo pipefail
export LC_ALL=C
[ $# -eq 1 ] || { echo "usage: dependency-archive.sh ARCHIVE.tar.gz" >&2; exit 2; }
archive=$(realpath "$1")
[ -d "$(dirname "$archive")" ] || { echo "no folder for $archive" >&2; exit 2; }
for program in apt-get dpkg-source; do
  command -v "$program" >/dev/null || { echo "needs $program, of the Debian package ${program/#*-*/apt or dpkg-dev}" >&2; exit 2; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# Package lists of our own name the sources of this machine's distribution.
mkdir -p state/lists/partial cache/archives/partial
# shellcheck disable=SC2016 # apt-get expands the names
apt-get indextargets --format '$(ORIGIN) $(SITE) $(RELEASE) $(COMPONENT)' "Identifier: Packages" |
  sed -n 's/^\(Debian\|Ubuntu\) /deb-src /p' | sort -u >sources.list
apt_get() {
  apt-get -qq -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=- -o Dir::State="$work/state" \
    -o Dir::State::status=/dev/null -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" "$@"
}
apt_get update
boost=boost$(apt_get source --print-uris boost-defaults | sed -n 's/.* boost-defaults_\([0-9]*\.[0-9]*\).*\.dsc .*/\1/p')
mkdir unpacked
(cd unpacked && apt_get source "$boost" eigen3 fmtlib highway nlohmann-json3 zlib >/dev/null)

out=clogsweep-dependencies
mkdir "$out"
for source in boost*:boost eigen3:eigen fmtlib:fmt highway:highway nlohmann-json3:nlohmann-json zlib:zlib; do
  pattern=${source%:*} name=${source#*:}
  # The name of the unpacked folder contains a version.
  folder=$(find unpacked -mindepth 1 -maxdepth 1 -type d -name "${pattern}-*")
  mv "$folder" "$name"
  mkdir "$out/$name"
  cp "$name/debian/copyright" "$out/$name/"
  (cd "$name" && dpkg-parsechangelog --show-field Source && dpkg-parsechangelog --show-field Version) | paste -sd ' ' >>"$out/VERSIONS"
done
cp -r eigen/{Eigen,COPYING.*} "$out/eigen"
cp -r fmt/{CMakeLists.txt,support,include,src,LICENSE*,README.*,ChangeLog.*} "$out/fmt"
cp -r highway/{CMakeLists.txt,cmake,hwy,LICENSE*} highway/*.in "$out/highway"
cp -r nlohmann-json/{CMakeLists.txt,cmake,include,LICENSE*} nlohmann-json/*.natvis "$out/nlohmann-json"
cp zlib/*.[ch] zlib/README "$out/zlib"

# Copies the Boost libraries that we include, and those that these include.
cp -r boost/libs/program_options/src boost/LICENSE_1_0.txt "$out/boost"
(cd boost/libs && find . -path '*/include/boost/*' -type f -printf '%P\n' | sed 's,\(.*\)/include/,\1 ,' | sort -k 2) >headers
printf '%s\n' crc math program_options random | sort >wanted
: >taken
while [ -s wanted ]; do
  sort -o taken -u taken wanted
  { echo boost/libs/program_options/src; sed 's,.*,boost/libs/&/include,' wanted; } |
    xargs -d '\n' grep -rhoE '^ *# *include *[<"]boost/[^>"]+' | sed 's/.*[<"]//' | sort -u >included
  join -1 2 -2 1 -o 1.1 headers included | sort -u | comm -23 - taken >wanted
done
while read -r library; do cp -r "boost/libs/$library/include" "$out/boost"; done <taken

tar --sort=name --owner=0 --group=0 --numeric-owner -czf "$archive" "$out"
echo "$archive: $(paste -sd ',' "$out/VERSIONS" | sed 's/,/, /g')"
