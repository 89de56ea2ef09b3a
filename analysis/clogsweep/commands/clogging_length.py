"""Draws the clogging length against line tension (DP) or wall stiffness (SP), one curve per obstacle array.

    python3 -m clogsweep clogging-length sweep.h5        # sweep-clogging-length.png, sweep-clogging-length.pdf
    clogfit sweep.h5 --format json | python3 -m clogsweep clogging-length /dev/stdin --output clogging-length     # the same

Every number comes from clogfit, which is asked for a sweep's; nothing is fitted here. Bars are its confidence
intervals; markers show by what most droplets clogged; a hollow marker is a length that clogfit doubts, the picture says
why; a triangle pointing up is a lower bound where no run clogged.
"""

from .. import style
from ..drawing import lengths
from ..results import fit
from .command_line import sweep_to_draw


def body() -> int:
    arguments = sweep_to_draw(__doc__, "clogging-length", "file of clogsweep --output, or output of clogfit --format json")
    fitted = fit.read(arguments.sweep, arguments.programs)
    picture = style.Picture(style.figure_of(lengths.draw_on, fitted.known.with_lengths(arguments.sweep)), fitted.source)
    print(f"{picture.save(arguments.output)} (and .pdf)")
    return 0
