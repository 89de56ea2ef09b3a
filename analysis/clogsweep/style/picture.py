"""A drawn figure."""

import io
import os
import pathlib

from matplotlib.figure import Figure

from .. import style
from ..tools import outputs


class Picture:
    """Shows itself in a notebook; `figure` is matplotlib's, to be changed at will. `source` says where its numbers come
    from, and is kept in what is saved: as Description of the .png, as Subject of the .pdf."""

    def __init__(self, figure: Figure, source: str = "") -> None:
        self.figure = figure
        self.source = source

    def png(self, dpi: float = 110) -> bytes:
        out = io.BytesIO()
        self.figure.savefig(out, format="png", dpi=dpi)
        return out.getvalue()

    def save(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Writes OUTPUT.png and OUTPUT.pdf. @return the first. @throws UserError  if something else is there"""
        path = pathlib.Path(output)
        if path.suffix in (".png", ".pdf"):
            path = path.with_suffix("")
        outputs.refuse_unwritable_picture(path)
        style.save(self.figure, path, {"Description": self.source, "Software": "clogsweep"} if self.source else None)
        return pathlib.Path(f"{path}.png")

    def __repr__(self) -> str:
        return f"<picture of {' x '.join(f'{side:g}' for side in self.figure.get_size_inches())} inches>"

    def _repr_png_(self) -> bytes:
        return self.png()
