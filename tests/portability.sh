#!/usr/bin/env bash
# tests/portability.sh bookworm|trixie [FOLDER]: builds the last commit and tests it in an empty Debian 12 or 13, made
# in FOLDER (/tmp/clogsweep-bookworm, /tmp/clogsweep-trixie): with g++ and Open MPI by tests/run.sh, with MPICH by the
# tests of the scheduler; with clang++ the programs are only built. Needs root, debootstrap and gigabytes, and takes an
# hour or more: run by hand, before a release. The last line says what passed. Exit code not 0: something of it fails;
# FOLDER then holds the builds, and Testing/Temporary/LastTest.log.
set -euo pipefail
cd "$(dirname "$0")/.."
usage="usage: tests/portability.sh bookworm|trixie [FOLDER]"
release=${1:-}
root=${2:-/tmp/clogsweep-$release}
case $release in bookworm | trixie) ;; *) echo "$usage" >&2; exit 2 ;; esac
[ "$(id -u)" -eq 0 ] || { echo "needs root, for debootstrap and chroot" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "needs debootstrap: apt-get install debootstrap" >&2; exit 2; }

# In mounts and processes of its own, which end with it.
[ -n "${OWN_NAMESPACES-}" ] || OWN_NAMESPACES=1 exec unshare --mount --pid --fork --kill-child "$PWD/tests/portability.sh" "$release" "$root"

[ ! -e "$root" ] || { echo "$root exists; remove it, or give another FOLDER" >&2; exit 2; }
# Where this machine has its own packages from.
# shellcheck disable=SC2016  # apt-get replaces $(REPO_URI)
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' 'Component: main' | head -n 1)
[ -n "$mirror" ] || { echo "apt's sources name no Debian archive; configure one, then run apt-get update" >&2; exit 2; }

# Left out: those that make hosts of namespaces, which a chroot forbids to ordinary users, and those that need a browser.
left_out='^programs\.(hosts|report)$'
home=$root/home/visitor
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }
as_visitor() { inside su - visitor -c "export LC_ALL=C.UTF-8; cd clogsweep && $*"; }

debootstrap --variant=minbase "$release" "$root" "$mirror" >/dev/null
mount -t proc proc "$root/proc"
mount -t sysfs sysfs "$root/sys" # where Open MPI finds the cores
mount --rbind /dev "$root/dev"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # nobody needs this root after a crash
inside apt-get -qq update
inside useradd --create-home --shell /bin/bash visitor
git -c advice.detachedHead=false clone -q . "$home/clogsweep"
inside /home/visitor/clogsweep/jobs/install-dependencies.sh tests
inside /home/visitor/clogsweep/jobs/install-dependencies.sh mpich
inside apt-get -qq install -y --no-install-recommends clang >/dev/null
inside chown -R visitor: /home/visitor

# passed LOG: how many tests passed, of how many.
passed() { sed -n 's/^.*tests passed, \([0-9]*\) tests* failed out of \([0-9]*\).*$/\2 \1/p' "$1" | awk '{ print $1 - $2 " of " $1 " tests passed" }'; }
# version PRESET LIBRARY: as the programs of this build name it.
version() { as_visitor "build/$1/bin/clogsweep --version" | sed -n "s/^$2: *//p"; }

as_visitor "WARNINGS=errors ./tests/run.sh --exclude-regex '$left_out'" 2>&1 | tee "$root/tmp/open-mpi.log"
as_visitor "cmake --preset mpich && cmake --build --preset mpich --target clogsweep test_scheduler test_run_tasks test_isolated_jobs \
  && ctest --preset mpich -L scheduler" 2>&1 | tee "$root/tmp/mpich.log"
as_visitor "cmake --preset release -B build/clang -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCLOG_TESTS=OFF \
  && cmake --build build/clang" 2>&1 | tee "$root/tmp/clang.log"
echo "$release: g++ $(inside g++ -dumpfullversion), HDF5 $(version release HDF5), $(version release MPI):" \
  "$(passed "$root/tmp/open-mpi.log") (left out: $left_out);" \
  "$(version mpich MPI): $(passed "$root/tmp/mpich.log");" \
  "clang++ $(inside clang++ -dumpversion): builds"
