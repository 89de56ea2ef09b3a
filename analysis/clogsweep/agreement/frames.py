"""Judges statements about single droplets, from the outlines of their replays."""

import numpy as np

from ..paper import hanging, outlines
from ..paper.runner import Runner
from .verdicts import AGREES, DOES_NOT, IN_KIND, Finding


def unwraps_against_the_drive(runner: Runner) -> Finding:
    """Follows the lower ends of the two lobes of a droplet that hangs over a post and slides off (figure W3)."""
    rise = outlines.rise_of_an_end(hanging.over_a_post(runner, "off"), hanging.POST[:2])
    return Finding(AGREES if rise >= 0.5 else IN_KIND if rise > 0.05 else DOES_NOT, f"one end rises by {rise:.2f} σ")


def hybrids_flow(runner: Runner) -> Finding:
    words, shares = [], []
    for preset in ("robust", "elastic"):
        rows = runner.runs(f"hybrid-flow-{preset}", None, {
            "preset": preset, "line-tension": [0.05, 0.2], "obstacle-gap": 0.3, "obstacle-density": "saturated",
            "box": 40, "boxes": 2, "vertices": 128, "max-time": 1500, "seeds": [1, 2, 3]})
        for tension in (0.05, 0.2):
            chosen = [row for row in rows if np.isclose(row["line_tension"], tension)]
            ways = runner.ways(f"hybrid-flow-{preset}", chosen, 5, 5)
            moving, hybrid = np.sum([outlines.hybrid_frames(way) for way in ways], axis=0)
            shares.append(hybrid / max(moving, 1))
            words.append(f"{shares[-1]:.1%} of {moving} frames at {tension:g} ({preset})")
    return Finding(AGREES if max(shares) >= 0.01 else IN_KIND if max(shares) > 0 else DOES_NOT, ", ".join(words))
