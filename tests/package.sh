#!/usr/bin/env bash
# tests/package.sh [FOLDER]: the Debian packages, made by the preset package and installed into an empty Debian 12 in FOLDER
# (/tmp/clogsweep-root), where a user without a source tree runs a sweep and builds a program of their own. Needs root and
# debootstrap, and takes minutes: run by hand, before a release. Exit code 1: something of it fails.
set -euo pipefail
cd "$(dirname "$0")/.."
root=${1:-/tmp/clogsweep-root}
[ "$(id -u)" -eq 0 ] || { echo "needs root, for debootstrap and chroot" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "needs debootstrap: apt-get install debootstrap" >&2; exit 2; }

# In mounts of its own, which end with it.
[ -n "${OWN_MOUNTS-}" ] || OWN_MOUNTS=1 exec unshare --mount "$PWD/tests/package.sh" "$root"

./jobs/install-dependencies.sh docs package
cmake --preset package >/dev/null
cmake --build --preset package
rm -f build/package/*.deb
(cd build/package && cpack >/dev/null)
if [ ! -d "$root/usr" ] || [ -d "$root/debootstrap" ]; then rm -rf "$root"; fi
[ -d "$root/usr" ] || debootstrap --variant=minbase bookworm "$root" >/dev/null
cp build/package/clogsweep_*.deb "$root/tmp/clogsweep.deb"

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends man-db bash-completion >/dev/null
inside apt-get -qq install -y --no-install-recommends --reinstall /tmp/clogsweep.deb >/dev/null
inside id visitor >/dev/null 2>&1 || inside useradd --create-home --shell /bin/bash visitor

cat >"$root/home/visitor/visit.sh" <<'VISIT'
set -euxo pipefail
cd "$(mktemp -d)"
clogsweep --version
man clogsweep | grep -- --until-precision >/dev/null
man clogsweep-keys | grep line-tension >/dev/null
. /usr/share/bash-completion/bash_completion
_completion_loader clogsweep || true
complete -p clogsweep
keys="obstacle-gap=0.3 obstacle-density=saturated vertices=64 box=20 max-time=200"
mpirun --oversubscribe -np 2 clogsweep $keys line-tension=0.3,0.5 seeds=1..4 --output sweep.h5
clogfit sweep.h5
clogfit report sweep.h5 --output report.html
python3 -m clogsweep clogging-length sweep.h5
python3 -c 'import clogsweep; print(clogsweep.open("sweep.h5").fit().groups.clogging_length)'
clogrun array $keys line-tension=0.5 seeds=1 --polygon-interval 20 --output run.h5 --frames film.gif
clogsweep --config /usr/share/clogsweep/jobs/laptop.cfg --print-config | grep line-tension
ls -l
VISIT
inside su - visitor -c "bash visit.sh"

cp build/package/libclogsweep-dev_*.deb "$root/tmp/libclogsweep-dev.deb"
inside apt-get -qq install -y --no-install-recommends --reinstall /tmp/libclogsweep-dev.deb g++ cmake make >/dev/null
cat >"$root/home/visitor/build.sh" <<'BUILD'
set -euxo pipefail
cd "$(mktemp -d)"
cmake -S /usr/share/doc/clogsweep/docs/examples/own-program -B . -DCMAKE_BUILD_TYPE=Release
cmake --build .
./own-program
BUILD
inside su - visitor -c "bash build.sh"
echo "the packages work"
