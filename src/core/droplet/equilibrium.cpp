#include "clog/core/droplet/equilibrium.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "clog/core/tools/units.hpp"

namespace clog {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// Most searches end within ten.
constexpr int most_iterations = 30;
constexpr int most_halvings = 10;
/// Step of the central differences [sigma]: far below a contact's range, far above round-off.
constexpr double difference_step = 1e-6;
/// Force on a point over its weight; round-off of the contact forces is 1e-10.
constexpr double force_tolerance = 1e-7;
/// Remaining Newton step [sigma].
constexpr double move_tolerance = 1e-7;
/// What a step with a stiffness leaves of the way at most if the next one takes the same stiffness.
constexpr double quick = 0.75;

MatrixXd symmetric(const MatrixXd& matrix) { return (matrix + matrix.transpose()) / 2; }

/// Do all displacements x have x.Kx > bound x.x?
bool is_definite(double bound, const MatrixXd& k) {
  MatrixXd shifted = symmetric(k);
  shifted.diagonal().array() -= bound;
  return Eigen::LLT<MatrixXd>(shifted).info() == Eigen::Success;
}

/// Does every displacement decay under drag, dx/dt = -Kx, faster than with stiffness `bound`? True if K -
/// bound is positive definite, which is cheaper to test; if the forces have an energy, K is symmetric and
/// this is also necessary. Springs along the interface have no energy: they make K slightly unsymmetric, and
/// a soft K may be stable without being definite.
bool is_stable(double bound, const MatrixXd& k, bool has_energy) {
  if (is_definite(bound, k)) return true;
  return !has_energy && Eigen::EigenSolver<MatrixXd>(k, false).eigenvalues().real().minCoeff() > bound;
}

/// The stiffness K, which is minus the derivative of the force, in two parts: K_tt of the vertices along the
/// interface, and the Schur complement K_nn - K_nt K_tt^-1 K_tn, the stiffness of the shape when the vertices
/// along it adapt at once. With vertices held in place, a droplet that is free to drift aside would seem to
/// be held by its own discretisation.
class Stiffness {
 public:
  explicit Stiffness(bool has_energy) : has_energy_(has_energy) {}

  /// Replaces K. Returns whether it resists all displacements by more than `bound`, and lets the vertices
  /// find their places; otherwise nothing can be solved.
  bool set(const MatrixXd& k, double bound) {
    const Index n = k.rows() / 2;
    if (!is_definite(0, k.bottomRightCorner(n, n))) return false;
    normal_along_ = k.topRightCorner(n, n);
    along_.compute(k.bottomRightCorner(n, n));
    adapting_ = along_.solve(k.bottomLeftCorner(n, n));
    shape_ = k.topLeftCorner(n, n) - normal_along_ * adapting_;
    if (!is_stable(bound, shape_, has_energy_)) return false;
    shape_factor_.compute(shape_);
    return true;
  }
  VectorXd solve(const VectorXd& force) const {
    const Index n = force.size() / 2;
    const VectorXd along = along_.solve(force.tail(n));
    VectorXd move(2 * n);
    move.head(n) = shape_factor_.solve(force.head(n) - normal_along_ * along);
    move.tail(n) = along - adapting_ * move.head(n);
    return move;
  }

 private:
  bool has_energy_;
  MatrixXd normal_along_, adapting_, shape_;
  Eigen::PartialPivLU<MatrixXd> along_, shape_factor_;
};

/// Forces along given axes, around a state that moves.
class ForceField {
 public:
  ForceField(const EquilibriumForces& forces, DropletState state)
      : forces_(forces), state_(std::move(state)), force_(state_.position.size()), below_(force_) {}

  const DropletState& state() const { return state_; }
  void move_to(const ArrayXd& position) { state_.position = position; }

  VectorXd force_at(const ArrayXd& position, const Axes& axes) {
    move_to(position);
    forces_.update_contacts(state_, {.absolute = 2 * difference_step, .relative = 4 * difference_step});
    forces_.evaluate(state_, force_);
    VectorXd force = axes.directions.transpose() * force_.matrix();
    auto along = force.tail(state_.size());
    if (axes.slide.size() > 0) along -= axes.slide * axes.slide.dot(along);
    return force;
  }

  /// At the place of the last force_at(). Valid until the next call.
  const MatrixXd& stiffness(const Axes& axes) {
    const ArrayXd middle = state_.position;
    stiffness_.resize(middle.size(), middle.size());
    for (Index k = 0; k < middle.size(); ++k) {
      const auto evaluate_at = [&](double distance, ArrayXd& force) {
        state_.position = middle;
        for (SparseMatrix::InnerIterator entry(axes.directions, k); entry; ++entry)
          state_.position[entry.row()] += distance * entry.value();
        forces_.evaluate(state_, force);
      };
      evaluate_at(difference_step, force_);
      evaluate_at(-difference_step, below_);
      stiffness_.col(k) = axes.directions.transpose() * ((below_ - force_) / (2 * difference_step)).matrix();
    }
    state_.position = middle;
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

}  // namespace

/// Newton's method with step halving: a step is accepted if it shortens the remaining Newton step, computed
/// with the present stiffness (P. Deuflhard's natural monotonicity test). A test on forces would reject
/// nearly every step, because contacts that open or close dominate them. Further steps with the same
/// stiffness are taken as long as each leaves little of the way; that of the rest is computed within
/// move_tolerance of it.
std::optional<DropletState> find_equilibrium(const EquilibriumForces& forces, const DropletState& initial) {
  const double point_weight = units::droplet_mass * units::gravity / static_cast<double>(initial.size());
  ForceField field(forces, initial);
  Stiffness stiffness(forces.have_energy);
  ArrayXd position = initial.position;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    field.move_to(position);  // the last step tried may have been too long
    const Axes axes = forces.axes(field.state());
    VectorXd force = field.force_at(position, axes);
    if (!stiffness.set(field.stiffness(axes), least_stiffness * point_weight)) return std::nullopt;
    VectorXd move = stiffness.solve(force);
    const auto longest = [&] { return move.lpNorm<Eigen::Infinity>(); };
    const auto rests = [&] {
      return longest() < move_tolerance && force.lpNorm<Eigen::Infinity>() < force_tolerance * point_weight;
    };
    if (rests()) return field.state();
    const bool is_stiffness_of_rest = longest() < move_tolerance;

    double part = std::min(1.0, farthest_rest / longest());
    const auto leaves_at_most = [&](double share) {
      const ArrayXd place = position + part * (axes.directions * move).array();
      VectorXd force_there = field.force_at(place, axes);
      VectorXd way_left = stiffness.solve(force_there);
      if (!(way_left.norm() < share * move.norm())) return false;
      position = place;
      force = std::move(force_there);
      move = std::move(way_left);
      return true;
    };
    for (int halving = 0; !leaves_at_most(1 - part / 4); ++halving, part /= 2)
      if (halving == most_halvings) return std::nullopt;
    part = 1;
    while (!rests() && leaves_at_most(quick)) {
    }
    if ((position - initial.position).abs().maxCoeff() > farthest_rest) return std::nullopt;
    if (is_stiffness_of_rest && rests()) return field.state();
  }
  return std::nullopt;
}

}  // namespace clog
