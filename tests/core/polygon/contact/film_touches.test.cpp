/// Tests friction that walls exert through closed films of oil (docs/explanation/model.md).

#include "clog/core/polygon/contact/film_touches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "clog/core/model/model.hpp"
#include "clog/core/polygon/contact/wall_friction.hpp"
#include "clog/core/polygon/step/dp_droplet.hpp"
#include "clog/core/run/droplet_run.hpp"
#include "support.hpp"

namespace clog {
namespace {

using namespace test;
using std::numbers::pi;

/// A contour that consists of arcs around the origin. Each arc has its own radius, and the directions
/// alternate. The end of the last arc is joined to the first arc far outside.
class Stack {
 public:
  static constexpr double disc = 0.5, range = 0.02, stiffness = 4e4;
  static constexpr int on_arc = 41;
  /// @param overlaps  overlap of the disc with the first arc, then of each arc with the next one [sigma]
  explicit Stack(std::vector<double> overlaps) : contacts_(range, pi * disc / (on_arc - 1)) {
    std::vector<double> radii = {disc - overlaps[0]};
    for (std::size_t k = 1; k < overlaps.size(); ++k) radii.push_back(radii.back() + range - overlaps[k]);
    if (radii.size() % 2 != 0) radii.push_back(2 * disc);
    num_ = static_cast<int>(radii.size()) * on_arc;
    state_ = state_of(Eigen::ArrayXd(Eigen::Index{2} * num_));
    for (int i = 0; i < num_; ++i) {
      const int arc = i / on_arc, k = i % on_arc;
      const double angle = pi * (arc % 2 == 0 ? k : on_arc - 1 - k) / (on_arc - 1);
      state_.position[i] = radii[static_cast<std::size_t>(arc)] * std::cos(angle);
      state_.position[num_ + i] = radii[static_cast<std::size_t>(arc)] * std::sin(angle);
    }
    contacts_.update(state_, {});
  }

  /// The largest friction that can hold each arc, divided by mu. @param wall  the disc, or a wall of the same
  /// curvature
  std::vector<double> held(const WallPlace& wall = {0, 0, disc}, std::span<const Wedge> wedges = {}) {
    std::vector<WallTouch> touches;
    for (int i = 0; i < num_; ++i) {
      const Eigen::Array2d from_centre{state_.x()[i], state_.y()[i]};
      const double r = from_centre.matrix().norm();
      if (r < disc)
        touches.push_back({i, wall, foot_on(wall, wedges, from_centre), stiffness * (disc - r), 0});
    }
    FilmTouches films(0, stiffness, wedges);
    films.add_to(touches, {num_, state_.position.data(), state_.position.data() + num_}, contacts_);
    std::vector<double> held(static_cast<std::size_t>(num_ / on_arc), 0.0);
    for (const WallTouch& touch : touches)
      held[static_cast<std::size_t>(touch.vertex / on_arc)] += touch.push;
    return held;
  }

 private:
  int num_;
  DropletState state_;
  SelfContacts contacts_;
};

TEST(FilmTouches, OfAStackBearTogetherWhatTheWallBears) {
  // The normal force on each of the three interfaces balances the tension of this interface.
  constexpr double first = 8e-3, second = 1e-3, third = 5e-4;
  const double by_wall = Stack::stiffness * first * Stack::on_arc;
  const std::vector<double> alone = Stack({first}).held();
  EXPECT_NEAR(alone[0], by_wall, 1e-9 * by_wall);
  const std::vector<double> held = Stack({first, second, third}).held();
  EXPECT_NEAR(held[0] + held[1] + held[2], by_wall, 0.05 * by_wall);
  EXPECT_GT(held[2], 0);
  EXPECT_NEAR(held[3], 0, 1e-12);
  // A vertex is pushed by its own contact and by the contacts of other vertices with its edges, so the force
  // per overlap is not `stiffness`. The last arc shows this force, because only one neighbour pushes it. The
  // middle arc is pushed outwards by the first arc and inwards by the last.
  const double unit = held[2] / third;
  EXPECT_NEAR(held[1], unit * (second - third), 0.05 * by_wall);
}

TEST(FilmTouches, OnTheTipOfAWedgeAreThoseOnADisc) {
  const Wedge tip{.tip = {0, Stack::disc}, .axis = {0, -1}, .half_angle = 1e-9, .radius = Stack::disc};
  const WallPlace wall{tip.centre()[0], tip.centre()[1], tip.radius, 0};
  const std::vector<double> overlaps = {8e-3, 1e-3, 5e-4};
  const std::vector<double> on_disc = Stack(overlaps).held();
  const std::vector<double> on_tip = Stack(overlaps).held(wall, std::span(&tip, 1));
  for (std::size_t arc = 0; arc < on_disc.size(); ++arc)
    EXPECT_NEAR(on_tip[arc], on_disc[arc], 1e-6 * on_disc[0]) << arc;
}

TEST(FilmTouches, EndWhereTheWallDoesNotPushAnyInterface) {
  const std::vector<double> held = Stack({-1e-3, 2e-3}).held();
  EXPECT_EQ(held[0] + held[1], 0);
}

/// Two ropes over half of a disc, one on top of the other. The straight ends of the ropes hang along +x. The
/// ropes represent the two parts of the interface of a droplet that hangs over a post. Forces at the ends
/// replace the lobes.
class Band {
 public:
  static constexpr double radius = 0.5, film = 0.02;
  struct Law {
    double friction = 0;
    FilmFriction films = FilmFriction::on;
  };
  /// @param on_disc  number of edges on half of the circumference  @param weight  weight of each rope,
  /// divided by its length
  Band(Law law, int on_disc, double weight)
      : law_(law),
        weight_(weight),
        num_hanging_(static_cast<int>(std::lround(0.3 * on_disc / (pi * radius)))),
        on_disc_(on_disc),
        each_(on_disc + 1 + 2 * num_hanging_),
        n_(2 * each_ + 1),
        friction_(law.friction, 0, friction_stiffness_ratio * contact_, {}),
        films_(0, contact_, {}),
        self_(film, pi * radius / on_disc) {
    state_ = state_of(Eigen::ArrayXd::Zero(Eigen::Index{2} * n_));
    for (int i = 0; i < n_; ++i) {
      const double r = radius_of(i);
      const int k = along(i) - num_hanging_, edges = edges_of(i);
      const double angle = pi * k / edges;
      const bool before = k<0, after = k> edges;
      state_.position[i] = before ? -k * edge_of(i) : after ? (k - edges) * edge_of(i) : -r * std::sin(angle);
      state_.position[n_ + i] = before ? r : after ? -r : r * std::cos(angle);
    }
  }

  double hanging() const { return num_hanging_ * pi * radius / on_disc_; }
  /// A force pulls at each end of each rope.
  struct Pulls {
    double lower_first, lower_second, upper_first, upper_second;
  };
  struct Slides {
    bool lower, upper;
    bool operator==(const Slides&) const = default;
  };
  /// Finds which ropes slide towards their second ends.
  Slides slides(const Pulls& pulls) {
    constexpr int loading = 6000, waiting = 16000;
    double lower = 0, upper = 0;
    for (int step = 0; step < loading + waiting; ++step) {
      // All forces grow in proportion, so that no rope slides before the forces are complete.
      move(pulls, std::min(1.0, static_cast<double>(step) / loading));
      if (step == loading + waiting / 2) lower = state_.position[each_ - 1], upper = state_.position[each_];
    }
    const double little = 1e-4 * pi * radius / on_disc_;
    return {state_.position[each_ - 1] - lower > little, state_.position[each_] - upper > little};
  }

 private:
  static constexpr double contact_ = 4e4, spring_ = 8e4;
  Law law_;
  double weight_;
  int num_hanging_, on_disc_, each_, n_;
  WallFriction friction_;
  FilmTouches films_;
  SelfContacts self_;
  KnownAnchors known_;
  DropletState state_;

  // The contour follows the lower rope from its first end to its second, and then the upper rope from its
  // second end to its first.
  bool is_lower(int i) const { return i < each_; }
  int along(int i) const { return is_lower(i) ? i : n_ - 1 - i; }
  double radius_of(int i) const { return is_lower(i) ? radius : radius + film; }
  // The upper rope has one edge more than the lower rope. So along the disc the corners of the upper rope are
  // at changing positions between those of the lower rope, and the ropes do not interlock.
  int edges_of(int i) const { return is_lower(i) ? on_disc_ : on_disc_ + 1; }
  double edge_of(int i) const { return pi * radius_of(i) / edges_of(i); }

  void move(const Pulls& pulls, double share) {
    constexpr double mass = 12 * spring_;
    const double kept = 1 - 2 * pi * 0.35 / each_;
    Eigen::ArrayXd force = Eigen::ArrayXd::Zero(Eigen::Index{2} * n_);
    const auto x = state_.x();
    const auto y = state_.y();
    const auto add = [&](int i, const Eigen::Array2d& push) {
      force[i] += push[0], force[n_ + i] += push[1];
    };
    for (int i = 0; i + 1 < n_; ++i) {
      if (i + 1 == each_) continue;
      const Eigen::Array2d edge{x[i + 1] - x[i], y[i + 1] - y[i]};
      const double length = edge.matrix().norm();
      const Eigen::Array2d pull = spring_ * (length - edge_of(i)) / length * edge;
      add(i, pull), add(i + 1, -pull);
    }
    self_.update(state_, {.absolute = 1e-4, .relative = 1e-4});
    for (const SelfContacts::Pair& pair : self_.pairs()) {
      const EdgeContact at = nearest_point(pair, state_.position.data(), state_.position.data() + n_, n_);
      if (at.distance >= film) continue;
      const double size = contact_ * (film - at.distance) / at.distance;
      const Eigen::Array2d push{size * at.dx, size * at.dy};
      add(pair.vertex, push), add(pair.edge, -(1 - at.fraction) * push);
      add((pair.edge + 1) % n_, -at.fraction * push);
    }
    std::vector<WallTouch> touches;
    for (int i = 0; i < n_; ++i) {
      force[i] += share * weight_ * edge_of(i);
      const double r = std::hypot(x[i], y[i]);
      if (r >= radius) continue;
      const double push = contact_ * (radius - r);
      add(i, {push * x[i] / r, push * y[i] / r});
      const WallPlace disc{0, 0, radius};
      touches.push_back({i, disc, foot_on(disc, {}, {x[i], y[i]}), push, 0});
    }
    if (law_.films == FilmFriction::on)
      films_.add_to(touches, {n_, state_.position.data(), state_.position.data() + n_}, self_);
    force[0] += share * pulls.lower_first;
    force[each_ - 1] += share * pulls.lower_second;
    force[each_] += share * pulls.upper_second;
    force[n_ - 1] += share * pulls.upper_first;
    friction_.follow(state_, touches, Purpose::motion, known_);
    friction_.add_forces(state_, force);
    state_.velocity = kept * (state_.velocity + force / mass);
    state_.position += state_.velocity;
  }
};

TEST(BandOverADisc, WithoutWeightSlidesAtExpMuTheta) {
  // The normal force on each rope comes from the tension of this rope. So dT/dtheta = mu T, and T_2 = exp(mu
  // theta) T_1 whatever the other rope does. Friction holds each rope as if it were alone.
  constexpr double mu = 0.3;
  const double exact = std::exp(mu * pi);
  const double less = 0.97 * exact, more = 1.03 * exact;
  for (const double other : {1.0, 3.0}) {
    EXPECT_FALSE(Band({mu}, 32, 0).slides({other, other, 1, less}).upper) << other;
    EXPECT_TRUE(Band({mu}, 32, 0).slides({other, other, 1, more}).upper) << other;
  }
  EXPECT_FALSE(Band({mu}, 32, 0).slides({1, less, 1, 1}).lower);
  EXPECT_TRUE(Band({mu}, 32, 0).slides({1, more, 1, 1}).lower);
  EXPECT_EQ(Band({mu}, 32, 0).slides({1, less, 1, less}), (Band::Slides{false, false}));
  EXPECT_EQ(Band({mu}, 32, 0).slides({1, more, 1, more}), (Band::Slides{true, true}));
}

TEST(BandOverADisc, OfWeightSlidesWhenItsOverhangSaysSo) {
  // A single heavy rope slides at L_2 = exp(mu pi) L_1 + 2 mu R (1 + exp(mu pi))/(1 + mu^2). Each of the two
  // ropes does the same, with its own radius.
  constexpr double mu = 0.5, weight = 2;
  constexpr int edges = 32;
  const double grip = std::exp(mu * pi);
  const auto slides = [&](double share) {
    Band band({mu}, edges, weight);
    const auto pulls = [&](double radius) {
      // This is the overhang measured from the side of the disc.
      const double own = band.hanging() * radius / Band::radius + pi * radius / edges / 2;
      const double exact = grip * own + 2 * mu * radius * (1 + grip) / (1 + mu * mu);
      return std::pair(0.0, weight * (share * exact - own));
    };
    const auto [lower_first, lower_second] = pulls(Band::radius);
    const auto [upper_first, upper_second] = pulls(Band::radius + Band::film);
    return band.slides({lower_first, lower_second, upper_first, upper_second});
  };
  EXPECT_EQ(slides(0.97), (Band::Slides{false, false}));
  EXPECT_EQ(slides(1.03), (Band::Slides{true, true}));
}

TEST(BandOverADisc, IsHeldByCornersAloneIfNothingHoldsItsUpperRope) {
  // The two ropes together bear the weights of two lobes, and one lobe is heavier than the other. Without
  // friction through the film the upper rope yields at once, however strongly the lower rope is held. Only
  // the corners of the lower rope then hold the upper rope. The force of the corners falls with the square of
  // the edge length.
  const auto upper_slides = [](Band::Law law, int edges, double imbalance) {
    return Band(law, edges, 0).slides({1, 1 + imbalance, 1, 1 + imbalance}).upper;
  };
  for (const int edges : {8, 16, 32}) {
    const double x = pi / edges;
    for (const double mu : {0.0, 0.3, 1.0}) {
      EXPECT_TRUE(upper_slides({mu, FilmFriction::off}, edges, x * x / 2)) << edges << ' ' << mu;
      EXPECT_EQ(upper_slides({mu, FilmFriction::on}, edges, x * x / 2), mu == 0) << edges << ' ' << mu;
    }
  }
}

}  // namespace
}  // namespace clog
