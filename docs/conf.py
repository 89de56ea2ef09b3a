"""How Sphinx makes the site of these pages: docs/build.sh."""

import pathlib
import posixpath
import re
import sys

from docutils import nodes
from sphinx import addnodes
from sphinx.errors import ExtensionError
from sphinx.transforms.post_transforms import SphinxPostTransform

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "clogsweep"
author = copyright = "the clogsweep authors"
release = version = re.search(r"project\(clogsweep\s+VERSION\s+([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx_copybutton"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_static", "README.md", "examples", "paper", "gallery/tables", "gallery/rows"]
if tags.has("site"):  # noqa: F821, Sphinx's
    # What man pages need not.
    sys.path.insert(0, str(ROOT / "docs"))
    extensions += ["nbsphinx", "sphinx.ext.autodoc", "mended_theme"]
    nbsphinx_execute = "never"
    nbsphinx_requirejs_path = ""  # widgets need it, which the notebook has not; it would come from another host
    autodoc_typehints = "description"
    autodoc_member_order = "bysource"
    sys.path.insert(0, str(ROOT / "analysis"))
else:
    exclude_patterns += ["gallery/notebook.ipynb", "reference/python.md"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4
nitpicky = True
# Names of other libraries, whose pages are not beside these.
nitpick_ignore_regex = [("py:class", r"(os|pathlib|collections|numpy|pandas|matplotlib)\..*|Figure")]

html_theme = "furo"
html_title = f"clogsweep {release}"
html_static_path = ["_static"]
html_favicon = "_static/icon.svg"
html_css_files = ["site.css"]
html_js_files = ["tables.js"]
html_show_copyright = False
# The site opens offline: mended_theme puts Debian's MathJax, which is of version 2, beside its pages.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
# MyST would tell only MathJax 3 that it may look into what has the class math, and version 2 would show the source.
myst_update_mathjax = False
mathjax2_config = {"tex2jax": {"processClass": "tex2jax_process|mathjax_process|math"}}
copybutton_prompt_text = r"\$ "
copybutton_prompt_is_regexp = True
man_pages = [(f"reference/{page}", name, what, "the clogsweep authors", section) for page, name, what, section in [
    ("clogsweep", "clogsweep", "sweeps of droplets among obstacles, on MPI ranks", 1),
    ("clogrun", "clogrun", "one droplet, watched closely", 1),
    ("clogfit", "clogfit", "clogging lengths and speeds of a sweep", 1),
    ("keys", "clogsweep-keys", "parameters of a run, on the command line and in config files", 5),
    ("files", "clogsweep-files", "files of clogsweep, and columns of the table of runs", 5),
    ("exit-codes", "clogsweep-exit-codes", "how clogsweep, clogrun and clogfit end", 7),
    ("analysis", "clogsweep-python", "figures, films and reports, python3 -m clogsweep", 7)]]

# Pages that became parts of other pages. The site redirects from their old addresses.
MOVED = {
    "explanation/limits": "explanation/trust.html",
    "explanation/open-points": "explanation/model.html#what-the-article-leaves-open",
    "explanation/predicted": "reference/analysis.html#where-predictions-hold",
    "explanation/soundness": "explanation/trust.html#sound-droplets",
    "how-to/lateral-displacement": "how-to/lattice.html#find-the-critical-angle",
    "how-to/other-arrays": "how-to/own-obstacles.html",
    "how-to/own-distances": "how-to/compare-sweeps.html#your-own-distances",
    "reference/columns": "reference/files.html#columns-of-the-table-of-runs",
}


class ForTerminals(SphinxPostTransform):
    """Man pages are narrow and plain: a table becomes a list, mathematics words, and a link says where it leads."""

    builders = ("man",)
    default_priority = 5  # before MyST drops where links lead

    def run(self):
        for link in list(self.document.findall(addnodes.pending_xref)):
            self.name_the_page(link)
        for formula in list(self.document.findall(nodes.math)):
            words = formula.astext().replace("\\", "").translate(str.maketrans("{}", "()"))
            formula.replace_self(nodes.Text(words))
        for table in list(self.document.findall(nodes.table)):
            table.replace_self(self.listed(table))
        page = self.document.next_node(nodes.section)
        title, *rest = page.children
        first = [node for node in rest if not isinstance(node, nodes.section)]
        if first:
            description = nodes.section("", nodes.title("", "Description"), *first, ids=["description"])
            page.children = []
            page += [title, description, *rest[len(first):]]

    @staticmethod
    def name_the_page(link):
        path = link["reftarget"].partition("#")[0]
        if not path:
            return
        page = posixpath.normpath(f"{posixpath.dirname(link['refdoc'])}/{path}").removesuffix(".md")
        place = next((f"{name}({section})" for one, name, _, _, section in man_pages if one == page), f"docs/{page}.md")
        is_name = place.startswith(f"{link.astext()}(")
        link.replace_self([nodes.Text(place)] if is_name else [*link.children, nodes.Text(f" [{place}]")])

    @staticmethod
    def listed(table):
        heads, *rows = [[list(entry.findall(nodes.paragraph)) for entry in row] for row in table.findall(nodes.row)]
        made = nodes.definition_list()
        for first, *others in rows:
            told = nodes.paragraph()
            for head, cell in zip(heads[1:], others):
                if cell and cell[0].children:
                    told += [nodes.Text("; ")] if told.children else []
                    told += [nodes.emphasis("", head[0].astext()), nodes.Text(": ")] if len(others) > 1 else []
                    told += cell[0].children
            made += nodes.definition_list_item("", nodes.term("", "", *first[0].children), nodes.definition("", told))
        return made


def in_fields(app, what, name, thing, options, lines):
    """Our @param, @return and @throws as Sphinx writes them; several may stand in one line."""
    text = "\n".join(lines)
    text = re.sub(r"^.*@(?:param|return).*(?:\n[^\s@].*)*", lambda field: field[0].replace("\n", " "), text, flags=re.MULTILINE)
    text = re.sub(r"[;.]? *@param +([\w, ]+?)  ", lambda found: "\n\n:param " + found[1] + ": ", text)
    text = re.sub(r"[;.]? *@return +", "\n\n:return: ", text)
    text = re.sub(r"[;.]? *@throws +(.+)", "\n\n**Throws** \\1", text)
    lines[:] = text.split("\n")


def with_links_to_pictures(app, doctree):
    """A picture of a page links to its own file, since phones shrink it. Sphinx does this for pictures that have a width."""
    for picture in doctree.findall(nodes.image):
        picture.setdefault("width", "auto")


def with_plain_search(app, page, template, context, doctree):
    """The page of search results gets a script of its own, behind Sphinx's."""
    if page == "search":
        app.add_js_file("search.js", priority=900)


def with_moved_pages(app, exception):
    """Writes a page with a redirect at the old address of every moved page."""
    if exception or app.builder.format != "html":
        return
    for old, new in MOVED.items():
        name, _, anchor = new.partition("#")
        page = pathlib.Path(app.outdir, name)
        if not page.exists():
            raise ExtensionError(f"MOVED of docs/conf.py: there is no page {name}")
        if anchor and f'id="{anchor}"' not in page.read_text():
            raise ExtensionError(f"MOVED of docs/conf.py: {name} has no anchor {anchor}")
        target = posixpath.relpath(new, posixpath.dirname(old))
        pathlib.Path(app.outdir, f"{old}.html").write_text(
            f'<!DOCTYPE html>\n<meta charset="utf-8">\n<title>Moved</title>\n'
            f'<meta http-equiv="refresh" content="0; url={target}">\n<a href="{target}">This page has moved</a>\n')


def setup(app):
    app.add_post_transform(ForTerminals)
    if "sphinx.ext.autodoc" in extensions:
        app.connect("autodoc-process-docstring", in_fields)
        app.connect("html-page-context", with_plain_search)
        app.connect("doctree-read", with_links_to_pictures)
        app.connect("build-finished", with_moved_pages)
