"""Runs the cells of the gallery's notebook, with fewer and shorter runs, to test that the module has everything that
the cells call.

slow_notebook tests whether the cells print the stored outputs.
"""

import ast
import unittest

import nbformat

from drawing import Analysis
from support import BIN, ROOT

NOTEBOOK = ROOT / "docs" / "gallery" / "notebook.ipynb"
# Commands that take long, with their shorter replacements
SHORTER = {"mpirun -np 2 clogsweep": str(BIN / "clogsweep"), "line-tension=0.2,0.3,0.5,1,2": "line-tension=0.3,1,3", "box=40": "box=20",
           "max-time=2000": "max-time=100", "seeds=1..12": "seeds=1..2", "most=4": "most=1", "interval=2": "interval=10", "most_frames=100": "most_frames=2"}


def run_cells(cells):
    """Runs cells, and shows the value of the last line of each cell as a notebook does."""
    names = {}
    for cell in cells:
        *body, last = ast.parse(cell).body
        if not isinstance(last, ast.Expr) or cell.rstrip().endswith(";"):
            body.append(last)
            last = None
        exec(compile(ast.Module(body, []), "notebook", "exec"), names)
        shown = eval(compile(ast.Expression(last.value), "notebook", "eval"), names) if last else None
        for form in ("_repr_html_", "_repr_png_", "__repr__"):
            if shown is not None and (draw := getattr(shown, form, None)) and draw():
                print(form)
                break


class Notebook(Analysis):
    def test_its_cells_succeed(self):
        cells = [cell.source for cell in nbformat.read(NOTEBOOK, as_version=4).cells if cell.cell_type == "code"]
        text = "\n%%\n".join(cells)
        for long, short in SHORTER.items():
            self.assertIn(long, text)
            text = text.replace(long, short)
        done = self.fork("notebook", lambda: run_cells(text.split("\n%%\n")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(done.stdout.count("_repr_png_"), 1)
        self.assertGreater(done.stdout.count("_repr_html_"), 3)


if __name__ == "__main__":
    unittest.main()
