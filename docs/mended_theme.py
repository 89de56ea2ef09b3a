"""Mends furo as Debian 12 packages it, in the site that has been built: a Sphinx extension.

Its script imports a second one, which browsers refuse in a page; its style sheet asks the server for another of
Debian's, and lacks the dark colours of browsers that prefer them. All of it is put into the site's own files, which
work when they are opened from a disk, too. So are those parts of Debian's MathJax that the pages use.
"""

import pathlib
import re
import shutil

NORMALIZE = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
PARTS = ("MathJax.js", "config/TeX-AMS_CHTML.js", "extensions", "jax/element", "jax/input/TeX", "jax/output/CommonHTML",
         "jax/output/PreviewHTML", "fonts/HTML-CSS/TeX/woff")
OF_DARK_PAGES = re.compile(r'@media not print \{\s*body\[data-theme="dark"\] \{.*?\}\s*\n.*?\}\s*\}', re.S)


def bundled_script(scripts: pathlib.Path) -> str:
    """The script and the one that it imports, which defines Gumshoe for the whole page if nothing imports it."""
    script = (scripts / "furo.js").read_text()
    return (scripts / "gumshoe-patched.js").read_text() + re.sub(r"^import Gumshoe .*$", "", script, flags=re.M)


def bundled_style(style: str, of_code: str) -> str:
    """The style sheet with the one that it asks for, and with the colours of dark pages where a reader chose none.

    @param of_code  the style sheet of code, which has these colours where the browser prefers them
    """
    style = re.sub(r"@import url\(/javascript/normalize\.css/.*?\);", lambda _: NORMALIZE.read_text(), style)
    dark = OF_DARK_PAGES.search(style)
    query = re.search(r"@media \(prefers-[a-z-]+: dark\)", of_code)
    if dark and query and query[0] not in style:
        chosen_by_browser = dark[0].replace('body[data-theme="dark"]', 'body:not([data-theme="light"])')
        style += f"\n{query[0]} {{\n{chosen_by_browser} }}\n"
    return style


def copy_mathjax(target: pathlib.Path) -> None:
    """Files, not links: the site may be moved to another machine."""
    for part in PARTS:
        source, copy = MATHJAX / part, target / part
        copy.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, copy, dirs_exist_ok=True)
        elif source.exists():
            shutil.copyfile(source, copy)


def mend(app, exception):
    """Runs when the site has been built."""
    if exception or app.builder.format != "html":
        return
    static = pathlib.Path(app.outdir) / "_static"
    scripts = static / "scripts"
    if (scripts / "gumshoe-patched.js").exists():
        (scripts / "furo.js").write_text(bundled_script(scripts))
        (scripts / "gumshoe-patched.js").unlink()
    sheet = static / "styles/furo.css"
    sheet.write_text(bundled_style(sheet.read_text(), (static / "pygments.css").read_text()))
    copy_mathjax(static / "mathjax")


def setup(app):
    """For Sphinx."""
    app.connect("build-finished", mend, priority=900)  # after furo, which writes its own style sheets then
    return {"parallel_read_safe": True}
