"""Judges statements on what single droplets do, from the outlines of their replays."""

import itertools

import numpy as np
from matplotlib.path import Path

from ..paper import hanging
from ..paper.workshop import Workshop
from ..reading.trajectory import Trajectory, with_middles
from ..tools.hints import Numbers
from .verdicts import AGREES, DOES_NOT, IN_KIND, Finding

TOUCHES = 0.03  # Vertices within this distance of an obstacle's surface touch it [sigma].
HALF_WAY_ROUND = 180.0  # An obstacle that the outline touches over more than this angle is wrapped [degrees].
NARROW = 1.0  # A droplet squeezes through a gap that is narrower than itself [sigma].
MOVES = 0.01  # A droplet that is faster than this moves [v_t].


def unwraps_against_the_drive(shop: Workshop) -> Finding:
    """Follows the lower ends of the two lobes of a droplet that hangs over a post and slides off (figure W3)."""
    run = hanging.over_a_post(shop, "off")
    x, y, _ = hanging.POST
    ends: dict[bool, list[float]] = {True: [], False: []}  # by the side of the post
    for outline in run.polygons:
        sides = {side: outline[0][(outline[1] > y) == side] for side in ends}
        hangs = min(map(len, sides.values())) > 0 and outline[0].min() < x < outline[0].max()
        if not hangs and ends[True]:
            break  # The droplet has left the post.
        if hangs:
            for side, places in sides.items():
                ends[side].append(float(places.max()))
    rise = max(float(np.max(np.maximum.accumulate(end) - end)) for end in map(np.array, ends.values()))
    return Finding(AGREES if rise >= 0.5 else IN_KIND if rise > 0.05 else DOES_NOT, f"one end rises by {rise:.2f} σ")


def touched_angles(outline: Numbers, obstacles: Numbers) -> Numbers:
    """The angle over which the outline touches each obstacle, in steps of 10 degrees.
    @param outline  2 x N [sigma]; @param obstacles  x, y and diameter in each row [sigma]"""
    apart = outline[:, None, :] - obstacles[:, :2].T[:, :, None]
    touches = np.hypot(*apart) - obstacles[:, 2:] / 2 < TOUCHES
    sectors = (np.degrees(np.arctan2(apart[1], apart[0])) // 10).astype(int)
    return np.array([10.0 * len(set(of_one[touching])) for of_one, touching in zip(sectors, touches)])


def is_hybrid(outline: Numbers, obstacles: Numbers) -> bool:
    """Whether the droplet wraps an obstacle and, farther downstream, fills a gap between two others."""
    near = obstacles[np.hypot(*(obstacles[:, :2] - outline.mean(axis=1)).T) < np.ptp(outline, axis=1).max() + 1]
    angles = touched_angles(outline, near)
    wrapped, touching = near[angles > HALF_WAY_ROUND], near[(angles > 0) & (angles <= HALF_WAY_ROUND)]
    inside = Path(outline.T)
    for one, other in itertools.combinations(touching, 2):
        gap = np.hypot(*(one - other)[:2]) - (one[2] + other[2]) / 2
        is_downstream = min(one[0], other[0]) > wrapped[:, 0].min(initial=np.inf)
        if gap < NARROW and is_downstream and inside.contains_point((one + other)[:2] / 2):
            return True
    return False


def hybrid_share(run: Trajectory) -> tuple[int, int]:
    """Numbers of frames in which the droplet moves, and of those that are hybrid."""
    centres = run.polygons.mean(axis=2)
    speeds = np.hypot(*np.diff(centres, axis=0).T) / np.diff(run.times)
    moving = np.flatnonzero(speeds > MOVES * run.row["terminal_speed"])
    return len(moving), sum(is_hybrid(with_middles(run.polygons[frame]), run.obstacles) for frame in moving)


def hybrids_flow(shop: Workshop) -> Finding:
    words, shares = [], []
    for preset in ("robust", "elastic"):
        rows = shop.runs(f"hybrid-flow-{preset}", None, {
            "preset": preset, "line-tension": [0.05, 0.2], "obstacle-gap": 0.3, "obstacle-density": "saturated", "box": 40,
            "boxes": 2, "vertices": 128, "max-time": 1500, "seeds": [1, 2, 3]})
        for tension in (0.05, 0.2):
            chosen = [row for row in rows if np.isclose(row["line_tension"], tension)]
            counts = np.sum([hybrid_share(way) for way in shop.ways(f"hybrid-flow-{preset}", chosen, 5, 5)], axis=0)
            shares.append(counts[1] / max(counts[0], 1))
            words.append(f"{shares[-1]:.1%} of {counts[0]} frames at {tension:g} ({preset})")
    return Finding(AGREES if max(shares) >= 0.01 else IN_KIND if max(shares) > 0 else DOES_NOT, ", ".join(words))
