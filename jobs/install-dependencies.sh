#!/usr/bin/env bash
# install-dependencies.sh [GROUP...]: installs the missing Debian packages that are needed for the programs and for
# laptop.sh with its picture, and for each GROUP:
#   tests      tests/run.sh (includes drawings)
#   gates      tests/gates (includes tests and docs)
#   docs       the handbook: man pages, the site, the interface of the library
#   drawings   drawings and pictures of devices (python3 -m clogsweep circles)
#   package    Debian packages by cpack
#   paper      docs/paper
#   mpich      MPICH, beside Open MPI
set -euo pipefail
# Packages for building the programs: the names from the third column on in cmake/dependencies.txt.
mapfile -t packages < <(awk '/^[A-Za-z]/ { for (i = 3; i <= NF; ++i) if ($i != "-") print $i }' \
  "$(dirname "$0")/../cmake/dependencies.txt")
packages+=(
  git                                                # tells a build its version
  python3-h5py python3-pandas python3-scipy python3-tables python3-matplotlib   # the Python module
)
drawings=(python3-ezdxf python3-gdspy python3-svgelements librsvg2-bin python3-skimage python3-shapely)
tests=(
  "${drawings[@]}"
  libgtest-dev libbenchmark-dev                      # tests and benchmarks
  procps iproute2                                    # tests that kill ranks, and that connect two hosts
  chromium-driver python3-selenium hdf5-tools        # a browser that reads a report; h5repack
  python3-nbclient python3-ipykernel                 # a test that runs the notebook of the gallery
  python3-setuptools python3-wheel python3-venv      # a test that installs the Python module by pip
)
docs=(
  python3-sphinx python3-myst-parser python3-sphinx-copybutton furo   # man pages and site, from the handbook
  python3-nbsphinx pandoc libjs-mathjax              # notebooks and formulas of the site
  doxygen                                            # the interface of the library
)
for group in "$@"; do
  case $group in
    tests) packages+=("${tests[@]}") ;;
    gates)
      packages+=("${tests[@]}" "${docs[@]}" clang clang-format clang-tidy aspell aspell-en codespell shellcheck flake8 mypy)
      ;;
    docs) packages+=("${docs[@]}") ;;
    drawings) packages+=("${drawings[@]}") ;;
    package) packages+=(dpkg-dev file) ;;
    paper) packages+=(pandoc) ;;
    mpich) packages+=(mpich libmpich-dev) ;;
    *) echo "usage: install-dependencies.sh [tests|gates|docs|drawings|package|paper|mpich]..." >&2; exit 2 ;;
  esac
done
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
