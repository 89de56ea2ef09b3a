"""Examines the outlines of a replayed droplet. Finds ends that move against the drive, and frames in which the droplet
wraps an obstacle and fills a gap at the same time."""

import itertools

import numpy as np
from matplotlib.path import Path

from ..reading.trajectory import Trajectory, with_middles
from ..tools.hints import Numbers, Point

TOUCHES = 0.03  # Vertices within this distance of an obstacle's surface touch it [sigma].
HALF_WAY_ROUND = 180.0  # An obstacle that the outline touches over more than this angle is wrapped [degrees].
NARROW = 1.0  # A droplet squeezes through a gap that is narrower than itself [sigma].
MOVES = 0.01  # A droplet that is faster than this moves [v_t].


def rise_of_an_end(run: Trajectory, post: Point) -> float:
    """A droplet hangs over a post with two lobes. Returns how far the lower end of one lobe rises until the droplet has
    left the post [sigma]."""
    x, y = post
    ends: dict[bool, list[float]] = {True: [], False: []}  # by the side of the post
    for outline in run.polygons:
        sides = {side: outline[0][(outline[1] > y) == side] for side in ends}
        hangs = min(map(len, sides.values())) > 0 and outline[0].min() < x < outline[0].max()
        if not hangs and ends[True]:
            break  # The droplet has left the post.
        if hangs:
            for side, places in sides.items():
                ends[side].append(float(places.max()))
    return max(float(np.max(np.maximum.accumulate(end) - end)) for end in map(np.array, ends.values()))


def touched_angles(outline: Numbers, obstacles: Numbers) -> Numbers:
    """The angle over which the outline touches each obstacle, in steps of 10 degrees.
    @param outline  2 x N [sigma]; @param obstacles  x, y and diameter in each row [sigma]"""
    apart = outline[:, None, :] - obstacles[:, :2].T[:, :, None]
    touches = np.hypot(*apart) - obstacles[:, 2:] / 2 < TOUCHES
    sectors = (np.degrees(np.arctan2(apart[1], apart[0])) // 10).astype(int)
    return np.array([10.0 * len(set(of_one[touching])) for of_one, touching in zip(sectors, touches)])


def is_hybrid(outline: Numbers, obstacles: Numbers) -> bool:
    """Whether the droplet wraps an obstacle and, farther downstream, fills a gap between two others."""
    apart = np.hypot(*(obstacles[:, :2] - outline.mean(axis=1)).T)
    near = obstacles[apart < np.ptp(outline, axis=1).max() + 1]
    angles = touched_angles(outline, near)
    wrapped, touching = near[angles > HALF_WAY_ROUND], near[(angles > 0) & (angles <= HALF_WAY_ROUND)]
    inside = Path(outline.T)
    for one, other in itertools.combinations(touching, 2):
        gap = np.hypot(*(one - other)[:2]) - (one[2] + other[2]) / 2
        is_downstream = min(one[0], other[0]) > wrapped[:, 0].min(initial=np.inf)
        if gap < NARROW and is_downstream and inside.contains_point((one + other)[:2] / 2):
            return True
    return False


def hybrid_frames(run: Trajectory) -> tuple[int, int]:
    """Numbers of frames in which the droplet moves, and of those in which it is_hybrid()."""
    centres = run.polygons.mean(axis=2)
    speeds = np.hypot(*np.diff(centres, axis=0).T) / np.diff(run.times)
    moving = np.flatnonzero(speeds > MOVES * run.row["terminal_speed"])
    return len(moving), sum(is_hybrid(with_middles(run.polygons[frame]), run.obstacles) for frame in moving)
