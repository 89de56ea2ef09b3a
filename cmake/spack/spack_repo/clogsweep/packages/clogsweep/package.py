"""How Spack builds clogsweep, from the repository that this file is in; docs/how-to/install.md says how to call it.

It needs Spack 1.0 or later. Names and variants are those of spack-packages of July 2026; it has not been run by Spack.
"""

import pathlib

from spack.package import EnvironmentModifications, conflicts, depends_on, filter_file, find, license, requires, version
from spack_repo.builtin.build_systems.cmake import CMakePackage

REPOSITORY = pathlib.Path(__file__).resolve().parents[6]
_LINES = (REPOSITORY / "cmake" / "dependencies.txt").read_text().splitlines()
MINIMUM = {line.split()[0]: line.split()[1] for line in _LINES if line[:1].isalpha()}


class Clogsweep(CMakePackage):
    """Follows droplets that sink through a forest of obstacles until they clog, one by one on as many cores as there
    are, and fits clogging lengths and speeds."""

    git = f"file://{REPOSITORY}"

    license("BSD-3-Clause")

    version("1.1.0", tag="v1.1.0")
    version("1.0.0", tag="v1.0.0")
    version("0.2.0", tag="v0.2.0")
    version("main", branch="main", get_full_repo=True)  # `git describe` counts commits since the last tag

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on(f"cmake@{MINIMUM['CMake']}:", type="build")
    depends_on(f"boost@{MINIMUM['Boost']}: +program_options")
    depends_on(f"eigen@{MINIMUM['Eigen3']}")
    depends_on(f"fmt@{MINIMUM['fmt']}:")
    depends_on(f"hdf5@{MINIMUM['HDF5']}:1.14 ~mpi")  # one rank writes
    depends_on(f"highway@{MINIMUM['hwy']}:")
    depends_on(f"nlohmann-json@{MINIMUM['nlohmann_json']}:")
    depends_on("openmpi@4.1:")
    depends_on("zlib-api")
    # For figures, and for the shell completion.
    depends_on(f"python@{MINIMUM['Python']}:", type=("build", "run"))
    depends_on("py-h5py ~mpi", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-pandas", type="run")
    depends_on("py-scipy", type="run")
    depends_on("py-tables", type="run")

    conflicts(f"%gcc@:{int(MINIMUM['GNU']) - 1}", msg=f"clogsweep is C++20; it is tested with g++ {MINIMUM['GNU']} and clang {MINIMUM['Clang']}")
    # Compiled for one processor, rows would have other last bits than those of the same release elsewhere. What gains
    # from vector instructions chooses them by itself when a program starts.
    requires("target=x86_64", when="target=x86_64:")

    sanity_check_is_file = ["bin/clogsweep", "bin/clogrun", "bin/clogfit"]

    def patch(self):
        """Scripts are written for the system's Python."""
        filter_file("^#!/usr/bin/python3$", "#!/usr/bin/env python3", *find("analysis", "*.py"))

    def cmake_args(self):
        return [
            self.define("CLOG_TESTS", False),
            self.define("CLOG_PYTHON", self.spec["python"].command.path),
            self.define("CLOG_SPHINX", False),  # no man pages, which need MyST
            self.define("CMAKE_CXX_FLAGS_RELEASE", "-O3"),  # as in CMakePresets.json: assertions stay
        ]

    def setup_run_environment(self, env: EnvironmentModifications) -> None:
        env.prepend_path("PATH", self.prefix.share.clogsweep.analysis)
