#include "engine/math/lcp/blocks/block_interior.hpp"

#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_newton.hpp"
#include "engine/math/lcp/blocks/block_units.hpp"
#include "engine/math/lcp/interior/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::lcp {
namespace {

constexpr int most_block_polish = 40;   ///< systems
constexpr double block_regular = 1e-7;  ///< added to the diagonal of A in linear systems only

using Square = std::array<double, 9>;

/// Of the leading rows and columns; the others of `out` are 0.
bool invert_square(const Square& m, int count, Square& out) {
  out.fill(0);
  if (count == 1) {
    out[0] = 1 / m[0];
    return std::isfinite(out[0]);
  }
  const auto minor = [&](size_t a, size_t b, size_t c, size_t d) {
    return m[a] * m[d] - m[b] * m[c];
  };
  const double c0 = minor(4, 5, 7, 8), c1 = minor(3, 5, 6, 8), c2 = minor(3, 4, 6, 7);
  const double f = 1 / (m[0] * c0 - m[1] * c1 + m[2] * c2);
  out = {f * c0,  -f * minor(1, 2, 7, 8), f * minor(1, 2, 4, 5),
         -f * c1, f * minor(0, 2, 6, 8),  -f * minor(0, 2, 3, 5),
         f * c2,  -f * minor(0, 1, 6, 7), f * minor(0, 1, 3, 4)};
  return std::isfinite(f) && f != 0;
}

/// (by_z + by_w (G G^T + e)) dz = -f by a = G^T dz: with E = by_z + e by_w and D = E^-1 by_w,
/// (1 + G^T D G) a = -G^T E^-1 f and dz = -E^-1 f - D G a (Woodbury).
class BlockPath final : public PathProblem {
 public:
  explicit BlockPath(const BlockProblem& problem)
      : problem_(problem), units_(problem), u_(6 * size_t(problem.blocks)), a_(u_.size()) {
    std::vector<std::pair<int, int>> pairs;
    for (const BlockUnit& unit : units_.units)
      if (unit.block[0] >= 0 && unit.block[1] >= 0)
        pairs.emplace_back(unit.block[0], unit.block[1]);
    factor_.set_pattern(problem.blocks, std::move(pairs));
  }

  const LcpProblem& conditions() const override { return problem_.conditions; }
  const std::vector<double>& units() const override { return units_.d; }
  const VecX& b() const override { return units_.b; }
  void slack(const VecX& z, VecX& w) override {
    units_.gather(z, u_);
    units_.slack(u_, w);
  }
  bool step(std::span<const SmoothedMap::Unit> parts, std::span<const SmoothedMap::Value> values,
            const VecX& f, VecX& dz) override;
  double residual(const VecX& z) override;

 private:
  const BlockProblem& problem_;
  const BlockUnits units_;
  std::vector<double> u_, a_;
  BlockFactor factor_;
};

/// Relative to terms within units, which are at most all terms.
double BlockPath::residual(const VecX& z) {
  VecX scaled = z, w(units_.n);
  for (int i = 0; i < units_.n; ++i) scaled[i] /= units_.d[size_t(i)];
  slack(scaled, w);
  for (int i = 0; i < units_.n; ++i) w[i] /= units_.d[size_t(i)];
  return judge(problem_.conditions, units_.d, units_.own_terms(scaled), z, w).worst();
}

bool BlockPath::step(std::span<const SmoothedMap::Unit> parts,
                     std::span<const SmoothedMap::Value> values, const VecX& f, VecX& dz) {
  std::vector<Square> d(parts.size());
  std::vector<std::array<double, 3>> right(parts.size());  // -E^-1 f
  std::fill(a_.begin(), a_.end(), 0.0);
  factor_.set_identity();
  for (size_t k = 0; k < parts.size(); ++k) {
    const auto count = size_t(parts[k].count);
    Square e, inverse;
    for (size_t i = 0; i < 9; ++i) e[i] = values[k].by_z[i] + block_regular * values[k].by_w[i];
    if (!invert_square(e, parts[k].count, inverse)) return false;
    d[k].fill(0), right[k].fill(0);
    for (size_t r = 0; r < count; ++r)
      for (size_t q = 0; q < count; ++q) {
        right[k][r] -= inverse[3 * r + q] * f[parts[k].row[q]];
        for (size_t c = 0; c < count; ++c)
          d[k][3 * r + c] += inverse[3 * r + q] * values[k].by_w[3 * q + c];
      }
    units_.add_rows(units_.units[k], right[k], a_);
    add_response(units_.units[k], d[k], factor_);
  }
  if (!factor_.factor()) return false;
  factor_.solve(a_);
  dz = f;
  for (size_t k = 0; k < parts.size(); ++k) {
    const auto moved = units_.rows_times(units_.units[k], a_);
    for (size_t r = 0; r < size_t(parts[k].count); ++r) {
      double x = right[k][r];
      for (size_t q = 0; q < size_t(parts[k].count); ++q) x -= d[k][3 * r + q] * moved[q];
      dz[parts[k].row[r]] = x;
    }
  }
  return dz.allFinite();
}

}  // namespace

Result<LcpSolution> block_interior(const BlockProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  BlockPath sparse(problem);
  PathFollower path(sparse, options);
  if (problem.size() > 0) path.follow();
  LcpSolution out = path_solution(problem.conditions, path);
  if (problem.size() > 0 && path.best_residual() > options.tolerance) {
    LcpOptions few = options;
    few.max_iterations = most_block_polish;
    if (auto polished = block_newton(problem, few, &out.z)) {
      out.report.iterations += polished->report.iterations;
      if (polished->report.residual < path.best_residual()) out.z = polished->z;
    }
  }
  settle(problem, options.tolerance, out);
  if (!out.report.solved()) out.report.status = LcpStatus::max_iterations;
  return out;
}

}  // namespace tumble::lcp
