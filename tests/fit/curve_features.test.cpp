#include "clog/fit/curve_features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace clog::fit {
namespace {

/// Places from -1 to 1.
std::vector<CurvePlace> places_between(int number = 41) {
  std::vector<CurvePlace> places;
  for (int i = 0; i < number; ++i) places.emplace_back(-1 + 2.0 * i / (number - 1), 0);
  return places;
}

/// A curve known to within `deviation` everywhere, with one common error.
template <class Function>
Curve shifted_together(const std::vector<CurvePlace>& places, const Function& mean, double deviation) {
  const auto size = static_cast<Eigen::Index>(places.size());
  Curve curve{Eigen::VectorXd(size), Eigen::MatrixXd::Constant(size, size, deviation * deviation)};
  for (Eigen::Index i = 0; i < size; ++i) curve.mean[i] = mean(places[static_cast<std::size_t>(i)]);
  return curve;
}

double parabola(const CurvePlace& place) { return 3 - std::pow(place[0] - 0.113, 2); }
double straight(const CurvePlace& place) { return 2 * place[0]; }

TEST(CurveFeatures, GiveTheBandOfANormalDistribution) {
  const std::vector<CurveValue> values =
      curve_values(shifted_together(places_between(), straight, 0.1), 0.95);
  EXPECT_NEAR(values.back().length, std::exp(2.0), 1e-12);
  EXPECT_NEAR(values.back().band.lower, std::exp(2 - 0.1959964), 1e-6);
  EXPECT_NEAR(values.back().band.upper, std::exp(2 + 0.1959964), 1e-6);
}

TEST(CurveFeatures, FindThePeakOfAParabolaBetweenPlaces) {
  const std::vector<CurvePlace> places = places_between();
  const CurvePeak peak = find_peak(shifted_together(places, parabola, 0.2), places, 0.95);
  EXPECT_NEAR(peak.place[0], 0.113, 1e-9);
  EXPECT_NEAR(peak.length, std::exp(3.0), 1e-9);
  // Errors that are the same everywhere move its height, not its place.
  EXPECT_NEAR(peak.place_lower[0], 0.113, 1e-3);
  EXPECT_NEAR(peak.place_upper[0], 0.113, 1e-3);
  EXPECT_NEAR(std::log(peak.interval.upper / peak.interval.lower), 2 * 1.96 * 0.2, 0.03);
  EXPECT_EQ(peak.share_inside, 1);
}

TEST(CurveFeatures, SayThatAPeakMayLieBeyondTheBorder) {
  const std::vector<CurvePlace> places = places_between();
  EXPECT_EQ(find_peak(shifted_together(places, straight, 0.2), places, 0.95).share_inside, 0);
}

TEST(CurveFeatures, FindThePeakOfASurface) {
  std::vector<CurvePlace> places;
  for (const CurvePlace& second : places_between(21))
    for (const CurvePlace& first : places_between(21)) places.emplace_back(first[0], second[0]);
  const auto hill = [](const CurvePlace& place) {
    return -std::pow(place[0] - 0.3, 2) - std::pow(place[1] + 0.5, 2);
  };
  const CurvePeak peak = find_peak(shifted_together(places, hill, 0.1), places, 0.95);
  EXPECT_NEAR(peak.place[0], 0.3, 1e-9);
  EXPECT_NEAR(peak.place[1], -0.5, 1e-9);
  EXPECT_EQ(peak.share_inside, 1);
}

TEST(CurveFeatures, FindCrossingsWithThePlacesAtWhichTheBandHoldsTheValue) {
  const std::vector<CurvePlace> places = places_between();
  const auto crossings = find_crossings(shifted_together(places, straight, 0.1), places, std::exp(1.0), 0.95);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_TRUE(crossings[0].is_upward);
  EXPECT_NEAR(crossings[0].place, 0.5, 1e-9);
  EXPECT_NEAR(crossings[0].interval.lower, 0.5 - 0.1959964 / 2, 1e-6);
  EXPECT_NEAR(crossings[0].interval.upper, 0.5 + 0.1959964 / 2, 1e-6);
}

TEST(CurveFeatures, LeaveACrossingOpenWhereTheBandStillHoldsTheValueAtTheBorder) {
  const std::vector<CurvePlace> places = places_between();
  const auto crossings = find_crossings(shifted_together(places, straight, 0.5), places, std::exp(1.8), 0.95);
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_TRUE(std::isfinite(crossings[0].interval.lower));
  EXPECT_TRUE(std::isinf(crossings[0].interval.upper));
}

TEST(CurveFeatures, FindBothSidesOfAPeakAndNothingAboveIt) {
  const std::vector<CurvePlace> places = places_between();
  const Curve curve = shifted_together(places, parabola, 0.01);
  const auto crossings = find_crossings(curve, places, std::exp(2.8), 0.95);
  ASSERT_EQ(crossings.size(), 2U);
  EXPECT_TRUE(crossings[0].is_upward);
  EXPECT_FALSE(crossings[1].is_upward);
  EXPECT_TRUE(find_crossings(curve, places, std::exp(4.0), 0.95).empty());
}

TEST(CurveFeatures, DrawTheSameCurvesInEveryCall) {
  const Curve curve = shifted_together(places_between(), parabola, 0.3);
  EXPECT_EQ(drawn_curves(curve, 10), drawn_curves(curve, 10));
  EXPECT_NEAR(peak_probabilities(curve).sum(), 1, 1e-9);
}

TEST(CurveFeatures, RefuseAConfidenceThatIsNone) {
  EXPECT_THROW(curve_values(shifted_together(places_between(), straight, 0.1), 1), std::invalid_argument);
}

}  // namespace
}  // namespace clog::fit
