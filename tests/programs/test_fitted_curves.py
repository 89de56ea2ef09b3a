"""Tests the curves of clogsweep.curves. The curves are compared with recorded output of the C++ program that this
module replaces, with closed formulas, and with exact small cases. Also tests which points belong to a curve."""

import functools
import json
import math
import pathlib
import sys
import unittest

import numpy as np
from scipy import optimize, stats

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "analysis"))
from clogsweep.curves import answer, features, model, points, table  # noqa: E402
from clogsweep.tools.errors import UserError  # noqa: E402

# RECORDS are outputs of `clogfit curve` (git 0b3b912ecf24) for sweeps with invented distances. Each record contains the
# command, the output, and the clogs of each point by mechanism. The output in a record has only every fourth grid point
# of a curve, or every thirteenth of a surface.
RECORDS = json.loads((pathlib.Path(__file__).parent / "data" / "curves.json").read_text())["records"]
LENGTH = ("clogging_length", "clogging_length_lower", "clogging_length_upper")


def known_points(log_keys, clogs, distances):
    return model.Points(np.array(log_keys, dtype=float), np.array(clogs, dtype=float), np.array(distances, dtype=float))


class Records(unittest.TestCase):
    @staticmethod
    @functools.cache
    def fits():
        found = []
        for record in RECORDS:
            printed = record["told"]
            for recorded in printed["curves"]:
                at = [[math.log(point[key]) for key in printed["keys"]] for point in recorded["points"]]
                known = known_points(at, [point["clogs"] for point in recorded["points"]],
                                     [point["total_distance"] for point in recorded["points"]])
                places = points.grid_over(known.places)
                found.append((printed, recorded, known, places, model.fit_curve(known, places)))
        return found

    def test_mean_band_crossings_and_mechanisms_agree_with_the_recorded_ones(self):
        for printed, recorded, known, places, curve in self.fits():
            step = recorded["curve"]["step"]
            whole = features.band(curve, printed["confidence"])
            shown = recorded["curve"]["places"]
            np.testing.assert_allclose(whole[:, ::step], [[place[name] for place in shown] for name in LENGTH], rtol=1e-6)
            for i, key in enumerate(printed["keys"]):
                np.testing.assert_allclose(np.exp(places[::step, i]), [place[key] for place in shown], rtol=1e-12)
            by_cause = answer.bands_by_cause([point["causes"] | {"clogs": point["clogs"]} for point in recorded["points"]], known, places, printed["confidence"], whole)
            for names, band in by_cause.items():
                np.testing.assert_allclose(band[:, ::step], [[place[name] for place in shown] for name in names], rtol=1e-6)
            self.assertEqual(len(by_cause), sum(names[0] in shown[0] for names in answer.CAUSES.values()))
            for one in recorded["crossings"]:
                key = printed["keys"][0]
                found = min(features.find_crossings(curve, places[:, 0], one["clogging_length"], printed["confidence"]),
                            key=lambda crossing: abs(crossing.place - math.log(one[key])))
                self.assertEqual(found.is_upward, one["direction"] == "upwards")
                for value, name in ((found.place, key), (found.lower, f"{key}_lower"), (found.upper, f"{key}_upper")):
                    # The recorded end is 0 or None if the interval is infinite on this side.
                    self.assertAlmostEqual(math.exp(-value) * one[name] if one[name] else 1.0 * math.isinf(value), 1, delta=1e-6)

    def test_peaks_agree_and_their_intervals_do_within_the_scatter_of_the_draws(self):
        for printed, recorded, _, places, curve in self.fits():
            peak = features.find_peak(curve, places, printed["confidence"])
            expected = recorded["peak"]
            self.assertAlmostEqual(peak.length / expected["clogging_length"], 1, delta=1e-6)
            # Both programs use 2000 draws. The standard error of an end of the interval follows from the density of the
            # draws there.
            draws = features.tops(features.drawn_curves(curve), places)
            ends = [(np.log([peak.length_lower,
                             peak.length_upper]), [math.log(expected[name]) for name in LENGTH[1:]], draws[1])]
            for i, key in enumerate(printed["keys"]):
                self.assertAlmostEqual(math.exp(peak.place[i]) / expected[key], 1, delta=1e-6)
                ends.append(((peak.place_lower[i], peak.place_upper[i]),
                             [math.log(expected[f"{key}{end}"]) for end in ("_lower", "_upper")], draws[0][:, i]))
            for ours, theirs, drawn in ends:
                for tail, mine, other in zip(((1 - printed["confidence"]) / 2, (1 + printed["confidence"]) / 2), ours, theirs):
                    error = math.sqrt(2 * tail * (1 - tail) / features.NUM_DRAWS)
                    low, high = np.quantile(drawn, [max(tail - 4 * error, 0), min(tail + 4 * error, 1)])
                    self.assertTrue(low - 1e-9 <= other <= high + 1e-9, (mine, other, low, high))
            inside = expected["probability_between_borders"]
            self.assertAlmostEqual(peak.probability_inside, inside, delta=4 * math.sqrt(2 * 0.25 / features.NUM_DRAWS))


class Model(unittest.TestCase):
    def test_one_point_has_the_normal_interval_of_a_poisson_count(self):
        # With a wide prior, the posterior for one point has the mean log lambda = log(S/d) and the variance 1/d. For
        # many clogs the interval is close to the exact interval of a Poisson count, (chi2(2d), chi2(2d + 2))/2.
        curve = model.curve_of_scales(known_points([[0]], [400], [2000]), model.Hyperparameters(1, (1,)),
                                      np.array([[0.0]]))
        self.assertAlmostEqual(curve.mean[0], math.log(5), delta=1e-3)
        self.assertAlmostEqual(curve.deviation[0], 1 / 20, delta=1e-4)
        _, lower, upper = features.band(curve, 0.95)[:, 0]
        self.assertAlmostEqual(lower / (2 * 2000 / stats.chi2.ppf(0.975, 802)), 1, delta=0.01)
        self.assertAlmostEqual(upper / (2 * 2000 / stats.chi2.ppf(0.025, 800)), 1, delta=0.01)

    def test_a_constant_rate_gives_a_flat_curve_with_the_interval_of_all_clogs(self):
        x = np.log([[0.1], [0.3], [1], [3]])
        curve = model.curve_of_scales(known_points(x, [100] * 4, [500] * 4), model.Hyperparameters(0.001, (1,)), x)
        np.testing.assert_allclose(curve.mean, math.log(5), atol=1e-3)
        np.testing.assert_allclose(curve.deviation, 1 / 20, rtol=1e-3)

    def test_a_straight_line_in_logarithms_is_followed_between_its_points(self):
        x = np.linspace(0, 3, 7)[:, None]
        curve = model.fit_curve(known_points(x, [1000] * 7, 1000 * np.exp(1 + 0.8 * x[:, 0])),
                                np.array([[0.7], [1.3], [2.2]]))
        np.testing.assert_allclose(curve.mean, [1.56, 2.04, 2.76], atol=0.03)

    def test_the_mode_is_that_of_a_general_optimiser_and_the_variance_that_of_the_full_hessian(self):
        x, clogs, distances = np.array([[0.0], [0.5], [2.0]]), np.array([3.0, 0, 7]), np.array([5.0, 40, 20])
        scales = model.Hyperparameters(1.5, (0.8,))
        known = known_points(x, clogs, distances)
        covariance = model.kernel(x, x, scales) + model.JITTER * 1.5**2 * np.eye(3)
        precision = np.linalg.inv(covariance)

        def loss(f):
            g = f - known.level
            return clogs @ f + distances @ np.exp(-f) + g @ precision @ g / 2

        found = optimize.minimize(loss, np.full(3, known.level), method="Nelder-Mead",
                                  options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 10000})
        curve = model.curve_of_scales(known, scales, x)
        np.testing.assert_allclose(curve.mean, found.x, atol=1e-5)
        exact = np.linalg.inv(precision + np.diag(distances * np.exp(-curve.mean)))
        np.testing.assert_allclose(curve.covariance, exact, atol=1e-6)

    def test_what_is_no_number_is_refused(self):
        for log_keys, distances in (([], []), ([[0]], [0]), ([[0]], [math.nan]), ([[math.nan]], [1])):
            with self.subTest(distances=distances), self.assertRaises(ValueError):
                known_points(np.reshape(log_keys, (-1, 1)), [1] * len(distances), distances)


def column(name, role="physics", **more):
    return {"name": name, "key": name.replace("_", "-"), "unit": "", "kind": "number", "shapes_array": False, "parameter_role": role} | more


COLUMNS = [column("line_tension", unit="g rho sigma^2"), column("obstacle_gap", shapes_array=True), column("friction"), column("inertia", "numerics"),
           column("time_step", "numerics"), {"name": "obstacle_density", "unit": "", "kind": "number", "shapes_array": True},
           {"name": "preset", "unit": "", "kind": "word", "shapes_array": False}]
TENSIONS = (0.1, 0.3, 1.0, 3.0)


def group(line_tension, **more):
    usual = {"model": "dp", "obstacle_filling": "saturated", "obstacle_density": 1.0, "obstacle_gap": 0.2, "obstacle_diameter": 0.3, "friction": 0.0,
             "inertia": 1.0, "time_step": line_tension, "automatic": ["time_step", "obstacle_density"], "preset": "robust", "exit": 0.0, "runs": 6, "clogs": 6, "total_distance": 12.0,
             "clogging_length": 2.0, "clogging_length_lower": 1.0, "clogging_length_upper": 4.0, "wrapped": 6, "squeezed": 0,
             "hybrid": 0, "other": 0, "broken": 0}
    return usual | {"line_tension": line_tension} | more


def fit_of(groups):
    return {"version": "1", "git_describe": "x", "confidence": 0.95, "columns": COLUMNS, "lists": [], "groups": groups}


def curves_of(groups, *names, seeds=None, crossing=()):
    return answer.of_fit(fit_of(groups), seeds or [{i} for i in range(len(groups))], names or ["line-tension"], crossing)


class WhichPoints(unittest.TestCase):
    def test_a_curve_needs_four_values_three_of_them_with_clogs(self):
        self.assertEqual(len(curves_of([group(tension) for tension in TENSIONS])["curves"]), 1)
        for groups, words in (([group(tension) for tension in TENSIONS[:3]], "only 3 values of line-tension"),
                              ([group(tension, clogs=6 if tension < 0.5 else 0) for tension in TENSIONS],
                               "clogs at only 2 of the values")):
            with self.subTest(words), self.assertRaisesRegex(UserError, words):
                curves_of(groups)

    def test_only_a_key_with_enough_values_is_suggested(self):
        many = [group(tension, friction=friction) for tension in TENSIONS for friction in (0.1, 0.2)]
        for groups, words in ((many, "try --key line-tension$"), (many[2:], "several keys vary, line-tension, friction, .* give the sweep 4 values of one of them, with clogs at 3")):
            with self.subTest(words), self.assertRaisesRegex(UserError, words):
                answer.of_fit(fit_of(groups), [{i} for i in range(len(groups))])
        rarely = [group(tension, friction=friction, clogs=6 if tension == 1 else 0) for tension in (1.0, 2.0) for friction in (0.1, 0.2, 0.3, 0.4)]
        with self.assertRaisesRegex(UserError, "try --key friction$"):
            answer.of_fit(fit_of(rarely), [{i} for i in range(len(rarely))])

    def test_arrays_and_channels_share_no_curve(self):
        groups = [*(group(tension) for tension in TENSIONS), group(1.0, obstacle_filling="channel", status="passed")]
        with self.assertRaisesRegex(UserError,
                                    "arrays and channels; .*clogsweep select FILE obstacle_filling=saturated"):
            curves_of(groups)

    def test_numerics_that_differ_between_values_do_not_split_a_curve(self):
        curve, = curves_of([group(tension, inertia=4.0 if tension > 2 else 1.0) for tension in TENSIONS])["curves"]
        self.assertEqual((len(curve["points"]), curve["shared"]), (4, {}))

    def test_numerics_that_vary_at_the_same_physics_do(self):
        printed = curves_of([group(tension, inertia=inertia) for tension in TENSIONS for inertia in (1.0, 4.0)])
        self.assertEqual([curve["shared"] for curve in printed["curves"]], [{"inertia": 1.0}, {"inertia": 4.0}])

    def test_what_follows_from_the_key_does_not_split_a_curve(self):
        groups = [group(1.0, obstacle_gap=gap, obstacle_density=0.7 / (gap + 0.3)**2, preset=f"p{gap}") for gap in (0.2, 0.3, 0.4, 0.5)]
        curve, = curves_of(groups, "obstacle_gap")["curves"]
        self.assertEqual(len(curve["points"]), 4)

    def test_excluded_points_are_named_with_the_reason(self):
        groups = [*(group(tension) for tension in TENSIONS), group(1.0, friction=0.5), group(0.5, total_distance=0.0), group(2.0, exit=15.0)]
        printed = curves_of(groups)
        self.assertEqual(len(printed["curves"]), 1)
        reasons = {one["group"]: one["reason"] for one in printed["excluded"]}
        self.assertEqual(sorted(reasons), [4, 5, 6])
        for index, words in ((4, "only one value of line-tension with friction=0.5"), (5, "distance"), (6, "exit")):
            self.assertIn(words, reasons[index])
        self.assertIn("in no curve:\n  line_tension 1: only one value",
                      table.text(printed, []).replace("line_tension 0.5", "").replace("  line_tension 2", ""))

    def test_points_share_obstacles_where_they_share_seeds_and_the_key_leaves_the_array(self):
        groups = [group(tension) for tension in TENSIONS]
        self.assertTrue(curves_of(groups, seeds=[{1, 2}] * 4)["curves"][0]["common_obstacles"])
        self.assertFalse(curves_of(groups)["curves"][0]["common_obstacles"])
        gaps = [group(1.0, obstacle_gap=gap) for gap in (0.2, 0.3, 0.4, 0.5)]
        self.assertFalse(curves_of(gaps, "obstacle_gap", seeds=[{1, 2}] * 4)["curves"][0]["common_obstacles"])

    def test_lists_of_lengths_are_those_of_the_programs(self):
        self.assertEqual(table.lengths("10,100"), [10, 100])
        np.testing.assert_allclose(table.lengths("log(1,100,3), 5, lin(1,2,2)"), [1, 10, 100, 5, 1, 2])
        for words in ("-1", "10sigma", "0", "nan", "log(0,1,2)"):
            with self.subTest(words), self.assertRaises(ValueError):
                table.lengths(words)


if __name__ == "__main__":
    unittest.main()
