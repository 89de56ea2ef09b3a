"""Lists the files of the repository, and the files that changed."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# If no branch or variable shows what changed, all files in this number of last commits count as changed. A push rarely
# has more commits.
LAST_COMMITS = 10


def git(*arguments):
    """The output of git, or None if git fails."""
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


def files(*patterns):
    """The files that match these patterns (such as `*.md`), relative to the root: the files in git, and new files that
    git does not ignore."""
    listed = git("ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *patterns)
    if listed is None:
        sys.exit(f"{ROOT} is no git repository: which files to look at is not known")
    return sorted({name for name in listed.split("\0") if name and (ROOT / name).is_file()})


def base():
    """The commit with which files are compared, and the reason for this choice in words. None if there is no such
    commit."""
    named = os.environ.get("GATES_SINCE")
    if named:
        commit = git("rev-parse", "--verify", "--quiet", f"{named}^{{commit}}")
        if commit is None:
            sys.exit(f"GATES_SINCE={named} is no commit here")
        return commit.strip(), f"{named} (GATES_SINCE)"
    head = (git("rev-parse", "HEAD") or "").strip()
    for branch in ["origin/HEAD", "origin/main", "origin/master"]:
        fork = (git("merge-base", branch, "HEAD") or "").strip()
        if fork == head:
            break  # This is the default branch itself.
        if fork:
            return fork, f"the fork from {branch}"
    # A shallow clone may contain fewer commits than LAST_COMMITS, or only one.
    for back in range(LAST_COMMITS, 0, -1):
        commit = git("rev-parse", "--verify", "--quiet", f"HEAD~{back}^{{commit}}")
        if commit:
            return commit.strip(), f"HEAD~{back}"
    return None


def changed():
    """The files that differ from base(), including uncommitted and new files, and the reason for this base in words.
    None if there is no base."""
    since = base()
    if since is None:
        return None
    commit, words = since
    tracked = git("diff", "--name-only", "-z", "--no-renames", commit).split("\0")
    new = git("ls-files", "-z", "--others", "--exclude-standard").split("\0")
    return {name for name in tracked + new if name and (ROOT / name).is_file()}, words
