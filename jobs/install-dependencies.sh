#!/usr/bin/env bash
# Installs what is missing of the Debian 12 packages that clogsweep needs. Does nothing when all are there.
# With the argument `tests`: those, too, that the tests need; with `gates`: those that look at its sources
# (tests/gates/README.md); with `docs`: those that make the site of docs/; with `paper` what makes a page of docs/paper;
# with `mpich` MPICH, beside Open MPI
set -euo pipefail
packages=(
  g++ cmake ninja-build git                          # to build
  dpkg-dev file                                      # Debian packages, by cpack
  libopenmpi-dev openmpi-bin                         # MPI
  libhdf5-dev zlib1g-dev                             # the table of runs, its checksums
  libeigen3-dev libhwy-dev                           # arrays; vector instructions
  libboost-dev libboost-program-options-dev          # random numbers and statistics; command line
  nlohmann-json3-dev libnlopt-cxx-dev                # JSON; the optimiser of clogfit calibrate
  libfmt-dev                                         # text with numbers in it
  libgtest-dev libbenchmark-dev                      # tests and benchmarks
  procps iproute2                                    # tests that kill ranks, and join two hosts
  python3-sphinx python3-myst-parser python3-sphinx-copybutton furo      # man pages, from the handbook
  python3-ezdxf python3-gdspy python3-svgelements python3-skimage python3-shapely  # drawings and pictures of devices
  python3-nbsphinx pandoc libjs-mathjax              # the handbook as a site, which the Debian package holds
  python3 python3-h5py python3-pandas python3-tables python3-matplotlib  # the Python module, and readers for the tests
  python3-nbclient python3-ipykernel                 # a test that runs the notebook of the gallery
)
of_tests=(chromium-driver python3-selenium hdf5-tools) # a browser that reads a report; h5repack
case ${1:-} in
  "") ;;
  tests) packages+=("${of_tests[@]}") ;;
  gates) packages+=("${of_tests[@]}" clang clang-format clang-tidy aspell aspell-en shellcheck flake8 mypy) ;;
  docs) packages+=(doxygen) ;;
  paper) packages+=(pandoc) ;;
  mpich) packages+=(mpich libmpich-dev) ;;
  *) echo "usage: install-dependencies.sh [tests|gates|docs|paper|mpich]" >&2; exit 2 ;;
esac
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "needs root or sudo to install: ${missing[*]}" >&2; exit 2; }
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
