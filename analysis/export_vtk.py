#!/usr/bin/python3
"""python3 -m clogsweep export-vtk, from the source tree."""

from clogsweep.__main__ import script

script("export-vtk")
