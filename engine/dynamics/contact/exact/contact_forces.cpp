#include "engine/dynamics/contact/exact/contact_forces.hpp"

#include "engine/math/lcp/cone_newton.hpp"
#include "engine/math/lcp/dantzig.hpp"
#include "engine/math/rotation.hpp"

#include <array>
#include <limits>

namespace tumble {
namespace {

/// Residual that points which depend on each other may leave where the solver aims at less.
constexpr double believable = 1e-6;
constexpr double unbounded_force = std::numeric_limits<double>::infinity();

/// The unknowns of one point: the normal force, and where there is friction two tangential ones.
struct PointRows {
  int first = 0;
  int count = 1;
  std::array<Vec3, 3> axes;
};

struct ForceProblem {
  lcp::LcpProblem lcp;
  std::vector<Row> rows;
  std::vector<PointRows> points;
};

void add_point(ForceProblem& problem, const ForcePoint& p, std::span<const DofBlock> free,
               std::vector<double>& b) {
  PointRows rows;
  rows.first = int(problem.rows.size());
  rows.count = p.friction > 0 ? 3 : 1;
  rows.axes[0] = p.normal;
  tangent_frame(p.normal, rows.axes[1], rows.axes[2]);
  for (int k = 0; k < rows.count; ++k) {
    const Vec3& axis = rows.axes[size_t(k)];
    problem.rows.push_back(point_row(p.a, p.arm_a, p.b, p.arm_b, axis));
    b.push_back(row_velocity(problem.rows.back(), free) +
                (k == 0 ? p.bias : axis.dot(p.tangential_bias)));
  }
  if (rows.count == 3) {
    lcp::ConeGroup& group = problem.lcp.groups.emplace_back();
    group.axial = rows.first;
    group.lateral = {rows.first + 1, rows.first + 2};
    group.slope = p.friction;
    if (p.sliding) {
      const Vec2 slip = Vec2(rows.axes[1].dot(p.slip), rows.axes[2].dot(p.slip)).normalized();
      group.mode = lcp::ConeMode::sliding;
      group.direction = {slip.x(), slip.y()};
    }
  }
  problem.points.push_back(rows);
}

/// From the last forces, which mostly need no change; where these lead nowhere, from none.
Result<lcp::LcpSolution> solve_problem(const lcp::LcpProblem& problem, const lcp::VecX& z) {
  if (problem.groups.empty()) return lcp::dantzig(problem);
  lcp::LcpOptions sharp;
  sharp.tolerance = 1e-12;
  Result<lcp::LcpSolution> solved = lcp::cone_newton_from(problem, sharp, z);
  if (!solved || !solved->report.solved()) solved = lcp::cone_newton(problem);
  return solved;
}

}  // namespace

ContactForceReport solve_contact_forces(std::span<DofBlock> accelerations,
                                        std::span<const ForcePoint> points,
                                        std::vector<Vec3>& forces) {
  ContactForceReport report;
  const bool start = forces.size() == points.size();
  forces.resize(points.size(), Vec3::Zero());
  if (points.empty()) return report;
  ForceProblem problem;
  std::vector<double> b;
  for (const ForcePoint& p : points) add_point(problem, p, accelerations, b);
  const auto n = Eigen::Index(b.size());
  problem.lcp.A = delassus(problem.rows, accelerations);
  problem.lcp.b = Eigen::Map<const lcp::VecX>(b.data(), n);
  problem.lcp.lower = lcp::VecX::Constant(n, -unbounded_force);
  problem.lcp.upper = lcp::VecX::Constant(n, unbounded_force);
  lcp::VecX z = lcp::VecX::Zero(n);
  for (size_t i = 0; i < points.size(); ++i) {
    const PointRows& rows = problem.points[i];
    problem.lcp.lower[rows.first] = 0;
    if (!start) continue;
    for (int k = 0; k < rows.count; ++k) z[rows.first + k] = rows.axes[size_t(k)].dot(forces[i]);
  }
  const Result<lcp::LcpSolution> solved = solve_problem(problem.lcp, z);
  if (!solved || (!solved->report.solved() && !(solved->report.residual <= believable))) {
    report.solved = false;
    return report;
  }
  report.iterations = solved->report.iterations;
  report.residual = solved->report.residual;
  report.solver = solved->report.solver;
  for (size_t i = 0; i < points.size(); ++i) {
    const PointRows& rows = problem.points[i];
    forces[i].setZero();
    for (int k = 0; k < rows.count; ++k)
      forces[i] += solved->z[rows.first + k] * rows.axes[size_t(k)];
  }
  for (Eigen::Index r = 0; r < n; ++r)
    apply_row(problem.rows[size_t(r)], solved->z[r], accelerations);
  return report;
}

}  // namespace tumble
