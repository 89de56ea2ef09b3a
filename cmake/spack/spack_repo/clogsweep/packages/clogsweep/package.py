"""How Spack builds clogsweep, from the repository that this file is in; docs/how-to/install.md says how to call it.

It needs Spack 1.0 or later. Names and variants are those of spack-packages of July 2026; it has not been run by Spack.
"""

import pathlib

from spack.package import EnvironmentModifications, conflicts, depends_on, filter_file, find, license, requires, version
from spack_repo.builtin.build_systems.cmake import CMakePackage

REPOSITORY = pathlib.Path(__file__).resolve().parents[6]


class Clogsweep(CMakePackage):
    """Follows droplets that sink through a forest of obstacles until they clog, one by one on as many cores as there
    are, and fits clogging lengths and speeds."""

    git = f"file://{REPOSITORY}"

    license("BSD-3-Clause")

    version("0.2.0", tag="v0.2.0")
    version("main", branch="main", get_full_repo=True)  # `git describe` counts commits since the last tag

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("boost@1.74: +program_options")
    depends_on("eigen@3.4")
    depends_on("fmt@9.1:")
    depends_on("hdf5@1.10:1.14 ~mpi")  # one rank writes
    depends_on("highway@1.0.3:")
    depends_on("nlohmann-json@3.11:")
    depends_on("nlopt@2.7: +cxx ~python")
    depends_on("openmpi@4.1:")
    depends_on("zlib-api")
    # The scripts that draw need it, and so does the one that makes the completion.
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-h5py ~mpi", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-pandas", type="run")
    depends_on("py-tables", type="run")

    conflicts("%gcc@:11", msg="clogsweep is C++20; it is tested with g++ 12 and clang 14")
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
