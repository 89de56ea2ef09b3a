"""How Sphinx makes the site of these pages: docs/build.sh."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "clogsweep"
author = copyright = "the clogsweep authors"
release = version = re.search(r"project\(clogsweep\s+VERSION\s+([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_static", "README.md"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4
nitpicky = True

html_theme = "furo"
html_title = f"clogsweep {release}"
html_static_path = ["_static"]
html_show_copyright = False
# The site opens offline: build.sh puts Debian's MathJax, which is of version 2, beside its pages.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
# MyST lets mathematics be looked for in elements of the class `math` only, but tells so in words of version 3.
myst_update_mathjax = False
mathjax2_config = {"tex2jax": {"processClass": "math"}}
copybutton_prompt_text = r"\$ "
copybutton_prompt_is_regexp = True
