"""Pages of the handbook, and the blocks of code in them."""

import os
import re
import shutil
import subprocess
import sys

from support import BIN, LONGEST, ROOT

BLOCK = re.compile(r"^```(bash|python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TOCTREE = re.compile(r"^```{toctree}\n(?::.*\n)*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Settings from the page before the tutorials; `set` ends a block at the first command that fails.
BEFORE = f"set -euo pipefail; . {ROOT}/jobs/mpi-settings.sh\n"
PAGES = ["README.md", *(f"docs/how-to/{name}.md" for name in ("other-arrays", "own-obstacles", "lattice", "compare-sweeps", "python"))]


def tutorial():
    """Its pages, in their order."""
    return [f"docs/tutorial/{page}.md" for page in TOCTREE.search((ROOT / "docs/tutorial/index.md").read_text())[1].split()]


def blocks(path):
    """@return pairs of a language and a text"""
    return BLOCK.findall((ROOT / path).read_text())


def run(language, block, folder):
    # Another python3 that comes first in the path may lack what Debian's has. mpirun stays the one it was.
    folders = [str(BIN), os.path.dirname(shutil.which("mpirun")), os.path.dirname(sys.executable), os.environ["PATH"]]
    environment = {**os.environ, "PATH": ":".join(folders), "PYTHONPATH": str(ROOT / "analysis")}
    command = ["bash", "-c", BEFORE + block] if language == "bash" else [sys.executable, "-c", block]
    return subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=LONGEST)
