#!/usr/bin/env bash
# tests/install_user.sh [FOLDER]: runs jobs/install-user.sh in an empty Debian in FOLDER (/tmp/clogsweep-user-root) that
# has only g++, CMake, Ninja, Open MPI and HDF5, as a user without root, without Python and without a network. Runs a
# sweep there, and checks the messages of commands that need Python. Needs root, debootstrap and dpkg-dev, and
# takes half an hour: run by hand, before a release. Exit code 1: a check fails.
set -euo pipefail
cd "$(dirname "$0")/.."
root=${1:-/tmp/clogsweep-user-root}
[ "$(id -u)" -eq 0 ] || { echo "needs root, for debootstrap and chroot" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "needs debootstrap: apt-get install debootstrap" >&2; exit 2; }

# In mounts of its own, which end with it.
[ -n "${OWN_MOUNTS-}" ] || OWN_MOUNTS=1 exec unshare --mount "$PWD/tests/install_user.sh" "$root"

if [ ! -d "$root/usr" ] || [ -d "$root/debootstrap" ]; then rm -rf "$root"; fi
[ -d "$root/usr" ] || debootstrap --variant=minbase bookworm "$root" >/dev/null
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"; }
# The same without a network.
offline() { unshare --net sh -c 'ip link set lo up && exec "$@"' sh chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 "$@"; }
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends g++ cmake ninja-build libopenmpi-dev openmpi-bin libhdf5-dev >/dev/null
inside apt-get -qq purge -y --autoremove python3 >/dev/null # of an earlier run that failed
for present in python3 /usr/include/eigen3 /usr/include/boost /usr/include/hwy /usr/include/fmt /usr/include/nlohmann; do
  if inside sh -c "command -v $present || test -e $present" >/dev/null; then echo "$root has $present" >&2; exit 1; fi
done
inside id visitor >/dev/null 2>&1 || inside useradd --create-home --shell /bin/bash visitor
home=$root/home/visitor
rm -rf "$home/clogsweep" "$home/installed"
mkdir "$home/clogsweep"
git ls-files -z --cached --others --exclude-standard | tar --null --files-from=- -c | tar -x -C "$home/clogsweep"
jobs/dependency-archive.sh "$home/dependencies.tar.gz"
inside chown -R visitor: /home/visitor

cat >"$home/visit.sh" <<'VISIT'
set -euxo pipefail
cd ~/clogsweep
# refused MESSAGE COMMAND...: the command ends with exit code 2 and one line that contains the message.
refused() {
  local message=$1 code=0
  shift
  "$@" >~/out 2>~/err || code=$?
  [ "$code" -eq 2 ]
  [ "$(wc -l <~/err)" -eq 1 ]
  grep -F -- "$message" ~/err
}
refused "missing --prefix" jobs/install-user.sh
refused "no file nowhere.tar.gz" jobs/install-user.sh --prefix ~/installed --archive nowhere.tar.gz
mkdir -p ~/few
for program in bash realpath dirname mkdir cmake c++; do ln -sf "$(command -v $program)" ~/few; done
refused "no mpicxx in the PATH" env PATH="$HOME/few" jobs/install-user.sh --prefix ~/installed
refused "missing Eigen3 3.4, hwy 1.0.3, Boost 1.74, nlohmann_json 3.11, fmt 9.1" jobs/install-user.sh --prefix ~/installed
jobs/install-user.sh --prefix ~/installed --archive ~/dependencies.tar.gz
jobs/install-user.sh --prefix ~/installed # does nothing new, and needs no archive

export PATH=~/installed/bin:$PATH PYTHONPATH=~/installed/lib/python3/dist-packages
mkdir -p ~/work
cd ~/work
clogsweep --version
keys="obstacle-gap=0.3 obstacle-density=saturated vertices=64 box=20 max-time=200"
mpirun --oversubscribe -np 2 clogsweep $keys line-tension=0.3,0.5 seeds=1..4 --output sweep.h5
clogfit sweep.h5
clogrun array $keys line-tension=0.5 seeds=1 --polygon-interval 20 --output run.h5
refused "clogfit calibrate: cannot run python3 (No such file or directory)" clogfit calibrate run.h5
refused "clogfit report: cannot run python3 (No such file or directory)" clogfit report sweep.h5
cmake -G Ninja -S ~/installed/share/doc/clogsweep/docs/examples/own-program -B own -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$HOME/installed;$HOME/installed/lib/clogsweep/dependencies"
cmake --build own
own/own-program
VISIT
offline su - visitor -c "bash visit.sh"

# With a Python that has no h5py and no pandas.
inside apt-get -qq install -y --no-install-recommends python3 >/dev/null
cat >"$home/python.sh" <<'PYTHON'
set -euxo pipefail
cd ~/work
export PATH=~/installed/bin:$PATH PYTHONPATH=~/installed/lib/python3/dist-packages
code=0
clogfit report sweep.h5 2>err || code=$?
[ "$code" -eq 2 ]
[ "$(wc -l <err)" -eq 1 ]
grep "^clogfit report: cannot start (No module named '" err
PYTHON
offline su - visitor -c "bash python.sh"
inside apt-get -qq purge -y --autoremove python3 >/dev/null
echo "the installation without root works"
