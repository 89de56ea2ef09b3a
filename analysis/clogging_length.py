#!/usr/bin/python3
"""python3 -m clogsweep clogging-length, from the source tree."""

from clogsweep.__main__ import script

script("clogging-length")
