"""Compares the statements of the article with the results of this program: see python3 -m clogsweep agreement."""

from . import passages, lengths, speeds  # noqa: F401  each module registers its statements, in the order of the article
from .statements import Judged, judge_all
from .table import WRITERS

__all__ = ["WRITERS", "Judged", "judge_all"]
