"""Checks that every link and every path in the documentation leads to something. A link in `*.md` must lead to a file
of the sources and, after `#`, to one of the headings or targets of this file. A `quoted` path in `*.md` or in the
configs of `jobs` must name a file or a folder if it begins with a folder of the sources, such as `src/`.

    tests/lint/links.py ROOT
"""

import pathlib
import posixpath
import re
import subprocess
import sys

FOLDERS = ("analysis", "cmake", "docs", "include", "jobs", "src", "tests")
LINK = re.compile(r"\]\(\s*<?([^\s()<>]+)>?(?:\s+\"[^\"]*\")?\s*\)|^ {0,3}\[[^\]]+\]:\s+(\S+)", re.MULTILINE)
BLOCK = re.compile(r"^( *)(`{3,}|~{3,}).*?^\1\2 *$", re.MULTILINE | re.DOTALL)
# Quoted text may continue on the next line, but not in the next paragraph.
QUOTED = re.compile(r"(?<!`)`((?:[^`\n]|\n(?!\s*\n))+)`(?!`)")
PATH = re.compile(rf"(?:{'|'.join(FOLDERS)})/[^\s<*{{$]*")
HEADING = re.compile(r"^#{1,6} +(.+?)(?: +#+)?$", re.MULTILINE)
TARGET = re.compile(r"^\(([\w-]+)\)=$", re.MULTILINE)
# Dated notes and the changelog describe the sources as they were at that time.
OF_THEIR_DAY = ("docs/notes/", "CHANGELOG.md")


def sources(root):
    """The files that git tracks or would add. In an archive of the sources, all files except build outputs."""
    if (root / ".git").exists():
        asked = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
                               capture_output=True, text=True)
        if asked.returncode == 0:
            return {name for name in asked.stdout.split("\0") if name and (root / name).is_file()}
    names = (path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file())
    return {name for name in names if not name.startswith(("build", "results/"))}


def without(pattern, text):
    """The text without all matches of the pattern. The number of lines stays the same."""
    return pattern.sub(lambda found: "\n" * found[0].count("\n"), text)


def anchors(text):
    """The anchors to which links may point, by the rules of GitHub and MyST. A repeated heading has a number."""
    text = without(BLOCK, text)
    found = set(TARGET.findall(text))
    for heading in HEADING.findall(text):
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", "-")
        number = 1
        name = slug
        while name in found:
            name, number = f"{slug}-{number}", number + 1
        found.add(name)
    return found


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def wrong_links(root, name, text, known):
    prose = without(QUOTED, without(BLOCK, text))
    for link in LINK.finditer(prose):
        target = link[1] or link[2]
        if re.match(r"[a-z][a-z+.-]*:", target):
            continue
        path, _, anchor = target.partition("#")
        to = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
        where = f"{name}:{line_of(prose, link.start())}"
        if to not in known:
            yield f"{where}: the link to {target} leads to no file of the sources"
        elif anchor and to.endswith(".md") and anchor not in anchors((root / to).read_text()):
            yield f"{where}: {to} has no heading for #{anchor}"


def wrong_paths(name, text, known):
    prose = without(BLOCK, text)
    for quoted in QUOTED.finditer(prose):
        path = quoted[1].partition("#")[0].rstrip("/")
        if PATH.fullmatch(quoted[1]) and path not in known:
            yield f"{name}:{line_of(prose, quoted.start())}: there is no {quoted[1]}"


def faults(root):
    known = sources(root)
    folders = {folder.as_posix() for name in known for folder in pathlib.PurePosixPath(name).parents}
    for name in sorted(known):
        if name.endswith(".md"):
            text = (root / name).read_text()
            yield from wrong_links(root, name, text, known)
            if not name.startswith(OF_THEIR_DAY):
                yield from wrong_paths(name, text, known | folders)
        elif name.startswith("jobs/") and name.endswith(".cfg"):
            yield from wrong_paths(name, (root / name).read_text(), known | folders)


def main(root):
    found = list(faults(pathlib.Path(root).resolve()))
    print("\n".join(found) or "every link and every path leads somewhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
