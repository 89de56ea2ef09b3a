#!/usr/bin/python3
"""python3 -m clogsweep dwell, from the source tree."""

from clogsweep.__main__ import script

script("dwell")
