"""A stand-in for the fitted curve: log lambda as a Gaussian process of one amplitude and one correlation length."""

import numpy as np
from clogsweep.refinement.model import Crossing, Curve, Peak


class StandIn:
    def fit(self, points, places):
        def kernel(some, others):
            apart = ((some[:, None] - others[None]) / np.ptp(places, axis=0)) ** 2
            return 4 * np.exp(-apart.sum(axis=2) / (2 * 0.3**2))

        level = np.log(points.distance.sum() / (points.clogs.sum() + 0.5))
        seen = np.log((points.distance + np.exp(level) * 0.5) / (points.clogs + 0.5)) - level
        inverse = np.linalg.inv(kernel(points.places, points.places) + np.diag(1 / (points.clogs + 0.5)))
        across = kernel(places, points.places)
        return Curve(level + across @ inverse @ seen, kernel(places, places) - across @ inverse @ across.T)

    def _draws(self, curve):
        return np.random.default_rng(1).multivariate_normal(curve.mean, curve.covariance, 400, check_valid="ignore", method="eigh")

    def peak(self, curve, places):
        draws = self._draws(curve)
        tops = places[draws.argmax(axis=1)]
        low, high = np.quantile(tops, [0.025, 0.975], axis=0)
        lengths = np.exp(np.quantile(draws.max(axis=1), [0.025, 0.975]))
        return Peak(places[curve.mean.argmax()], low, high, float(np.exp(curve.mean.max())), *lengths)

    def peak_probabilities(self, curve):
        return np.bincount(self._draws(curve).argmax(axis=1), minlength=curve.mean.size) / 400

    def crossings(self, curve, places, length):
        above = curve.mean > np.log(length)
        return [Crossing(float(places[i, 0]), float(places[max(i - 1, 0), 0]), float(places[i + 1, 0])) for i in np.flatnonzero(above[1:] != above[:-1])]
