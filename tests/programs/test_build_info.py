"""Tests how programs and their files describe the sources from which they were built."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import h5py

from support import QUICK, ROOT, ProgramTest

# cmake/write_build_info.cmake reads these files
LOOKED_AT = [".gitattributes", "cmake/archive_version.txt", "cmake/build_info.cpp.in", "cmake/write_build_info.cmake"]
HASH = "[0-9a-f]{12}"


class Sources(unittest.TestCase):
    """A repository for the test. The user's own git settings do not affect it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="clog_build_info_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.sources = self.folder / "sources"
        self.copy_to(self.sources)

    def copy_to(self, folder):
        for name in LOOKED_AT:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        # If the tests themselves come from an archive, git has filled in this file already.
        form = folder / "cmake/archive_version.txt"
        for word, what in {"describe": "%(describe:tags=true,abbrev=12)", "hash": "%H"}.items():
            form.write_text(re.sub(f"(?m)^{word}: .*$", f"{word}: $Format:{what}$", form.read_text()))

    def git(self, *words, folder=None):
        environment = {"PATH": os.environ["PATH"], "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
        for who in ("AUTHOR", "COMMITTER"):
            environment |= {f"GIT_{who}_NAME": "nobody", f"GIT_{who}_EMAIL": "nobody@localhost"}
        return subprocess.run(["git", *words], cwd=folder or self.sources, env=environment, capture_output=True,
                              check=True).stdout

    def commit(self, *tags):
        if not (self.sources / ".git").exists():
            self.git("init", "--quiet")
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", "a commit")
        for tag in tags:
            self.git("tag", tag)
        return self.git("rev-parse", "--short=12", "HEAD").decode().strip()

    def archive(self, folder):
        folder.mkdir(parents=True)
        subprocess.run(["tar", "-x", "-C", folder], input=self.git("archive", "HEAD"), check=True)
        return folder

    def said(self, folder=None):
        """The description of the sources in a build of the folder: the output of git describe, and the hash."""
        folder, output = folder or self.sources, self.folder / "build_info.cpp"
        subprocess.run(["cmake", f"-DSOURCE_DIR={folder}", f"-DOUTPUT={output}",
                        f"-DTEMPLATE={folder}/cmake/build_info.cpp.in",
                        "-DVERSION=1.2.3", "-P", folder / "cmake/write_build_info.cmake"], check=True)
        return tuple(re.search(rf'\.{name} = "(.*)"', output.read_text()).group(1)
                     for name in ("git_describe", "git_hash"))

    def test_a_release_is_called_by_its_tag(self):
        commit = self.commit("v1.2.3")
        self.assertEqual(self.said(), ("v1.2.3", commit))

    def test_a_commit_behind_it_says_how_far_and_which(self):
        self.commit("v1.2.3")
        commit = self.commit()
        self.assertEqual(self.said(), (f"v1.2.3-1-g{commit}", commit))

    def test_uncommitted_changes_are_recorded(self):
        commit = self.commit("v1.2.3")
        with open(self.sources / "cmake/archive_version.txt", "a") as file:
            file.write("\n")
        self.assertEqual(self.said(), ("v1.2.3-dirty", f"{commit}-dirty"))

    def test_without_a_tag_the_hash_is_all(self):
        commit = self.commit()
        self.assertEqual(self.said(), (commit, commit))

    def test_an_archive_knows_what_it_is(self):
        commit = self.commit()
        self.assertEqual(self.said(self.archive(self.folder / "untagged")), (commit, commit))
        self.git("tag", "v1.2.3")
        self.assertEqual(self.said(self.archive(self.folder / "release")), ("v1.2.3", commit))
        commit = self.commit()
        self.assertEqual(self.said(self.archive(self.folder / "later")), (f"v1.2.3-1-g{commit}", commit))

    def test_an_archive_inside_another_repository_is_not_taken_for_that(self):
        self.commit("v1.2.3")
        around = self.folder / "around"
        around.mkdir()
        self.git("init", "--quiet", folder=around)
        self.git("commit", "--quiet", "--allow-empty", "--message", "another", folder=around)
        self.git("tag", "v9", folder=around)
        self.assertEqual(self.said(self.archive(around / "clogsweep"))[0], "v1.2.3")

    def test_a_bare_copy_says_that_it_does_not_know(self):
        copy = self.folder / "copy"
        self.copy_to(copy)
        self.assertEqual(self.said(copy), ("unknown", "unknown"))


class Programs(ProgramTest):
    def test_programs_and_files_say_the_same_of_the_build(self):
        words = self.succeed("clogsweep", "--version").stdout.splitlines()[0]
        version, described = re.fullmatch(r"clogsweep (\d+\.\d+\.\d+) \(git (\S+)\)", words).groups()
        self.succeed("clogsweep", *QUICK, "seeds=1", "--output", "s.h5")
        self.succeed("clogrun", "array", *QUICK, "seeds=1", "--output", "run.h5")
        for name in ("s.h5", "run.h5"):
            with h5py.File(self.folder / name) as file:
                self.assertEqual(file.attrs["version"].decode(), version)
                self.assertEqual(file.attrs["git_describe"].decode(), described)
                # The attribute is a hash, followed by -dirty if the sources had uncommitted changes, or `unknown`.
                commit = file.attrs["git_hash"].decode()
                self.assertRegex(commit, f"^({HASH}(-dirty)?|unknown)$")
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(file.attrs["sessions"].decode().split()[1:3], [version, described])
        fit = json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout)
        self.assertEqual((fit["version"], fit["git_describe"]), (version, described))


if __name__ == "__main__":
    unittest.main()
