"""Adds files of ../jobs to the package: the configs and points of the figures, and the settings of mpirun. So git needs
only one copy of these files."""

import pathlib
import shutil
import tempfile

from setuptools import setup
from setuptools.command.build_py import build_py

JOBS = pathlib.Path(__file__).resolve().parents[1] / "jobs"


class BuildWithJobs(build_py):
    def run(self) -> None:
        super().run()
        figures = JOBS / "figures"
        for source in (JOBS / "mpi-settings.sh", *sorted(figures.glob("*.cfg")), *sorted(figures.glob("*.csv"))):
            copy = pathlib.Path(self.build_lib) / "clogsweep" / "jobs" / source.relative_to(JOBS)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)


# The build folder is outside the source tree. So nothing is left in the source tree, and the package contains no file
# of an earlier build.
with tempfile.TemporaryDirectory(prefix="clogsweep_build_") as scratch:
    setup(cmdclass={"build_py": BuildWithJobs}, options={"build": {"build_base": scratch}, "egg_info": {"egg_base": scratch}})
