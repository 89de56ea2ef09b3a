"""How Sphinx makes the site of these pages: docs/build.sh."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "clogsweep"
author = copyright = "the clogsweep authors"
release = version = re.search(r"project\(clogsweep\s+VERSION\s+([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_static", "README.md", "paper"]
if tags.has("site"):  # noqa: F821, Sphinx's
    # What man pages need not.
    extensions += ["nbsphinx", "sphinx.ext.autodoc"]
    nbsphinx_execute = "never"
    autodoc_typehints = "description"
    autodoc_member_order = "bysource"
    sys.path.insert(0, str(ROOT / "analysis"))
else:
    exclude_patterns += ["gallery/notebook.ipynb", "reference/python.md"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4
nitpicky = True
# Of other libraries, whose pages are not beside these.
nitpick_ignore_regex = [("py:class", r"(os|pathlib|collections|numpy|pandas)\..*|Figure")]

html_theme = "furo"
html_title = f"clogsweep {release}"
html_static_path = ["_static"]
html_show_copyright = False
# The site opens offline: build.sh puts Debian's MathJax, which is of version 2, beside its pages.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
# MyST would tell only MathJax 3 that it may look into what has the class math, and version 2 would show the source.
myst_update_mathjax = False
mathjax2_config = {"tex2jax": {"processClass": "tex2jax_process|mathjax_process|math"}}
copybutton_prompt_text = r"\$ "
copybutton_prompt_is_regexp = True
man_pages = [(f"reference/{name}", name, what, "the clogsweep authors", 1) for name, what in
             {"clogsweep": "sweeps of droplets among obstacles, on MPI ranks", "clogrun": "one droplet, watched closely",
              "clogfit": "clogging lengths and speeds of a sweep"}.items()]


def in_fields(app, what, name, thing, options, lines):
    """Our @param, @return and @throws as Sphinx writes them; several may stand in one line."""
    text = re.sub(r"[;.]? *@param +([\w, ]+?)  ", lambda found: "\n\n:param " + found[1] + ": ", "\n".join(lines))
    text = re.sub(r"[;.]? *@return +", "\n\n:return: ", text)
    text = re.sub(r"[;.]? *@throws +(.+)", "\n\n**Throws** \\1", text)
    lines[:] = text.split("\n")


def setup(app):
    if "sphinx.ext.autodoc" in extensions:
        app.connect("autodoc-process-docstring", in_fields)
