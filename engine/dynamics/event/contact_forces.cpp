#include "engine/dynamics/event/contact_forces.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/text.hpp"
#include "engine/dynamics/rows/block_rows.hpp"
#include "engine/math/lcp/blocks/block_solver.hpp"
#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/least/minimum_norm.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// Residual that points which depend on each other may leave where the solver aims at less.
constexpr double believable = 1e-6;
constexpr int few_unknowns = 60;  ///< from where on the cube of their number is dear
/// Residual of more unknowns that is not worth a factorisation of their matrix.
constexpr double good_of_many = 1e-8;
constexpr size_t few_points = 8;   ///< of which all sets can be tried
constexpr double fast_slip = 1e4;  ///< of the greatest acceleration, in a unit of time
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
    lcp::ConeGroup& group = problem.lcp.groups.emplace_back();
    group.axial = rows.first;
    group.lateral = {rows.first + 1, rows.first + 2};
    group.slope = p.friction;
    group.shape = cone;
    if (p.sliding) {
      const Vec2 slip = Vec2(rows.axes[1].dot(p.slip), rows.axes[2].dot(p.slip)).normalized();
      group.mode = lcp::ConeMode::sliding;
      group.direction = {slip.x(), slip.y()};
    }
  }
  problem.points.push_back(rows);
}

/// What the solver can take at all: groups are more than bounds.
bool takes(const lcp::LcpSolverEntry& solver, const lcp::LcpProblem& problem) {
  return std::all_of(problem.groups.begin(), problem.groups.end(), [&](const lcp::ConeGroup& g) {
    return g.mode == lcp::ConeMode::sliding ? solver.sliding : solver.undecided;
  });
}

bool slides(const lcp::LcpProblem& problem) {
  return std::any_of(problem.groups.begin(), problem.groups.end(),
                     [](const lcp::ConeGroup& g) { return g.mode == lcp::ConeMode::sliding; });
}

/// From the last forces, which mostly need no change; where these lead nowhere, from none.
Result<lcp::LcpSolution> solve_from(const lcp::LcpProblem& problem, const lcp::VecX& z) {
  if (problem.groups.empty()) return lcp::dantzig(problem);
  lcp::LcpOptions sharp;
  sharp.tolerance = 1e-12;
  Result<lcp::LcpSolution> solved = lcp::cone_newton_from(problem, sharp, z);
  if (!solved || !solved->report.solved()) solved = lcp::cone_newton(problem);
  return solved;
}

/// By the method asked for, else by the one that takes everything.
Result<lcp::LcpSolution> solve_with_matrix(const lcp::LcpProblem& problem, const lcp::VecX& z,
                                           const ContactForceMethod& method, bool& substituted) {
  const lcp::LcpSolverEntry* asked = method.solver;
  if (asked && asked->solve != lcp::cone_newton && takes(*asked, problem)) {
    Result<lcp::LcpSolution> solved = asked->solve(problem, {});
    if (solved && solved->report.solved()) {
      substituted = solved->report.solver != asked->name;
      return solved;
    }
  }
  Result<lcp::LcpSolution> solved = asked && asked->solve == lcp::cone_newton
                                        ? lcp::cone_newton_from(problem, {}, z)
                                        : solve_from(problem, z);
  substituted = asked && solved && solved->report.solver != asked->name;
  return solved;
}

/// In the space of the blocks, where bodies answer to what acts on themselves only: the best that
/// was found, solved or not.
std::optional<lcp::LcpSolution> solve_by_blocks(const ForceProblem& problem,
                                                std::span<const DofBlock> blocks,
                                                const Articulation& joints, const lcp::VecX* start,
                                                const ContactForceMethod& method) {
  if (method.solver || !joints.empty()) return {};
  if (problem.lcp.groups.empty() && problem.lcp.size() <= few_unknowns) return {};
  lcp::BlockProblem sparse;
  sparse.conditions = problem.lcp;
  set_block_rows(problem.rows, BlockRoots(problem.rows, blocks), sparse);
  lcp::LcpOptions options;
  if (problem.lcp.size() > few_unknowns) options.tolerance = good_of_many;
  Result<lcp::LcpSolution> solved = lcp::solve_blocks(sparse, options, start);
  if (!solved) return {};
  return std::move(*solved);
}

/// Where that fails the central path with the whole matrix, which loses fewer digits; then, of a
/// few unknowns, Newton's method with it.
Result<lcp::LcpSolution> solve_after_blocks(const lcp::LcpProblem& problem, lcp::LcpSolution best,
                                            const lcp::VecX& z, const ContactForceMethod& method,
                                            bool& substituted) {
  Result<lcp::LcpSolution> path = lcp::cone_interior(problem);
  if (path && path->report.residual < best.report.residual) best = std::move(*path);
  if (best.report.solved() || problem.size() > few_unknowns) return best;
  return solve_with_matrix(problem, z, method, substituted);
}

bool believed(const Result<lcp::LcpSolution>& solved) {
  return solved && (solved->report.solved() || solved->report.residual <= believable);
}

/// Where nothing is in balance ever greater forces are nearly so, measured by themselves: what is
/// off must be little beside what the points do without.
bool balances(const lcp::LcpProblem& problem, const lcp::LcpSolution& solved) {
  const double alone = lcp::validate(problem, lcp::VecX::Zero(problem.size())).unit;
  return solved.report.residual * lcp::validate(problem, solved.z).unit <= believable * alone;
}

/// Of a few points that all slide or have no friction: every set of them that may press.
Result<lcp::LcpSolution> enumerate_sliding(const lcp::LcpProblem& problem) {
  std::vector<Eigen::Index> normals;
  lcp::MatX pushes = lcp::MatX::Identity(problem.size(), problem.size());
  std::vector<bool> lateral(size_t(problem.size()), false);
  for (const lcp::ConeGroup& g : problem.groups) {
    if (g.mode != lcp::ConeMode::sliding) return Error{ErrorCode::unsupported, "undecided", {}, {}};
    for (size_t k = 0; k < 2; ++k) {
      pushes(g.lateral[k], g.axial) = -g.slope * g.direction[k];
      lateral[size_t(g.lateral[k])] = true;
    }
  }
  for (Eigen::Index i = 0; i < problem.size(); ++i)
    if (!lateral[size_t(i)]) normals.push_back(i);
  if (normals.size() > few_points) return Error{ErrorCode::unsupported, "too many", {}, {}};
  const lcp::MatX along = pushes(Eigen::all, normals);
  lcp::MatX A = lcp::MatX::Zero(along.cols(), along.cols());
  for (Eigen::Index c = 0; c < A.cols(); ++c)
    for (Eigen::Index r = 0; r < A.rows(); ++r)
      for (Eigen::Index k = 0; k < problem.size(); ++k)
        A(r, c) += problem.A(normals[size_t(r)], k) * along(k, c);
  Result<lcp::LcpSolution> solved = lcp::enumeration(lcp::LcpProblem::plain(A, problem.b(normals)));
  if (!solved) return solved;
  lcp::VecX z = lcp::VecX::Zero(problem.size());
  for (Eigen::Index c = 0; c < along.cols(); ++c) z += solved->z[c] * along.col(c);
  solved->z = z;
  return solved;
}

/// Sliding forces may be hard to find, as A with friction in it is neither symmetric nor definite.
/// Those of an implicit step of points that slide so fast that forces do not change it, in the
/// full cone, are easier, and from there it is a step to these.
Result<lcp::LcpSolution> solve_from_fast_slip(const lcp::LcpProblem& problem) {
  lcp::LcpProblem fast = problem;
  const double speed = fast_slip * problem.b.cwiseAbs().maxCoeff();
  for (lcp::ConeGroup& g : fast.groups) {
    if (g.mode != lcp::ConeMode::sliding) continue;
    g.mode = lcp::ConeMode::undecided;
    for (size_t k = 0; k < 2; ++k) fast.b[g.lateral[k]] += speed * g.direction[k];
  }
  const bool few = problem.size() <= few_unknowns;
  const Result<lcp::LcpSolution> start = few ? lcp::cone_newton(fast) : lcp::cone_interior(fast);
  if (start && start->report.solved()) {
    Result<lcp::LcpSolution> solved = lcp::cone_newton_from(problem, {}, start->z);
    if (believed(solved) && balances(problem, *solved)) return solved;
  }
  Result<lcp::LcpSolution> solved = enumerate_sliding(problem);
  if (believed(solved) && balances(problem, *solved)) return solved;
  return Error{ErrorCode::numeric, "there are no sliding forces", {}, {}};
}

Result<lcp::LcpSolution> solve_problem(ForceProblem& problem, std::span<const DofBlock> blocks,
                                       const Articulation& joints, const lcp::VecX& z, bool start,
                                       const ContactForceMethod& method, bool& substituted) {
  std::optional<lcp::LcpSolution> sparse =
      solve_by_blocks(problem, blocks, joints, start ? &z : nullptr, method);
  const bool by_blocks = sparse && sparse->report.solved();
  if (by_blocks && !method.least) return std::move(*sparse);
  problem.lcp.A = delassus(problem.rows, blocks);
  joints.reduce(problem.rows, blocks, problem.lcp.A);
  Result<lcp::LcpSolution> solved =
      by_blocks ? Result<lcp::LcpSolution>(std::move(*sparse))
      : sparse  ? solve_after_blocks(problem.lcp, std::move(*sparse), z, method, substituted)
                : solve_with_matrix(problem.lcp, z, method, substituted);
  const bool few = problem.lcp.size() <= few_unknowns;
  if (slides(problem.lcp) && (!believed(solved) || (few && !balances(problem.lcp, *solved)))) {
    solved = solve_from_fast_slip(problem.lcp);
    substituted = true;
  }
  if (!method.least || !solved) return solved;
  Result<lcp::LcpSolution> least = lcp::minimum_norm(problem.lcp, *solved);
  return least && least->report.solved() ? least : solved;
}

}  // namespace

std::span<const std::string_view> all_friction_cones() {
  static constexpr std::array<std::string_view, 2> names{"circular", "pyramid"};
  return names;
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
                                        const Articulation& joints) {
  ContactForceReport report;
  report.solved = !stop_requested();
  if (!report.solved) return report;
  const bool start = forces.size() == points.size();
  forces.resize(points.size(), Vec3::Zero());
  if (points.empty()) return report;
  ForceProblem problem;
  std::vector<double> b;
  for (const ForcePoint& p : points) add_point(problem, p, method.cone, accelerations, b);
  const auto n = Eigen::Index(b.size());
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
  Result<lcp::LcpSolution> solved =
      solve_problem(problem, accelerations, joints, z, start, method, report.substituted);
  if (!believed(solved)) {
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
