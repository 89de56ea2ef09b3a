"""Compares the statements of the article (Cheng et al.) with the results of this program: see python3 -m clogsweep
agreement."""

from .statements import judge_all
from .table import WRITERS
from .verdicts import Judged

__all__ = ["WRITERS", "Judged", "judge_all"]
