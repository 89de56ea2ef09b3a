"""Tests that a sweep over any key is drawn correctly, and that its clogs are found again. slow_schema tests whole
pages."""

import json
import unittest

from drawing import Analysis
from support import BIN, QUICK

import clogsweep
from clogsweep import style
from clogsweep.drawing import clogs, curve
from clogsweep.labels.groups import Groups

# Settings for two kinds of keys: keys that apply only to certain runs, and keys whose values are words, because these
# keys take no lists
SURROUNDINGS = {
    "lattice-angle": ["obstacle-layout=lattice", "box=60", "obstacle-gap=0.5"],
    "pitch": ["obstacle-layout=lattice", "box=60"],
    "perimeter-stiffness-ratio": ["preset=elastic"],
    "box": ["obstacle-density=saturated", "vertices=64", "max-time=60"],
    "vertices": ["obstacle-density=saturated", "box=20", "max-time=60"],
    "max-time": ["obstacle-density=saturated", "box=20", "vertices=64"],
    "obstacle-density": ["box=20", "vertices=64", "max-time=60"],
    "advancing-angle": ["obstacle-density=saturated", "wall-tension=0.5", "box=20", "vertices=64", "max-time=60"],
    "friction": ["obstacle-density=saturated", "preset=elastic", "box=20", "vertices=64", "max-time=60"],
    "yield-traction": ["obstacle-density=saturated", "preset=elastic", "box=20", "vertices=64", "max-time=60"],
    "obstacles": ["box=10", "vertices=64", "max-time=300"],
    **{key: [*QUICK, "break-up=daughters", "break-up-neck=0.05"] for key in ("smallest-daughter", "speed-exponent")},
    **{key: ["obstacles=one.csv", "box=10", "vertices=64", "max-time=300", "release=entrance"]
       for key in ("entrance", "entrance-from", "entrance-to", "exit", "length")},
}
# These keys apply to channels. Channels have passages instead of clogging lengths, so test_scenes tests them.
OF_CHANNELS = {"orifice", "wedge-angle", "tip-radius", "start", "end"}
VALUES = {"line-tension": "1,3", "wall-stiffness": "0.05,0.08", "obstacle-gap": "0.2,0.3", "obstacle-diameter": "0.3,0.4",
          "obstacle-diameter-spread": "0,0.2", "obstacle-density": "1.5,2", "lattice-angle": "0,10", "pitch": "0.8,0.9", "seeds": "1..3", "box": "20,25",
          "boxes": "1,2", "max-time": "50,60", "terminal-speed": "0.02,0.03", "near-wall-drag": "0,0.05",
          "near-wall-exponent": "1,1.5", "near-wall-cutoff": "0.006,0.01", "relative-drag": "0.5,1", "vertices": "64,96", "inertia": "1,4",
          "time-step": "1e-3,2e-3", "area-stiffness": "5000,6000", "perimeter-stiffness": "0.05,0.1",
          "perimeter-stiffness-ratio": "0.1,0.2", "contact-range": "0,0.01", "wall-tension": "0.5,1",
          "receding-angle": "120,150", "advancing-angle": "130,150", "friction": "0.1,0.2", "yield-traction": "0.05,0.1",
          "self-contact-range": "0.01,0.012", "clog-energy": "1e-17,1e-16", "dwell-length": "0.04,0.05",
          "break-up-neck": "0,0.05", "smallest-daughter": "0.2,0.3", "speed-exponent": "0,1",
          "obstacles": "one.csv,other.csv", "length": "12,15", "entrance": "2,3", "entrance-from": "1,2", "entrance-to": "8,9",
          "exit": "8,9",
          "laboratory": "angle = 20 deg; diameter = 1 mm; speed = 1 mm/s,angle = 20 deg; diameter = 2 mm; "
                        "speed = 1 mm/s"}


class Sweeps(Analysis):
    def schema(self):
        return json.loads(self.succeed("clogsweep", "--schema").stdout)["keys"]

    def keys(self):
        return [key for key in self.schema() if key["kind"] != "word" and key["scope"] != "channel"]

    def fit(self):
        return Groups(json.loads(self.succeed("clogfit", "s.h5", "--format", "json").stdout))

    def sweep(self, key):
        (self.folder / "s.h5").unlink(missing_ok=True)
        for name, x in [("one.csv", 6.2), ("other.csv", 6.25)]:  # The files contain rows of posts across the flow.
            (self.folder / name).write_text("x,y,diameter\n" + "".join(f"{x},{i * 10 / 12},0.3\n" for i in range(12)))
        seeds = [] if key in ("seeds", "obstacles") else ["seeds=1..2"]
        tension = [] if key == "line-tension" else ["line-tension=2"]
        self.succeed("clogsweep", *SURROUNDINGS.get(key, QUICK), *seeds, *tension, f"{key}={VALUES[key]}", "--output", "s.h5")


class EveryKey(Sweeps):
    def test_there_is_a_sweep_over_every_number(self):
        self.assertEqual({key["key"] for key in self.keys()}, set(VALUES))
        self.assertEqual({key["key"] for key in self.schema() if key["scope"] == "channel"}, OF_CHANNELS)

    def test_a_sweep_over_any_key_is_drawn_as_what_it_is(self):
        for key in self.keys():
            with self.subTest(key=key["key"]):
                self.sweep(key["key"])
                groups = self.fit()
                if key["role"] != "ensemble":
                    if key["key"] == "laboratory":  # The laboratory lists droplets of two sizes.
                        self.assertEqual((groups.abscissa, groups.values("diameter_mm")), ("diameter_mm", {1, 2}))
                    elif key["kind"] == "file":  # Files cannot be values on an axis, so each file has its own curve.
                        self.assertEqual([len(members) for _, members in groups.curves()], [1, 1])
                    else:
                        self.assertEqual(groups.abscissa, key["column"])
                        self.assertEqual([(label, len(members)) for label, members in groups.curves()], [("", 2)])
                        axes, = style.figure_of(curve.draw_on, groups).axes
                        self.assertIn(key["column"].replace("_", " "), axes.get_xlabel())
                self.assertGreater(sum(group["clogs"] for group in groups.members), 0)
                clog, = clogsweep.open(self.folder / "s.h5", BIN).clogs(most=1)
                self.assertGreater(clogs.overlaps(clog).max(), 0, "replayed, it rests on an obstacle")

    def test_two_parameters_make_curves_of_the_one_over_the_other(self):
        self.succeed("clogsweep", *QUICK, "line-tension=1,2,3", "relative-drag=0.5,1", "seeds=1", "--output", "s.h5")
        self.assertEqual([(label, len(members)) for label, members in self.fit().curves()],
                         [("relative drag $0.5$", 3), ("relative drag $1$", 3)])


if __name__ == "__main__":
    unittest.main()
