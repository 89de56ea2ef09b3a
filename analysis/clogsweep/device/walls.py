"""Side walls that a drawing has as long, thin outlines or as lines: no posts, since side-walls=on makes them."""

from __future__ import annotations

import numpy as np

from ..tools.hints import Numbers

SHARE = 0.9  # of the device's length, from which an outline at a side is a wall
SLENDER = 3  # length over thickness, at least: a column of square posts has no walls
FLAT = 0.05  # by which a wall's outline may be off a rectangle [sigma]


def among(circles: Numbers, others: list[Numbers], length: float) -> tuple[int | None, int | None]:
    """Indices of the outlines that are the lower and the upper wall, all in droplet diameters. None if there would be no other post."""
    middles = [outline.mean(axis=0)[1] for outline in others]
    lower = upper = None
    for index, outline in enumerate(others):
        rest = np.array([*circles[:, 1], *(middle for other, middle in enumerate(middles) if other != index)])
        if len(rest) == 0 or not is_wall(outline, length):
            continue
        if (rest >= outline[:, 1].max()).all():
            lower = index
        elif (rest <= outline[:, 1].min()).all():
            upper = index
    found = (lower is not None) + (upper is not None)
    return (lower, upper) if len(circles) + len(others) > found else (None, None)


def is_wall(outline: Numbers, length: float) -> bool:
    """A flat rectangle along the flow. A wall with teeth is none."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    along, across = high - low
    if along < SHARE * length or along < SLENDER * across:
        return False
    off = np.minimum(outline - low, high - outline).min(axis=1).max()
    return bool(across <= 2 * FLAT or off <= FLAT and abs(area(outline)) >= 0.98 * along * across)


def area(outline: Numbers) -> float:
    """Within a closed outline, positive if it is counter-clockwise."""
    x, y = outline.T
    return float(0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
