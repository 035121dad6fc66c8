#include "engine/dynamics/event/contact_forces.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/text.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/rows/block_rows.hpp"
#include "engine/dynamics/rows/delassus.hpp"
#include "engine/math/lcp/cones/solve_cones.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace tumble {
namespace {

constexpr double unbounded_force = std::numeric_limits<double>::infinity();

/// The unknowns of one point: the normal force, and with friction two tangential ones.
struct PointRows {
  int first = 0;
  int count = 1;
  std::array<Vec3, 3> axes;
};

/// The unknowns of rolling or torsional friction: first the bound of the torque, which an equation
/// of its own sets to the lever arm times the normal forces and which acts on nothing; then the
/// torques about two axes. Torsional friction has only one axis, the other is zero.
struct TurningRows {
  int first = 0;
  std::array<Vec3, 2> axes;
  double arm = 0;
  std::span<const uint32_t> points;
};

struct ForceProblem {
  lcp::ConeTask task;
  std::vector<Row> rows;
  std::vector<PointRows> points;
  std::vector<TurningRows> turning;
};

void add_point(ForceProblem& problem, const ForcePoint& p, lcp::ConeShape cone,
               std::span<const DofBlock> free, std::vector<double>& b) {
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
    lcp::ConeGroup& group = problem.task.problem.add_group(rows.first, p.friction);
    group.shape = cone;
    if (p.sliding) {
      const Vec2 slip = Vec2(rows.axes[1].dot(p.slip), rows.axes[2].dot(p.slip)).normalized();
      group.mode = lcp::ConeMode::sliding;
      group.direction = {slip.x(), slip.y()};
    }
  }
  problem.points.push_back(rows);
}

/// Appends a group of TurningRows with these axes; `turning` is along the present turning, zero if
/// it is held at zero.
void add_turning(ForceProblem& problem, const TurningPoint& p, double arm,
                 const std::array<Vec3, 2>& axes, const Vec3& turning,
                 std::span<const DofBlock> free, std::vector<double>& b) {
  if (!(arm > 0)) return;
  const int first = int(problem.rows.size());
  problem.turning.push_back({first, axes, arm, std::span(p.points).first(p.count)});
  problem.rows.emplace_back();
  b.push_back(0);
  for (const Vec3& axis : axes) {
    problem.rows.push_back(axis.isZero(0) ? Row{} : turning_row(p, axis));
    b.push_back(row_velocity(problem.rows.back(), free) + axis.dot(p.bias));
  }
  lcp::ConeGroup& group = problem.task.problem.add_group(first, 1);
  if (turning.isZero(0)) return;
  group.mode = lcp::ConeMode::sliding;
  const Vec2 direction = Vec2(axes[0].dot(turning), axes[1].dot(turning)).normalized();
  group.direction = {direction.x(), direction.y()};
}

void add_turning(ForceProblem& problem, const TurningPoint& p, std::span<const DofBlock> free,
                 std::vector<double>& b) {
  std::array<Vec3, 2> across;
  tangent_frame(p.normal, across[0], across[1]);
  add_turning(problem, p, p.rolling, across, p.ahead ? Vec3(Vec3::Zero()) : p.axis, free, b);
  add_turning(problem, p, p.torsional, {p.normal, Vec3::Zero()}, p.spin * p.normal, free, b);
}

/// Sets the entries of the matrix for turning that the bodies do not give: the equations of bounds,
/// and those of axes that do not exist; scaled to the diagonal entries of the torques.
void complete_turning(const ForceProblem& problem, lcp::MatX& A) {
  for (const TurningRows& t : problem.turning) {
    const Eigen::Index at = t.first;
    const double unit = std::max(A(at + 1, at + 1), A(at + 2, at + 2));
    A(at, at) = unit;
    for (const uint32_t k : t.points) A(at, problem.points[k].first) = -unit * t.arm;
    if (t.axes[1].isZero(0)) A(at + 2, at + 2) = unit;
  }
}

/// The torque that was found.
Vec3 torque_of(const TurningRows& t, const lcp::VecX& z) {
  return z[t.first + 1] * t.axes[0] + z[t.first + 2] * t.axes[1];
}

void start_turning(const ForceProblem& problem, std::span<const TurningPoint> turning,
                   lcp::VecX& start) {
  size_t at = 0;
  for (const TurningPoint& p : turning)
    for (const double arm : {p.rolling, p.torsional}) {
      if (!(arm > 0)) continue;
      const TurningRows& t = problem.turning[at++];
      start[t.first] = 0;
      for (const uint32_t k : t.points) start[t.first] += arm * start[problem.points[k].first];
      for (int k = 0; k < 2; ++k) start[t.first + 1 + k] = t.axes[size_t(k)].dot(p.torque);
    }
}

void take_turning(const ForceProblem& problem, const lcp::VecX& z,
                  std::span<TurningPoint> turning) {
  size_t at = 0;
  for (TurningPoint& p : turning) {
    p.torque.setZero();
    for (const double arm : {p.rolling, p.torsional})
      if (arm > 0) p.torque += torque_of(problem.turning[at++], z);
  }
}

/// Appends the rows with bounds, behind those of points and turning.
void add_bounded(ForceProblem& problem, std::span<const BoundedRow> rows,
                 std::span<const DofBlock> free, std::vector<double>& b) {
  for (const BoundedRow& r : rows) {
    problem.rows.push_back(r.row);
    b.push_back(row_velocity(r.row, free) + r.bias);
  }
}

/// Whether the rows of joints are unknowns too, behind all others, so that the problem couples
/// bodies only and stays sparse. Otherwise the matrix is reduced by the joints.
bool takes_joint_rows(const ForceProblem& problem, const ContactForceMethod& method,
                      const Articulation& joints) {
  return !method.solver && !method.least && joints.plain() &&
         problem.rows.size() >= size_t(lcp::ConeTask::many_unknowns);
}

/// Appends the rows of joints as equations: the given accelerations satisfy the joints, and must
/// continue to.
void add_joint_rows(ForceProblem& problem, const Articulation& joints) {
  lcp::ConeTask& task = problem.task;
  const auto n = Eigen::Index(problem.rows.size()), m = Eigen::Index(joints.size());
  for (const JointRow& r : joints.rows()) problem.rows.push_back(r.row);
  const auto extend = [&](lcp::VecX& v, double value) {
    lcp::VecX longer = lcp::VecX::Constant(n + m, value);
    longer.head(n) = v;
    v.swap(longer);
  };
  extend(task.problem.b, 0);
  extend(task.problem.lower, -unbounded_force);
  extend(task.problem.upper, unbounded_force);
  extend(task.start, 0);
}

/// Sets b and bounds, and the last forces as a first guess if there are any.
void set_conditions(ForceProblem& problem, const std::vector<double>& b,
                    std::span<const Vec3> forces, std::span<const BoundedRow> rows,
                    std::span<const TurningPoint> turning) {
  lcp::ConeTask& task = problem.task;
  const auto n = Eigen::Index(b.size());
  task.problem.b = Eigen::Map<const lcp::VecX>(b.data(), n);
  task.problem.lower = lcp::VecX::Constant(n, -unbounded_force);
  task.problem.upper = lcp::VecX::Constant(n, unbounded_force);
  task.start = lcp::VecX::Zero(n);
  for (size_t i = 0; i < problem.points.size(); ++i) {
    const PointRows& rows = problem.points[i];
    task.problem.lower[rows.first] = 0;
    for (int k = 0; k < rows.count && task.warm; ++k)
      task.start[rows.first + k] = rows.axes[size_t(k)].dot(forces[i]);
  }
  for (const TurningRows& t : problem.turning) task.problem.lower[t.first] = 0;
  if (task.warm) start_turning(problem, turning, task.start);
  for (size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Index at = n - Eigen::Index(rows.size() - i);
    task.problem.lower[at] = rows[i].least;
    task.problem.upper[at] = rows[i].most;
    task.start[at] = std::clamp(rows[i].force, rows[i].least, rows[i].most);
  }
}

/// Chooses how the problem is solved. Without joints, or with the rows of joints as unknowns, each
/// row acts on its own bodies only, so that the problem has a form in blocks.
void set_method(ForceProblem& problem, const ContactForceMethod& method,
                std::span<const DofBlock> blocks, const Articulation& joints) {
  lcp::ConeTask& task = problem.task;
  task.asked = method.solver;
  task.least = method.least;
  task.believable = tolerances::believable_residual;
  if (!task.few()) task.tolerance = tolerances::force_residual_of_many;
  // The bounds of torques by normal forces fit no block of bodies and are unsymmetric.
  const bool turns = !problem.turning.empty();
  const bool whole = joints.empty() || (!turns && takes_joint_rows(problem, method, joints));
  if (whole && !joints.empty()) add_joint_rows(problem, joints);
  if (!method.solver && whole && !turns && !(task.few() && task.problem.groups.empty()))
    task.blocks = block_problem(problem.rows, blocks, task.problem);
  task.matrix = [&problem, &joints, blocks, whole] {
    lcp::MatX A = delassus(problem.rows, blocks);
    if (!whole) joints.reduce(problem.rows, A);
    complete_turning(problem, A);
    return A;
  };
}

ContactForceProblem told(const ForceProblem& problem, std::span<const ForcePoint> points) {
  ContactForceProblem out;
  out.lcp = problem.task.problem;
  if (out.lcp.A.size() == 0) out.lcp.A = problem.task.matrix();
  for (size_t i = 0; i < points.size(); ++i) {
    const PointRows& rows = problem.points[i];
    out.points.push_back({rows.first, rows.count, rows.axes, points[i].friction});
  }
  return out;
}

}  // namespace

std::span<const std::string_view> all_friction_cones() {
  static constexpr std::array<std::string_view, 2> names{"circular", "pyramid"};
  return names;
}

Row turning_row(const TurningPoint& p, const Vec3& axis) {
  return {{p.a, Vec3::Zero(), -axis}, {p.b, Vec3::Zero(), axis}};
}

Result<ContactForceMethod> contact_force_method(std::string_view solver, std::string_view cone) {
  ContactForceMethod method;
  std::vector<std::string> names{"automatic"};
  for (const lcp::LcpSolverEntry& e : lcp::all_lcp_solvers()) {
    names.emplace_back(e.name);
    if (e.name == solver) method.solver = &e;
  }
  if (!method.solver && solver != names.front())
    return Error{ErrorCode::not_found, unknown_name("contact solver", solver, names), {}, {}};
  const auto cones = all_friction_cones();
  if (std::find(cones.begin(), cones.end(), cone) == cones.end()) {
    names.assign(cones.begin(), cones.end());
    return Error{ErrorCode::not_found, unknown_name("friction cone", cone, names), {}, {}};
  }
  if (cone == "pyramid") method.cone = lcp::ConeShape::pyramid;
  return method;
}

ContactForceReport solve_contact_forces(std::span<DofBlock> accelerations,
                                        std::span<const ForcePoint> points,
                                        const ContactForceMethod& method, std::vector<Vec3>& forces,
                                        const Articulation& joints, std::span<BoundedRow> rows,
                                        std::span<TurningPoint> turning) {
  ContactForceReport report;
  report.solved = !stop_requested();
  if (!report.solved) return report;
  ForceProblem problem;
  problem.task.warm = forces.size() == points.size();
  forces.resize(points.size(), Vec3::Zero());
  if (points.empty() && rows.empty()) return report;
  std::vector<double> b;
  for (const ForcePoint& p : points) add_point(problem, p, method.cone, accelerations, b);
  for (const TurningPoint& p : turning) add_turning(problem, p, accelerations, b);
  add_bounded(problem, rows, accelerations, b);
  set_conditions(problem, b, forces, rows, turning);
  set_method(problem, method, accelerations, joints);
  if (method.tell) *method.tell = told(problem, points);
  lcp::ConeAnswer answer = lcp::solve_cones(problem.task);
  report.attempts = std::move(answer.attempts);
  report.solved = answer.found;
  if (!report.solved) return report;
  const lcp::LcpSolution& solved = answer.solution;
  if (method.tell) method.tell->found = solved.z;
  report.iterations = solved.report.iterations;
  report.residual = solved.report.residual;
  report.solver = solved.report.solver;
  report.substituted =
      report.attempts.back().sliding || (method.solver && report.solver != method.solver->name);
  for (size_t i = 0; i < points.size(); ++i) {
    const PointRows& of = problem.points[i];
    forces[i].setZero();
    for (int k = 0; k < of.count; ++k) forces[i] += solved.z[of.first + k] * of.axes[size_t(k)];
  }
  for (size_t i = 0; i < rows.size(); ++i)
    rows[i].force = solved.z[Eigen::Index(b.size() - rows.size() + i)];
  take_turning(problem, solved.z, turning);
  // Forces of the joints follow from all others.
  for (size_t r = 0; r < b.size(); ++r)
    apply_row(problem.rows[r], solved.z[Eigen::Index(r)], accelerations);
  return report;
}

}  // namespace tumble
