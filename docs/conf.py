"""How Sphinx makes the site of these pages: docs/build.sh."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "clogsweep"
author = copyright = "the clogsweep authors"
release = version = re.search(r"project\(clogsweep\s+VERSION\s+([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_static", "README.md", "paper"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4
nitpicky = True

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
