"""Reads pages of the handbook, and the blocks of code in them."""

import os
import re
import shlex
import shutil
import subprocess
import sys

from support import BIN, LONGEST, ROOT

BLOCK = re.compile(r"^```(bash|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TOCTREE = re.compile(r"^```{toctree}\n(?::.*\n)*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Settings from the page before the tutorials. With `set` a block ends at the first command that fails.
BEFORE = f"set -euo pipefail; . {ROOT}/jobs/mpi-settings.sh\n"
HOW_TO = ("own-obstacles", "lattice", "compare-sweeps", "python",
          "contact-angles", "sizes-and-tilts")
PAGES = ["README.md", *(f"docs/how-to/{name}.md" for name in HOW_TO)]


def tutorial():
    """The pages of the tutorial in their order."""
    return [f"docs/tutorial/{page}.md"
            for page in TOCTREE.search((ROOT / "docs/tutorial/index.md").read_text())[1].split()]


def blocks(path):
    """The blocks of code of a page. @return pairs of a language and a text"""
    return BLOCK.findall((ROOT / path).read_text())


def code(text):
    """The code of a page. @return its lines that are indented or in a block of bash; all other lines become empty"""
    fence = None
    for line in text.splitlines():
        if line.startswith("```"):
            fence = line[3:] if fence is None else None
            yield ""
        elif fence is None:
            yield line[4:] if line.startswith("    ") else ""
        else:
            yield line if fence == "bash" else ""


def commands(path):
    """The commands in the code of a page. @return the words of every command, without the words after ">". Synopses are
    left out."""
    found = []
    for line in "\n".join(code((ROOT / path).read_text())).replace("\\\n", " ").splitlines():
        words = shlex.shlex(line, posix=True, punctuation_chars="|&;>")
        words.whitespace_split = True
        command = []
        is_synopsis = "]..." in line or "..." in line.split()
        for word in [*words, ";"] if line.count("'") % 2 == 0 and not is_synopsis else []:
            if set(word) <= set("|&;"):
                found.append(command[:command.index(">")] if ">" in command else command)
                command = []
            else:
                command.append(word)
    return [command for command in found if command]


def run(language, block, folder):
    # The python3 of this test comes before others in the path, because others may lack packages. mpirun stays the same.
    folders = [str(BIN), os.path.dirname(shutil.which("mpirun")), os.path.dirname(sys.executable), os.environ["PATH"]]
    environment = {**os.environ, "PATH": ":".join(folders), "PYTHONPATH": str(ROOT / "analysis")}
    command = ["bash", "-c", BEFORE + block] if language == "bash" else [sys.executable, "-c", block]
    return subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=LONGEST)
