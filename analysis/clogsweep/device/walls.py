"""Finds side walls that are drawn as long, thin outlines or as lines. Side walls are no posts: side-walls=on replaces
them."""

from __future__ import annotations

import numpy as np

from ..tools.hints import Numbers

SHARE = 0.9  # An outline at a side is a wall if its length is at least this fraction of the device's length.
SLENDER = 3  # Smallest length of a wall divided by its thickness. With this limit, square posts are no walls.
FLAT = 0.05  # Largest deviation of a wall's outline from a rectangle [sigma].


def among(circles: Numbers, outlines: list[Numbers], lines: list[Numbers],
          length: float) -> tuple[list[Numbers], list[Numbers]]:
    """The lower and the upper walls among outlines and lines. The walls nearest to the posts come first. Lengths are in
    droplet diameters. If no other post would remain, both lists are empty."""
    flat = [candidate for candidate in [*outlines, *lines] if is_wall(candidate, length)]
    posts = np.array([*circles[:, 1],
                      *(outline.mean(axis=0)[1] for outline in outlines if not is_one_of(outline, flat))])
    if len(posts) == 0:
        return [], []
    lower = [wall for wall in flat if (posts >= wall[:, 1].max()).all()]
    upper = [wall for wall in flat if (posts <= wall[:, 1].min()).all()]
    return sorted(lower, key=lambda wall: -wall[:, 1].max()), sorted(upper, key=lambda wall: wall[:, 1].min())


def is_one_of(outline: Numbers, others: list[Numbers]) -> bool:
    return any(outline is other for other in others)


def is_wall(outline: Numbers, length: float) -> bool:
    """Whether an outline is a flat rectangle along the flow. A wall with teeth is not flat."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    along, across = high - low
    if along < SHARE * length or along < SLENDER * across:
        return False
    off = np.minimum(outline - low, high - outline).min(axis=1).max()
    return bool(across <= 2 * FLAT or off <= FLAT and is_rectangle(outline))


def area(outline: Numbers) -> float:
    """The area within a closed outline. The area is positive if the outline is counter-clockwise."""
    x, y = outline.T
    return float(0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def centroid(outline: Numbers) -> Numbers:
    """The centre of the area within a closed outline."""
    near = outline - outline.mean(axis=0)
    following = np.roll(near, -1, axis=0)
    cross = near[:, 0] * following[:, 1] - following[:, 0] * near[:, 1]
    return outline.mean(axis=0) + ((near + following) * cross[:, None]).sum(axis=0) / (3 * cross.sum())


def is_rectangle(outline: Numbers, share: float = 0.98) -> bool:
    """Whether the outline is a rectangle with sides parallel to the axes.
    @param share  smallest fraction of the bounding box that the outline may fill"""
    return abs(area(outline)) >= share * float(np.ptp(outline, axis=0).prod())
