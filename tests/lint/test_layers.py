"""Tests on small source trees that layers.py refuses forbidden includes.

    tests/lint/test_layers.py
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

LINT = pathlib.Path(__file__).with_name("layers.py")
CPP = [("base", ""), ("top", "`base`")]
PYTHON = [("tools", ""), ("reading", "`tools`"), ("commands", "all")]
SOUND = {
    "src/base/base.cpp": "#include <vector>\n",
    "src/top/top.cpp": '#include "clog/base/base.hpp"\n',
    "analysis/clogsweep/__init__.py": "from .reading import stored\n",
    "analysis/clogsweep/tools/errors.py": "import math\n",
    "analysis/clogsweep/reading/stored.py": "import h5py\n\nfrom ..tools.errors import UserError\n",
    "analysis/clogsweep/commands/show.py": "def body():\n    from ..reading import stored\n    from ..tools import errors\n",
}


def page(cpp, python):
    def rows(layers):
        return "\n".join(f"| `{layer}` | what? | {uses} |" for layer, uses in layers)

    return f"# Modules\n\n{rows(cpp)}\n\n## Modules of the Python package\n\n{rows(python)}\n\n## Others\n"


class Layers(unittest.TestCase):
    def found(self, files=(), cpp=CPP, python=PYTHON):
        """The output of layers.py for the correct tree, in which some files and some lines of the tables are
        replaced."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**SOUND, "docs/developer/architecture.md": page(cpp, python), **dict(files)}.items():
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            done = subprocess.run([sys.executable, LINT, folder], capture_output=True, text=True)
        self.assertEqual((done.stderr, done.returncode), ("", int(done.stdout != "layers are clean\n")))
        return done.stdout

    def test_a_sound_tree_is_clean(self):
        self.assertEqual(self.found(), "layers are clean\n")

    def test_an_import_against_the_arrows_is_refused(self):
        upward = "from ..reading import stored\n"
        for text in (upward, "from ..reading.stored import opened\n", f"def late():\n    {upward}", f"if TYPE_CHECKING:\n    {upward}"):
            with self.subTest(text=text):
                self.assertIn(f"tools/names.py:{len(text.splitlines())}: tools must not use reading/stored.py\n",
                              self.found({"analysis/clogsweep/tools/names.py": text}))
        self.assertIn("src/base/more.cpp:1: base must not use clog/top/top.hpp", self.found({"src/base/more.cpp": "#include <clog/top/top.hpp>\n"}))

    def test_folders_of_a_layer_inside_core_are_layers(self):
        layers = [*CPP, ("core", ""), ("core/ball/low", ""), ("core/ball", "`core/ball/low`")]
        files = {"src/core/ball/ball.cpp": '#include "core/ball/low/low.hpp"\n', "src/core/ball/low/low.hpp": ""}
        self.assertEqual(self.found(files, cpp=layers), "layers are clean\n")
        upward = {**files, "src/core/ball/low/low.hpp": '#include "clog/core/ball/ball.hpp"\n'}
        self.assertIn("low.hpp:1: core/ball/low must not use clog/core/ball/ball.hpp", self.found(upward, cpp=layers))

    def test_the_names_of_the_whole_package_are_not_for_its_layers(self):
        self.assertIn("reading/more.py:1: reading must not use __init__.py", self.found({"analysis/clogsweep/reading/more.py": "from .. import open\n"}))
        self.assertIn("reading/more.py:1: imports clogsweep.tools as a stranger does",
                      self.found({"analysis/clogsweep/reading/more.py": "from clogsweep.tools import errors\n"}))

    def test_undeclared_layers_are_refused(self):
        self.assertIn("attic/old.py: the layer attic is not in", self.found({"analysis/clogsweep/attic/old.py": ""}))
        self.assertIn("analysis/clogsweep/loose.py: lies in no layer", self.found({"analysis/clogsweep/loose.py": ""}))
        self.assertIn("src/attic/old.cpp: the layer attic is not in", self.found({"src/attic/old.cpp": "#include <vector>\n"}))

    def test_tables_say_what_there_is(self):
        self.assertIn("there is no layer cellar", self.found(python=[*PYTHON, ("cellar", "")]))
        self.assertIn("there is no layer cellar", self.found(cpp=[*CPP, ("cellar", "")]))
        self.assertIn("commands does not use attic", self.found({"analysis/clogsweep/attic/old.py": ""}, python=[*PYTHON, ("attic", "")]))

    def test_circles_are_refused(self):
        circle = {"analysis/clogsweep/reading/one.py": "from . import two\n", "analysis/clogsweep/reading/two.py": "def late():\n    from .one import name\n"}
        self.assertRegex(self.found(circle), r"imports form a circle: reading/(one|two)\.py -> reading/(one|two)\.py -> reading/(one|two)\.py\n")
        back = {"analysis/clogsweep/tools/names.py": "from ..reading import more\n", "analysis/clogsweep/reading/more.py": ""}
        layers = r"layers form a circle: (tools -> reading -> tools|reading -> tools -> reading)\n"
        self.assertRegex(self.found(back, python=[("tools", "`reading`"), *PYTHON[1:]]), layers)
        self.assertRegex(self.found(cpp=[("base", "`top`"), CPP[1]]), "layers form a circle: (base -> top -> base|top -> base -> top)\n")

    def test_libraries_stay_in_their_layers(self):
        for text in ("import h5py\n", "from h5py import File\n"):
            self.assertIn("tools/names.py:1: tools must not import h5py", self.found({"analysis/clogsweep/tools/names.py": text}))
        self.assertIn("must not import matplotlib", self.found({"analysis/clogsweep/reading/more.py": "import matplotlib.axes\n"}))
        self.assertIn("only store includes <hdf5.h>", self.found({"src/base/more.cpp": "#include <hdf5.h>\n"}))


if __name__ == "__main__":
    unittest.main()
