#!/usr/bin/env bash
# install-user.sh --prefix DIR [--archive FILE] [CMAKE_OPTION...]: builds clogsweep without root in build/user, and
# installs it below DIR. Uses the compiler, CMake, MPI and HDF5 in the PATH, for instance from environment modules.
# Other libraries, if they are missing, are built from FILE, which jobs/dependency-archive.sh makes on a machine with a
# network.
set -euo pipefail
here=$(realpath "$(dirname "$0")/..")
usage="usage: install-user.sh --prefix DIR [--archive FILE] [CMAKE_OPTION...]"
fail() { echo "install-user.sh: $1" >&2; exit 2; }
prefix='' archive='' options=()
while [ $# -gt 0 ]; do
  case $1 in
    --prefix) prefix=${2:?$usage}; shift 2 ;;
    --archive) archive=${2:?$usage}; shift 2 ;;
    -D*) options+=("$1"); shift ;;
    --help) echo "$usage"; exit 0 ;;
    *) fail "unknown option $1; $usage" ;;
  esac
done
[ -n "$prefix" ] || fail "missing --prefix; $usage"
[ -z "$archive" ] || [ -f "$archive" ] || fail "no file $archive; jobs/dependency-archive.sh makes it"
mkdir -p "$prefix" || fail "cannot make $prefix; give another --prefix"
prefix=$(realpath "$prefix")
for program in cmake "${CXX:-c++}" mpicxx; do
  command -v "$program" >/dev/null || fail "no $program in the PATH; load its environment module, or ask the cluster's support"
done
build=$here/build/user
mkdir -p "$build"
generator="Unix Makefiles"
if command -v ninja >/dev/null; then generator=Ninja; fi
parallel=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

# Writes the names of missing libraries to missing.txt, and configures their build if the folder of their SOURCES is
# given.
dependencies=$prefix/lib/clogsweep/dependencies
configure_dependencies() {
  cmake -S "$here/cmake/dependencies" -B "$build/dependencies" -G "$generator" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$dependencies" -DCMAKE_INSTALL_PREFIX="$dependencies" -DCMAKE_INSTALL_LIBDIR=lib "$@" >"$build/dependencies.log" 2>&1 ||
    fail "cannot configure the dependencies; see $build/dependencies.log"
}
rm -rf "$build/dependencies"
configure_dependencies
missing=$(<"$build/dependencies/missing.txt")
if [ -n "$missing" ]; then
  [ -n "$archive" ] || fail "missing $missing; make an archive on a machine with a network (jobs/dependency-archive.sh FILE) and give --archive FILE"
  echo "from $archive: $missing"
  rm -rf "$build/clogsweep-dependencies"
  tar -xzf "$archive" -C "$build"
  configure_dependencies -DSOURCES="$build/clogsweep-dependencies"
  cmake --build "$build/dependencies" --parallel "$parallel" --target install >>"$build/dependencies.log" 2>&1 ||
    fail "cannot build $missing; see $build/dependencies.log"
fi

# The installed programs find MPI and HDF5 in their present folders, without LD_LIBRARY_PATH.
cmake --preset release -S "$here" -B "$build/clogsweep" -G "$generator" -DCLOG_TESTS=OFF -DCLOG_HANDBOOK=OFF \
  -DCMAKE_PREFIX_PATH="$dependencies" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_RPATH_USE_LINK_PATH=ON \
  -DCLOG_PYTHON_COMMAND=python3 "${options[@]}"
cmake --build "$build/clogsweep" --parallel "$parallel"
cmake --install "$build/clogsweep" >"$build/install.log"
cat <<HINT
clogsweep is installed. Add to ~/.bashrc:

    export PATH=$prefix/bin:\$PATH PYTHONPATH=$prefix/lib/python3/dist-packages
HINT
