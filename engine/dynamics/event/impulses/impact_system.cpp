#include "engine/dynamics/event/impulses/impact_system.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/rows/block_rows.hpp"
#include "engine/dynamics/rows/delassus.hpp"
#include "engine/math/lcp/cones/solve_cones.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

double in_order(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

ImpactSystem::ImpactSystem(std::span<const DofBlock> blocks, std::span<const ImpactPoint> points,
                           const Articulation& joints)
    : blocks_(blocks), points_(points), joints_(&joints) {
  const auto n = Eigen::Index(3 * points.size());
  u0_.resize(n);
  z_ = Eigen::VectorXd::Zero(n);
  for (const ImpactPoint& p : points) {
    if (p.along) {
      add_limit(*p.along);
      continue;
    }
    std::array<Vec3, 3> frame{p.normal, Vec3::Zero(), Vec3::Zero()};
    tangent_frame(p.normal, frame[1], frame[2]);
    for (size_t k = 0; k < frame.size(); ++k) {
      rows_.push_back(point_row(p.a, p.arm_a, p.b, p.arm_b, frame[k]));
      // A belt moves along its surface; its velocity has no normal component.
      const double belt = k == 0 ? 0 : frame[k].dot(p.surface_velocity);
      u0_[Eigen::Index(rows_.size()) - 1] = row_velocity(rows_.back(), blocks) - belt;
    }
    frames_.push_back(frame);
  }
  A_ = PointMobility(rows_, blocks, joints);
  u_ = u0_;
  for (Eigen::Index i = 0; i < n; ++i) first_speed_ = std::max(first_speed_, std::fabs(u_[i]));
}

/// Appends the row of a limit, with two empty rows in place of tangents.
void ImpactSystem::add_limit(const Row& along) {
  u0_[Eigen::Index(rows_.size())] = row_velocity(along, blocks_);
  for (const Eigen::Index lateral : {1, 2}) u0_[Eigen::Index(rows_.size()) + lateral] = 0;
  rows_.insert(rows_.end(), {along, Row{}, Row{}});
  frames_.push_back({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
}

bool ImpactSystem::finite() const {
  for (Eigen::Index i = 0; i < u_.size(); ++i) {
    if (!std::isfinite(u_[i])) return false;
  }
  for (int i = 0; i < points(); ++i) {
    const Mat3& own = mobility(i);
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(own(k, k))) return false;
  }
  return true;
}

void ImpactSystem::add(int i, const Vec3& impulse) {
  for (int k = 0; k < 3; ++k) z_[3 * i + k] += impulse[k];
  A_.add_product(i, impulse, u_);
}

void ImpactSystem::add(const Eigen::VectorXd& impulse) {
  for (Eigen::Index i = 0; i < z_.size(); ++i) z_[i] += impulse[i];
  A_.add_product(impulse, u_);
}

/// A complementarity problem: the indices of its unknowns in the system, and how it is solved.
struct ImpactSystem::Unknowns {
  std::vector<Eigen::Index> rows;
  lcp::ConeTask task;
};

/// Sets up the problem of the points in `active`, except for its matrix.
void ImpactSystem::set_conditions(std::span<const int> active, const Eigen::VectorXd& target,
                                  Unknowns& out) const {
  lcp::LcpProblem& problem = out.task.problem;
  for (const int i : active) {
    const auto first = int(out.rows.size());
    out.rows.push_back(3 * i);
    if (!(point(i).friction > 0)) continue;
    out.rows.push_back(3 * i + 1);
    out.rows.push_back(3 * i + 2);
    problem.add_group(first, point(i).friction);
  }
  const auto n = Eigen::Index(out.rows.size());
  problem.b.resize(n);
  problem.lower.resize(n);
  problem.upper = lcp::VecX::Constant(n, unbounded);
  for (Eigen::Index r = 0; r < n; ++r) {
    const Eigen::Index i = out.rows[size_t(r)];
    const bool normal = i % 3 == 0;
    problem.b[r] = u_[i] - (normal ? target[i / 3] : 0);
    problem.lower[r] = normal ? 0 : -unbounded;
  }
}

/// Appends the rows of joints as equations: the velocities satisfy the joints, and must continue
/// to.
void ImpactSystem::add_joint_rows(std::vector<Row>& rows, lcp::LcpProblem& problem) const {
  const auto n = Eigen::Index(rows.size()), m = Eigen::Index(joints_->size());
  for (const JointRow& r : joints_->rows()) rows.push_back(r.row);
  const auto extend = [&](lcp::VecX& v, double value) {
    lcp::VecX longer = lcp::VecX::Constant(n + m, value);
    longer.head(n) = v;
    v.swap(longer);
  };
  extend(problem.b, 0);
  extend(problem.lower, -unbounded);
  extend(problem.upper, unbounded);
}

/// Sets the matrix, and for many unknowns, where it would be expensive, the rows in blocks.
void ImpactSystem::set_matrices(Unknowns& unknowns) const {
  lcp::ConeTask& task = unknowns.task;
  task.matrix = [this, &unknowns] { return A_.dense(unknowns.rows); };
  if (task.few()) return;
  task.tolerance = tolerances::impulse_residual_of_many;
  if (!joints_->plain()) return;
  std::vector<Row> rows;
  for (const Eigen::Index i : unknowns.rows) rows.push_back(rows_[size_t(i)]);
  if (!joints_->empty()) add_joint_rows(rows, task.problem);
  task.blocks = block_problem(rows, blocks_, task.problem);
  if (joints_->empty()) return;
  task.matrix = [this, rows] { return delassus(rows, blocks_); };
}

bool ImpactSystem::solve(std::span<const int> active, const Eigen::VectorXd& target,
                         Eigen::VectorXd& impulse, ImpactReport& report) const {
  Unknowns unknowns;
  set_conditions(active, target, unknowns);
  set_matrices(unknowns);
  lcp::ConeAnswer answer = lcp::solve_cones(unknowns.task);
  ++report.rounds;
  report.attempts = std::move(answer.attempts);
  impulse = Eigen::VectorXd::Zero(u_.size());
  if (!answer.found) {
    report.status = ImpactStatus::unsolved;
    return false;
  }
  const lcp::LcpSolution& solved = answer.solution;
  report.solver = solved.report.solver;
  report.residual = std::max(report.residual, solved.report.residual);
  for (size_t r = 0; r < unknowns.rows.size(); ++r)
    impulse[unknowns.rows[r]] = solved.z[Eigen::Index(r)];
  return true;
}

bool ImpactSystem::rebound(std::span<const int> active, Eigen::VectorXd& impulse,
                           ImpactReport& report) const {
  Eigen::VectorXd target = Eigen::VectorXd::Zero(points());
  for (const int i : active)
    if (approaching(i)) target[i] = -point(i).restitution * normal_velocity(i);
  if (!solve(active, target, impulse, report)) return false;
  if (!(work(impulse) > 0)) return true;
  // Restitution of velocities with friction can create energy (Kane & Levinson 1985).
  Eigen::VectorXd plastic;
  if (!solve(active, Eigen::VectorXd::Zero(points()), plastic, report)) return false;
  const Eigen::VectorXd more = impulse - plastic;
  impulse = plastic + harmless_share(plastic, more, report) * more;
  return true;
}

double ImpactSystem::harmless_share(const Eigen::VectorXd& first, const Eigen::VectorXd& more,
                                    ImpactReport& report) const {
  // The work along the way is a convex quadratic, a s^2 + b s + c, with c <= 0.
  Eigen::VectorXd response = Eigen::VectorXd::Zero(u_.size()), start = u_;
  A_.add_product(more, response);
  A_.add_product(first, start);
  const double c = std::min(0.0, work(first)), b = in_order(more, start),
               a = 0.5 * in_order(more, response);
  if (a + b + c <= 0) return 1;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  double share = 0;
  if (b > 0)
    share = -2 * c / (b + root);
  else if (a > 0)
    share = (root - b) / (2 * a);
  share = std::clamp(share, 0.0, 1.0);
  // Rounding error is not reported.
  if (share < 1 - tolerances::scale_rounding)
    report.restitution_scale = std::min(report.restitution_scale, share);
  return share;
}

void ImpactSystem::add_friction(Eigen::VectorXd& impulse, ImpactReport& report) const {
  Eigen::VectorXd u = u_;
  A_.add_product(impulse, u);
  double change = 0, speed = first_speed_;
  for (int sweep = 0; sweep < tolerances::most_sweeps && !stop_requested(); ++sweep) {
    change = 0;
    charge_work(A_.size(), 12);
    for (int i = 0; i < points(); ++i) {
      const double radius = point(i).friction * impulse[3 * i];
      if (!(radius > 0)) continue;
      const Eigen::Index j = 3 * i + 1;
      const Mat3& own = mobility(i);
      const double stiffest = own(1, 1) + own(2, 2);  // trace: no less than the greater eigenvalue
      if (!(stiffest > 0)) continue;
      const Vec2 old(impulse[j], impulse[j + 1]);
      Vec2 t = old - Vec2(u[j], u[j + 1]) / stiffest;
      if (t.norm() > radius) t *= radius / t.norm();
      const Vec2 step = t - old;
      change = std::max(change, stiffest * step.norm());
      impulse[j] = t.x(), impulse[j + 1] = t.y();
      A_.for_column(i, [&](int row, const Mat3& block) {
        for (int r = 0; r < 3; ++r)
          u[3 * row + r] += block(r, 1) * step.x() + block(r, 2) * step.y();
      });
    }
    if (change <= tolerances::sweep_change * speed) return;
  }
  report.residual = std::max(report.residual, change / speed);
}

double ImpactSystem::work(const Eigen::VectorXd& impulse) const {
  Eigen::VectorXd twice = 2 * u_;
  A_.add_product(impulse, twice);
  return 0.5 * in_order(impulse, twice);
}

void ImpactSystem::finish(std::span<DofBlock> blocks, ImpactReport& report) const {
  report.work = 0.5 * in_order(z_, u0_ + u_);
  for (size_t r = 0; r < rows_.size(); ++r) apply_row(rows_[r], z_[Eigen::Index(r)], blocks);
  if (!joints_->empty()) {
    report.joint_impulses.assign(joints_->rows().size(), 0.0);
    joints_->hold_velocities(blocks, report.joint_impulses);
  }
  for (size_t i = 0; i < frames_.size(); ++i) {
    const auto world = [&](const Eigen::VectorXd& in) {
      const auto j = Eigen::Index(3 * i);
      return Vec3(in[j] * frames_[i][0] + in[j + 1] * frames_[i][1] + in[j + 2] * frames_[i][2]);
    };
    report.impulses.push_back(world(z_));
    report.velocity_before.push_back(world(u0_));
    report.velocity_after.push_back(world(u_));
  }
}

}  // namespace tumble
