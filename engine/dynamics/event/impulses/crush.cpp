#include "engine/dynamics/event/impulses/crush.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/impulses/impact_system.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/lcp/least/solution_cell.hpp"
#include "engine/math/lu.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace tumble {
namespace {

/// Projection on the cone |lateral| <= friction * axial, and its derivative.
Vec3 project_on_cone(const Vec3& x, double friction, Mat3& slope) {
  lcp::SolutionCell cone;
  cone.kind = friction > 0 ? lcp::SolutionCell::disc : lcp::SolutionCell::ray;
  cone.slope = friction;
  lcp::SolutionCell::Matrix jacobian;
  const auto point = cone.project({x[0], x[1], x[2]}, jacobian);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) slope(i, k) = jacobian[size_t(i)][size_t(k)];
  return {point[0], point[1], point[2]};
}

/// Finds the velocities u + A y nearest to the dual cones, scaled so that points have equal
/// mobility.
class NearestApproach {
 public:
  NearestApproach(const ImpactSystem& system, bool friction)
      : system_(system), friction_(friction), size_(3 * system.points()) {
    scale_.resize(size_), u_.resize(size_);
    for (int i = 0; i < system.points(); ++i) {
      const double answer = system.mobility(i).diagonal().maxCoeff();
      scale_.segment<3>(3 * i).setConstant(answer > 0 ? 1 / std::sqrt(answer) : 0);
      u_.segment<3>(3 * i) = scale_[3 * i] * dense(system.velocity(i));
    }
    std::vector<Eigen::Index> all(static_cast<size_t>(size_));
    std::iota(all.begin(), all.end(), 0);
    A_ = scale_.asDiagonal() * system.mobility().dense(all) * scale_.asDiagonal();
    start_ = u_;
  }

  /// The impulses of the proof in the units of the system; empty if there is no proof.
  Eigen::VectorXd proof();

 private:
  double friction(int i) const { return friction_ ? system_.point(i).friction : 0; }
  /// The distance vector z of u to the dual cones; returns half its square.
  double missing(const Eigen::VectorXd& u, Eigen::VectorXd& z) const {
    Mat3 slope;
    z.resize(size_);
    for (int i = 0; i < system_.points(); ++i)
      z.segment<3>(3 * i) =
          dense(project_on_cone(-small_vector(u.segment<3>(3 * i)), friction(i), slope));
    return 0.5 * z.squaredNorm();
  }
  bool improve();

  const ImpactSystem& system_;
  bool friction_;
  Eigen::Index size_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd scale_, start_, u_, z_;
};

/// One damped step of Newton's method; false if it gives no improvement.
bool NearestApproach::improve() {
  const double before = missing(u_, z_);
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(size_, size_);
  Mat3 slope;
  for (int i = 0; i < system_.points(); ++i) {
    project_on_cone(-small_vector(u_.segment<3>(3 * i)), friction(i), slope);
    step.middleRows<3>(3 * i) = dense(slope) * A_.middleRows<3>(3 * i);
  }
  step.diagonal().array() += tolerances::proof_yield;
  LuFactor factor;
  if (!factor.factor({step.data(), step.data() + step.size()}, int(size_), 0)) return false;
  Eigen::VectorXd y = z_, z;
  factor.solve(y.data());
  const Eigen::VectorXd change = A_ * y;
  for (double share = 1; share > tolerances::least_proof_step; share *= 0.5) {
    const Eigen::VectorXd u = u_ + share * change;
    if (!(missing(u, z) < before * (1 - tolerances::proof_gain * share))) continue;
    u_ = u;
    return true;
  }
  return false;
}

Eigen::VectorXd NearestApproach::proof() {
  for (int k = 0; k < tolerances::most_proof_steps && !stop_requested() && improve(); ++k) {
  }
  missing(u_, z_);
  const double fastest = start_.cwiseAbs().maxCoeff(), greatest = z_.cwiseAbs().maxCoeff();
  const bool cancel = (A_ * z_).cwiseAbs().maxCoeff() < tolerances::cancelled_share * greatest;
  if (!(greatest > tolerances::no_approach_of_fastest * fastest && cancel && -z_.dot(start_) > 0))
    return {};
  return scale_.cwiseProduct(z_);
}

/// Whether there is motion that no impulse changes: kinematic bodies, belts, motors of unlimited
/// force. Otherwise impulses z that cancel on all bodies, J^T z = 0, do no work, z^T J v = 0, and
/// prove nothing.
bool moves_by_itself(std::span<const DofBlock> blocks, std::span<const ImpactPoint> points,
                     const Articulation& joints) {
  const auto kinematic = [](const DofBlock& b) {
    return b.inverse_mass == 0 && !(b.v.isZero(0) && b.omega.isZero(0));
  };
  const auto belt = [](const ImpactPoint& p) { return !p.surface_velocity.isZero(0); };
  const auto motor = [](const HeldRow& r) { return r.use == RowUse::motor; };
  return std::ranges::any_of(blocks, kinematic) || std::ranges::any_of(points, belt) ||
         std::ranges::any_of(joints.held(), motor);
}

}  // namespace

std::optional<Crush> find_crush(std::span<const DofBlock> blocks,
                                std::span<const ImpactPoint> points, const Articulation& joints) {
  if (points.empty() || !moves_by_itself(blocks, points, joints)) return {};
  // The work of factorising the matrix.
  const auto n = uint64_t(3 * points.size());
  if (!may_begin_work(n * n * n / 3)) return {};
  const ImpactSystem system(blocks, points, joints);
  if (!system.finite()) return {};
  Crush out;
  Eigen::VectorXd impulses = NearestApproach(system, false).proof();
  if (impulses.size() == 0) {
    out.by_friction = true;
    impulses = NearestApproach(system, true).proof();
  }
  if (impulses.size() == 0) return {};
  double work = 0, greatest = 0;
  for (int i = 0; i < system.points(); ++i) {
    const Vec3 impulse = small_vector(impulses.segment<3>(3 * i));
    work -= impulse.dot(system.velocity(i));
    greatest = std::max(greatest, impulse.norm());
  }
  out.speed = work / greatest;
  for (int i = 0; i < system.points(); ++i)
    out.shares.push_back(impulses.segment<3>(3 * i).norm() / greatest);
  return out;
}

}  // namespace tumble
