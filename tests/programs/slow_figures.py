"""Draws all figures of the article (Cheng et al.) from small sweeps."""

import math
import unittest

import h5py

import test_figures
from support import BIN, table
from test_figures import SET


class Figures(test_figures.Drawn):
    def test_curves_show_what_clogfit_says(self):
        names = {"6c-saturated": ("clogging-saturated", "clogging_length"), "7a": ("clogging-sp", "clogging_length"),
                 "7a-saturated": ("clogging-sp-saturated", "clogging_length"), "8a": ("speed", "relative_speed_steady"),
                 "8b": ("speed-diameter", "relative_speed_steady"), "8ca": ("speed", "relative_speed_steady"),
                 "9a": ("speed-sp", "relative_speed_steady"),
                 "E": ("near-wall-drag", "relative_speed_steady")}
        self.assert_curves(names, "6c", "6c-filling", "7c", "7c-saturated", "9b")
        self.assert_sags("7c")
        for point in self.drawn("8ca"):
            self.assertAlmostEqual(float(point["capillary_number"]),
                                   float(point["relative_speed_steady"]) * math.pi / 4 / float(point["line_tension"]))

        # Figure 6c shows every point of all families on both meshes.
        drawn = {(row["curve"].split(",")[0], row["vertices"], row["friction"], row["obstacle_gap"],
                  row["line_tension"], row["clogging_length_lower"]) for row in self.drawn("6c")}
        printed = {(config,
                    *(str(group[name])
                      for name in ("vertices", "friction", "obstacle_gap", "line_tension", "clogging_length_lower")))
                   for config in ("clogging-robust", "clogging-friction", "clogging-elastic")
                   for sweep in (config, f"{config}-mesh") for group in self.fit(sweep)}
        self.assertEqual(len({curve for curve, *_ in printed}), 3)
        self.assertEqual(drawn, printed)

        file = self.folder / self.PLACE / "sweeps" / "clogging-friction.h5"
        self.assert_clogs(file, "5", "6a", "6b")
        self.assert_report(file)

    def test_the_map_shows_every_density(self):
        self.figures("map")
        self.assert_picture(f"{self.PLACE}/figure-map")
        points = self.drawn("map")
        printed = [group for sweep in ("map-robust", "map-friction") for group in self.fit(sweep)]
        for name in ("obstacle_gap", "obstacle_filling", "line_tension", "friction", "clogging_length_lower"):
            self.assertEqual(sorted(point[name] for point in points), sorted(str(group[name]) for group in printed))
        self.assertEqual({point["obstacle_filling"] for point in points}, {"density", "saturated"})

    def test_single_runs_are_drawn_as_they_were_run(self):
        # The number of runs for the figures of single droplets. Figure A1 needs no separate runs.
        self.assert_single_runs(["1", "2", "3", "4", "7b", "A1", "B1", "B2", "C1", "C2", "D"],
                                1 + 1 + 2 + 6 + 1 + 3 + 14 + 2 + 5, "7b", "3", "B2")

    def test_channels_are_sweeps_and_what_their_rows_say_is_drawn(self):
        self.figures("3", "A1", "B1", "--ranks", 2)
        rows = {name: table(self.folder / self.PLACE / "sweeps" / f"{name}.h5")
                for name in ("channel-0.7", "walls", "vertices")}
        self.assertEqual({name: len(those)
                          for name, those in rows.items()}, {"channel-0.7": 1, "walls": 8, "vertices": 3})
        for point, (_, row) in zip(self.drawn("A1"), rows["walls"].iterrows(), strict=True):
            self.assertEqual(float(point["speed_ratio"]), row.mean_speed / row.terminal_speed)
            self.assertAlmostEqual(row.orifice, 1 + 2 * float(point["distance"]))
        for name, sweep in (("3", "channel-0.7"), ("B1", "vertices")):
            drawn = [point for point in self.drawn(name) if point["smallest_relative_speed"]]
            for point, (_, row) in zip(drawn[-len(rows[sweep]):], rows[sweep].iterrows(), strict=True):
                for column in ("largest_shape_parameter", "largest_shape_parameter_at", "smallest_relative_speed",
                               "largest_relative_speed"):
                    self.assertEqual(float(point[column]), row[column])
        # After this exchange, the stored path is not the path of the sweep's row. With --draw-only the figure is
        # refused. Without it the run is repeated.
        way = self.folder / self.PLACE / "runs" / "vertices-1.h5"
        way.with_name("vertices-0.h5").replace(way)
        self.refuse_analysis("figures", "B1", "--output", ".", "--programs", BIN, *SET, "--draw-only",
                             words=["vertices-0.h5", "not there"])
        self.figures("B1")
        with h5py.File(way) as file:
            self.assertEqual(file["runs"]["vertices"][0], 64)


if __name__ == "__main__":
    unittest.main()
