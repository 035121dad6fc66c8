#include "engine/math/lcp/cones/solve_cones.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/blocks/block_solvers.hpp"
#include "engine/math/lcp/blocks/block_system.hpp"
#include "engine/math/lcp/cones/sliding_cones.hpp"
#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/least/minimum_norm.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <utility>

namespace tumble::lcp {
namespace {

/// Whether the solver accepts the problem's groups.
bool takes(const LcpSolverEntry& solver, const LcpProblem& problem) {
  return std::all_of(problem.groups.begin(), problem.groups.end(), [&](const ConeGroup& g) {
    return g.mode == ConeMode::sliding ? solver.sliding : solver.undecided;
  });
}

bool is_asked(const ConeTask& t) {
  return t.asked && takes(*t.asked, t.problem);
}

bool has_blocks(const ConeTask& t) {
  return t.blocks.has_value();
}

bool has_groups(const ConeTask& t) {
  return !t.problem.groups.empty();
}

bool is_dense(const ConeTask& t) {
  return has_groups(t) && !has_blocks(t);
}

bool is_few_in_blocks(const ConeTask& t) {
  return has_groups(t) && t.few() && has_blocks(t);
}

bool is_sliding(const ConeTask& t) {
  return slides(t.problem);
}

bool is_enumerable(const ConeTask& t) {
  return is_sliding(t) && is_quick_to_enumerate(t.problem);
}

Result<LcpSolution> solve_as_asked(const ConeTask& t) {
  const bool begins = t.asked->solve == cone_newton && t.start.size() > 0;
  return begins ? cone_newton_from(t.problem, {}, t.start) : t.asked->solve(t.problem, {});
}

LcpOptions block_options(const ConeTask& t, int systems) {
  LcpOptions out;
  out.tolerance = t.tolerance;
  out.max_iterations = systems;
  return out;
}

Result<LcpSolution> newton_by_blocks(const ConeTask& t, int systems) {
  return block_newton(*t.blocks, block_options(t, systems), t.warm ? &t.start : nullptr);
}

/// From the start, which usually needs few corrections; if that fails, without it.
Result<LcpSolution> newton_with_matrix(const ConeTask& t) {
  LcpOptions options;
  options.tolerance = t.tolerance;
  if (t.start.size() > 0) {
    LcpOptions near = options;
    near.tolerance = tolerances::sharp_residual;
    Result<LcpSolution> solved = cone_newton_from(t.problem, near, t.start);
    if (!solved || solved->report.solved()) return solved;
  }
  return cone_newton(t.problem, options);
}

/// Sets the status by the task's tolerance, whatever tolerance the stage aimed at.
void judge_again(const ConeTask& t, LcpSolution& s) {
  s.report.status = LcpStatus::solved;
  if (t.blocks)
    BlockSystem(*t.blocks).grade(t.tolerance, s);
  else
    grade(t.problem, t.tolerance, s);
  if (!s.report.solved()) s.report.status = LcpStatus::max_iterations;
}

bool believed(const ConeTask& t, const LcpSolution& s) {
  return s.report.solved() || s.report.residual <= t.believable;
}

class ConeStages {
 public:
  explicit ConeStages(ConeTask& task) : task_(task) {}

  ConeAnswer run() {
    for (const ConeStage& stage : all_cone_stages()) {
      if (proved_ || stop_requested()) break;
      if (stage.applies(task_) && !is_done(stage)) attempt(stage);
    }
    out_.found = any_ && holds(out_.solution);
    if (proved_ && !out_.found) {
      out_.solution.report.status = LcpStatus::infeasible;
      out_.solution.ray = ray_;
    }
    if (task_.least && out_.found) make_least();
    return std::move(out_);
  }

 private:
  void ask_matrix() {
    if (task_.problem.A.size() == 0 && task_.matrix) task_.problem.A = task_.matrix();
  }
  /// With few sliding groups, a result that is not solved must also satisfy balances(): residuals
  /// are relative to terms that may grow without bound if there is no solution.
  bool holds(const LcpSolution& s) {
    if (s.report.solved()) return true;
    if (!believed(task_, s)) return false;
    if (!task_.few() || !is_sliding(task_)) return true;
    ask_matrix();
    return balances(task_.problem, s);
  }
  bool is_done(const ConeStage& stage) {
    if (!any_) return false;
    return stage.sliding ? holds(out_.solution) : out_.solution.report.solved();
  }
  void attempt(const ConeStage& stage);
  void make_least();

  ConeTask& task_;
  ConeAnswer out_;
  bool any_ = false, proved_ = false;
  VecX ray_;
};

void ConeStages::attempt(const ConeStage& stage) {
  if (stage.factors > 0) {
    const auto n = uint64_t(task_.problem.size());
    if (!may_begin_work(stage.factors * (n * n * n / 6))) return;
    ask_matrix();
  }
  Result<LcpSolution> now = stage.solve(task_);
  LcpReport report;
  report.status = LcpStatus::numeric;  // if a stage refuses the problem
  if (now) report = now->report;
  out_.attempts.push_back(
      {stage.name, report.status, report.iterations, report.residual, stage.sliding});
  if (!now) return;
  LcpSolution& best = out_.solution;
  const bool first = !std::exchange(any_, true);
  const bool better = stage.sliding ? holds(*now) : report.residual < best.report.residual;
  proved_ = report.status == LcpStatus::infeasible;
  if (proved_) ray_ = now->ray;
  if (first || better) best = std::move(*now);
  if (!best.report.solved() && !stage.sliding && !proved_) judge_again(task_, best);
}

void ConeStages::make_least() {
  ask_matrix();
  Result<LcpSolution> least = minimum_norm(task_.problem, out_.solution);
  if (least && least->report.solved()) out_.solution = std::move(*least);
}

}  // namespace

const std::vector<ConeStage>& all_cone_stages() {
  static const std::vector<ConeStage> list{
      {"asked", is_asked, solve_as_asked},
      {"blocks", has_blocks,
       [](const ConeTask& t) { return newton_by_blocks(t, tolerances::first_block_systems); }, 0},
      {"block_path", has_blocks,
       [](const ConeTask& t) { return block_interior(*t.blocks, block_options(t, 0)); }, 0},
      {"newton", is_dense, newton_with_matrix},
      {"pivots", [](const ConeTask&) { return true; },
       [](const ConeTask& t) { return solve_without_laterals(t.problem); }},
      {"patient_blocks", has_blocks,
       [](const ConeTask& t) { return newton_by_blocks(t, tolerances::patient_block_systems); }, 0},
      {"path", has_blocks, [](const ConeTask& t) { return cone_interior(t.problem); },
       tolerances::factors_of_path},
      {"matrix_newton", is_few_in_blocks, newton_with_matrix},
      {"fast_slip", is_sliding,
       [](const ConeTask& t) { return solve_from_fast_slip(t.problem, t.few()); }, 1, true},
      {"enumeration", is_enumerable, [](const ConeTask& t) { return enumeration(t.problem); }, 1,
       true},
  };
  return list;
}

ConeAnswer solve_cones(ConeTask& task) {
  return ConeStages(task).run();
}

Result<LcpSolution> solve_without_laterals(const LcpProblem& problem) {
  if (problem.groups.empty()) return dantzig(problem);
  std::vector<char> lateral(size_t(problem.size()), 0);
  for (const ConeGroup& g : problem.groups)
    for (const int i : g.lateral) lateral[size_t(i)] = 1;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < problem.size(); ++i)
    if (!lateral[size_t(i)]) kept.push_back(i);
  LcpProblem plain;
  charge_work(kept.size(), kept.size());
  if (stop_requested()) return stopped_error();
  plain.A = problem.A(kept, kept);
  plain.b = problem.b(kept), plain.lower = problem.lower(kept), plain.upper = problem.upper(kept);
  Result<LcpSolution> out = dantzig(plain);
  if (!out) return out;
  const auto with_laterals = [&](const VecX& v) {
    VecX all = VecX::Zero(problem.size());
    all(kept) = v;
    return all;
  };
  if (out->report.status == LcpStatus::infeasible) out->ray = with_laterals(out->ray);
  const bool proved = out->report.status == LcpStatus::infeasible &&
                      ray_residual(problem, out->ray) <= LcpOptions{}.tolerance;
  out->z = with_laterals(out->z);
  out->report.status = proved ? LcpStatus::infeasible : LcpStatus::solved;
  grade(problem, LcpOptions{}.tolerance, *out);
  return out;
}

}  // namespace tumble::lcp
