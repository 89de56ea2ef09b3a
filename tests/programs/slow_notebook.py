"""Runs the notebook of the gallery. The cells must succeed and print the stored outputs.

Numbers may differ, because they differ between compilers (docs/notes/2026-11-23-compilers.md).
"""

import os
import re
import subprocess
import tempfile
import unittest
import unittest.mock

import nbclient
import nbformat
import traitlets.config

from support import BIN, LONGEST, ROOT, ProgramTest

NOTEBOOK = ROOT / "docs" / "gallery" / "notebook.ipynb"
NUMBER = re.compile(r"\d+\.\d+(?:e[+-]?\d+)?")  # Counts have no decimal point, so they must be the same.


def said(notebook):
    """The text output of every code cell, without progress bars. The name of a film may end in .mp4 or .gif."""
    return [[(output["data"]["text/plain"] if "data" in output else output["text"]).replace(".gif>", ".mp4>")
             for output in cell.outputs if output.get("name") != "stderr"]
            for cell in notebook.cells if cell.cell_type == "code"]


def words(outputs):
    """A text without its numbers, and with single spaces between its columns."""
    return [[" ".join(NUMBER.sub("#", text).split()) for text in cell] for cell in outputs]


def numbers(outputs):
    return [float(number) for cell in outputs for text in cell for number in NUMBER.findall(text)]


class Notebook(ProgramTest):
    def test_stored_outputs_are_up_to_date(self):
        settings = subprocess.run(["bash", "-c", f". {ROOT}/jobs/mpi-settings.sh && env -0"], check=True,
                                  capture_output=True, text=True)
        environment = dict(line.split("=", 1) for line in settings.stdout.split("\0") if line)
        environment |= {"PATH": f"{BIN}:{environment['PATH']}", "PYTHONPATH": str(ROOT / "analysis"),
                        "HOME": str(self.folder)}
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        expected = said(notebook)
        # Another program may take a free TCP port before the kernel does, but not a Unix socket in the kernel's folder.
        # The folder is in /tmp, because the path of a socket has at most 107 characters.
        with tempfile.TemporaryDirectory(dir="/tmp") as sockets, unittest.mock.patch.dict(os.environ, environment):
            kernel = {"transport": "ipc", "connection_file": f"{sockets}/kernel.json"}
            nbclient.NotebookClient(notebook, timeout=LONGEST, kernel_name="python3",
                                    config=traitlets.config.Config(KernelManager=kernel),
                                    resources={"metadata": {"path": str(self.folder)}}).execute()
        today = said(notebook)
        self.assertEqual(words(today), words(expected))
        for number, known in zip(numbers(today), numbers(expected), strict=True):
            self.assertLess(abs(number - known), 1e-4 * abs(known) + 1e-9)
        self.assertGreater(sum(map(len, expected)), 8)
        self.assertGreater(len(numbers(expected)), 50)


if __name__ == "__main__":
    unittest.main()
