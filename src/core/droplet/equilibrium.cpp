#include "clog/core/droplet/equilibrium.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr int most_stiffnesses = 30;  // most searches compute two stiffnesses
constexpr int most_steps = 50;        // most steps before the stiffness is recomputed; most searches need 15
constexpr int most_rejections = 10;   // number of rejected steps in a row
constexpr int most_halvings = 10;
/// Step of the central differences [sigma]: much smaller than a contact's range, much larger than round-off.
constexpr double difference_step = 1e-6;
/// Round-off of the contact forces on a point, divided by the point's weight.
constexpr double force_round_off = 1e-10;
/// Largest force on a point at the equilibrium, divided by the point's weight.
constexpr double force_tolerance = 1e-7;
/// Largest Newton step that may remain at the equilibrium [sigma].
constexpr double move_tolerance = 1e-7;
/// An accepted step leaves at most this fraction of the distance to the equilibrium.
constexpr double most_left = 0.75;
/// A correction keeps at least this fraction of the stiffness along a step. A contact that opens during the
/// step may reduce this stiffness to nearly zero, and the next step would then be far too long.
constexpr double least_part = 0.5;

double point_weight(const DropletState& state) {
  return units::droplet_mass * units::gravity / static_cast<double>(state.size());
}

MatrixXd symmetric(const MatrixXd& matrix) { return (matrix + matrix.transpose()) / 2; }

/// Whether x.Kx > bound x.x for all displacements x.
bool is_definite(double bound, const MatrixXd& k) {
  MatrixXd shifted = symmetric(k);
  shifted.diagonal().array() -= bound;
  return Eigen::LLT<MatrixXd>(shifted).info() == Eigen::Success;
}

/// Whether every displacement decays under drag, dx/dt = -Kx, faster than with stiffness `bound`. It is
/// sufficient that K - bound is positive definite, which is cheap to test. If the forces have an energy, K is
/// symmetric, and the condition is also necessary. Springs along the interface have no energy, and make K
/// slightly unsymmetric. Then K may be stable without being positive definite, so the function computes the
/// eigenvalues of K.
bool is_stable(double bound, const MatrixXd& k, bool has_energy) {
  if (is_definite(bound, k)) return true;
  return !has_energy && Eigen::EigenSolver<MatrixXd>(k, false).eigenvalues().real().minCoeff() > bound;
}

/// The stiffness K, minus the derivative of the force, in two parts. K_tt is the stiffness against
/// displacements of the points along the interface. The Schur complement K_nn - K_nt K_tt^-1 K_tn is the
/// stiffness of the shape while the points adapt along the interface. With points that cannot adapt, the mesh
/// would seem to hold a droplet that can in fact drift aside.
class Stiffness {
 public:
  explicit Stiffness(bool has_energy) : has_energy_(has_energy) {}

  /// Replaces K. Returns whether the points can adapt; otherwise no other member may be called.
  bool set(const MatrixXd& k, Index num_tangential) {
    const Index t = num_tangential, n = k.rows() - t;
    if (!is_definite(0, k.bottomRightCorner(t, t))) return false;
    normal_along_ = k.topRightCorner(n, t);
    corrections_.clear();
    along_.compute(k.bottomRightCorner(t, t));
    adapting_ = along_.solve(k.bottomLeftCorner(t, n));
    shape_ = k.topLeftCorner(n, n) - normal_along_ * adapting_;
    return true;
  }
  /// Whether the shape resists all displacements with a stiffness above `bound`. If not, solve() must not be
  /// called.
  bool resists(double bound) {
    assert(shape_.size() > 0);
    if (!is_stable(bound, shape_, has_energy_)) return false;
    shape_factor_.compute(shape_);
    return true;
  }
  /// Smallest stiffness of the shape. It is the slowest rate at which a displacement decays under drag. If
  /// some displacement grows, the result is minus the largest rate of growth.
  double smallest() const {
    assert(shape_.size() > 0);
    if (has_energy_)
      return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric(shape_), Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
    return Eigen::EigenSolver<MatrixXd>(shape_, false).eigenvalues().real().minCoeff();
  }
  /// The displacement x with K x = force.
  VectorXd solve(const VectorXd& force) const {
    const Index n = normal_along_.rows(), t = normal_along_.cols();
    const VectorXd along = along_.solve(force.tail(t));
    VectorXd move(n + t);
    move.head(n) = shape_factor_.solve(force.head(n) - normal_along_ * along);
    move.tail(t) = along - adapting_ * move.head(n);
    for (const Correction& correction : corrections_) correction.apply_to(move);
    return move;
  }

  /// Changes K by a matrix of rank one, so that solve() maps the change of force along `step` to `step`,
  /// within the limit least_part. A contact also changes K by a matrix of rank one, so a few corrections are
  /// enough. C. G. Broyden, Math. Comp. 19, 577 (1965); J. J. More and J. A. Trangenstein, Math. Comp. 30,
  /// 523 (1976).
  /// @param found  the displacement that solve() gave for this change of force before the correction
  void add_correction(const VectorXd& step, const VectorXd& found) {
    const double part_kept = step.dot(found) / step.squaredNorm();
    const double share = part_kept < least_part ? (1 - least_part) / (1 - part_kept) : 1;
    const VectorXd excess = share * (found - step);
    corrections_.push_back({step, excess / step.dot(step + excess)});
  }
  /// Updates a displacement that solve() gave before the last correction.
  void correct(VectorXd& move) const {
    assert(!corrections_.empty());
    corrections_.back().apply_to(move);
  }

 private:
  struct Correction {
    VectorXd step, excess;

    void apply_to(VectorXd& move) const { move -= step.dot(move) * excess; }
  };
  bool has_energy_;
  std::vector<Correction> corrections_;
  MatrixXd normal_along_, adapting_, shape_;
  Eigen::PartialPivLU<MatrixXd> along_, shape_factor_;
};

/// Forces and stiffness at states near a given state, along the axes of the given state.
class ForceField {
 public:
  ForceField(const EquilibriumForces& forces, DropletState state)
      : forces_(forces), state_(std::move(state)), force_(state_.position.size()), below_(force_) {}

  const DropletState& state() const { return state_; }
  void move_to(const ArrayXd& position) { state_.position = position; }

  /// After this call, the contact lists are valid for a stiffness() with this step.
  VectorXd force_at(const ArrayXd& position, const Axes& axes, double step = difference_step) {
    move_to(position);
    forces_.update_contacts(state_, {.absolute = 2 * step, .relative = 4 * step});
    forces_.evaluate(state_, force_);
    VectorXd force = axes.directions.transpose() * force_.matrix();
    auto along = force.tail(state_.size());
    if (axes.slide.size() > 0) along -= axes.slide * axes.slide.dot(along);
    return force;
  }

  /// The stiffness at the position of the last force_at(). The reference is valid until the next call.
  const MatrixXd& stiffness(const Axes& axes, double step = difference_step) {
    const ArrayXd middle = state_.position;
    stiffness_.resize(middle.size(), middle.size());
    for (Index k = 0; k < middle.size(); ++k) {
      const auto displace = [&](double distance) {
        for (SparseMatrix::InnerIterator entry(axes.directions, k); entry; ++entry)
          state_.position[entry.row()] = middle[entry.row()] + distance * entry.value();
      };
      displace(step);
      forces_.evaluate(state_, force_);
      displace(-step);
      forces_.evaluate(state_, below_);
      displace(0);
      stiffness_.col(k) = (below_ - force_) / (2 * step);
    }
    stiffness_ = axes.directions.transpose() * stiffness_;
    if (axes.slide.size() > 0) hold_slide(axes.slide, stiffness_);
    return stiffness_;
  }

 private:
  const EquilibriumForces& forces_;
  DropletState state_;
  ArrayXd force_, below_;
  MatrixXd stiffness_;

  static void hold_slide(const VectorXd& slide, MatrixXd& stiffness) {
    const Index n = slide.size();
    const double stiffest = stiffness.diagonal().tail(n).maxCoeff();
    stiffness.rightCols(n) -= (stiffness.rightCols(n) * slide).eval() * slide.transpose();
    stiffness.bottomRows(n) -= slide * (slide.transpose() * stiffness.bottomRows(n)).eval();
    stiffness.bottomRightCorner(n, n) += stiffest * slide * slide.transpose();
  }
};

/// Newton's method. A step is accepted if the next Newton step, computed with the same stiffness, is shorter
/// (P. Deuflhard's natural monotonicity test). A test of the forces would reject nearly every step, because
/// contacts that open or close dominate the forces. Computing a stiffness costs as much as 80 steps.
/// Therefore each step, accepted or not, only corrects the stiffness for the next step. The search recomputes
/// the stiffness if corrections do not help, and once more at the end, within difference_step of the
/// equilibrium. Steps with corrections may fail, or reach a place where some displacement meets no
/// resistance. The search then returns to the place of the last computed stiffness, and continues from there
/// with halved steps and without corrections.
class Search {
 public:
  Search(const EquilibriumForces& forces, const DropletState& initial)
      : forces_(forces),
        initial_(initial),
        point_weight_(point_weight(initial)),
        field_(forces, initial),
        stiffness_(forces.have_energy),
        position_(initial.position),
        begun_at_(initial.position) {}

  std::optional<DropletState> run() {
    for (int computed = 0; computed < most_stiffnesses; ++computed) {
      find_axes_and_force();
      const bool resists = stiffness_.set(field_.stiffness(axes_), axes_.num_tangential) &&
                           stiffness_.resists(least_stiffness * point_weight_);
      if (!resists && computed == 0) return std::nullopt;
      if (resists && approach()) {
        if (distance_from(begun_at_) < difference_step && rests_along_own_axes()) return state();
        continue;
      }
      if (halves_) return std::nullopt;
      halves_ = true;
      position_ = begun_at_;
    }
    return std::nullopt;
  }

 private:
  const EquilibriumForces& forces_;
  const DropletState& initial_;
  double point_weight_;
  ForceField field_;
  Stiffness stiffness_;
  bool halves_ = false;
  ArrayXd position_;
  ArrayXd begun_at_;  // place of the last computed stiffness that resists all displacements
  // The members from here on belong to the present position.
  Axes axes_;
  VectorXd force_;
  VectorXd move_;  // displacement to the equilibrium, according to the stiffness

  DropletState state() {
    field_.move_to(position_);
    return field_.state();
  }
  void find_axes_and_force() {
    axes_ = forces_.axes(state());
    force_ = field_.force_at(position_, axes_);
  }
  double distance_from(const ArrayXd& place) const { return (position_ - place).abs().maxCoeff(); }
  double longest() const { return move_.lpNorm<Eigen::Infinity>(); }
  double longest_part() const { return std::min(1.0, farthest_rest / longest()); }
  bool rests() const {
    return longest() < move_tolerance && force_.lpNorm<Eigen::Infinity>() < force_tolerance * point_weight_;
  }

  /// Whether the droplet is at rest. The test uses the axes of its present shape.
  bool rests_along_own_axes() {
    find_axes_and_force();
    move_ = stiffness_.solve(force_);
    return rests();
  }

  /// Moves by the fraction `part` of the step, if this leaves at most the fraction `share` of the distance to
  /// the equilibrium. Returns whether the droplet moved.
  bool tries(double part, double share) {
    const VectorXd step = part * move_;
    const ArrayXd place = position_ + (axes_.directions * step).array();
    VectorXd force_there = field_.force_at(place, axes_);
    VectorXd remaining_move = stiffness_.solve(force_there);
    if (!remaining_move.allFinite()) return false;
    const bool succeeds = remaining_move.norm() < share * move_.norm();
    if (!halves_) stiffness_.add_correction(step, move_ - remaining_move);
    if (succeeds) {
      position_ = place;
      force_ = std::move(force_there);
      move_ = std::move(remaining_move);
    }
    if (!halves_) stiffness_.correct(move_);
    return succeeds;
  }

  /// Takes steps with the stiffness of the present position. Returns true if the steps reduced the distance
  /// to the equilibrium or ended at rest, and the droplet is still within farthest_rest of the start.
  bool approach() {
    begun_at_ = position_;
    move_ = stiffness_.solve(force_);
    return (halves_ ? approach_by_halves() : approach_with_corrections()) &&
           distance_from(initial_.position) <= farthest_rest;
  }
  bool approach_with_corrections() {
    bool has_come_closer = false;
    int rejections = 0;
    for (int steps = 0; steps < most_steps && rejections < most_rejections; ++steps) {
      if (rests() && rests_along_own_axes()) return true;
      const bool succeeds = tries(longest_part(), most_left);
      rejections = succeeds ? 0 : rejections + 1;
      has_come_closer = has_come_closer || succeeds;
    }
    return has_come_closer;
  }
  bool approach_by_halves() {
    if (rests()) return true;
    double part = longest_part();
    for (int halving = 0; !tries(part, 1 - part / 4); ++halving, part /= 2)
      if (halving == most_halvings) return false;
    while (!rests() && tries(1, most_left)) {
    }
    return true;
  }
};

}  // namespace

std::optional<DropletState> find_equilibrium(const EquilibriumForces& forces, const DropletState& initial) {
  return Search(forces, initial).run();
}

Stability stability_of(const EquilibriumForces& forces, const DropletState& stopped) {
  ForceField field(forces, stopped);
  const Axes axes = forces.axes(stopped);
  Stiffness stiffness(forces.have_energy);
  const auto smallest_with = [&](double step) -> std::optional<double> {
    field.force_at(stopped.position, axes, step);
    if (!stiffness.set(field.stiffness(axes, step), axes.num_tangential)) return std::nullopt;
    return stiffness.smallest();
  };
  const std::optional<double> once = smallest_with(difference_step);
  const std::optional<double> twice = smallest_with(2 * difference_step);
  if (!once || !twice) return Stability::unknown;
  const double error = std::abs(*once - *twice) + force_round_off * point_weight(stopped) / difference_step;
  if (*once < -error) return Stability::unstable;
  return *once > error ? Stability::stable : Stability::unknown;
}

}  // namespace clog
