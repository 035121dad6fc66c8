#include "engine/math/lcp/blocks/block_system.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::lcp {
namespace {

/// E^-1 of a unit with 3 rows, the first of which has only its diagonal entry.
bool invert_from_first(const Square& e, Square& out) {
  const double det = e[4] * e[8] - e[5] * e[7];
  out = {1 / e[0], 0, 0, 0, e[8] / det, -e[5] / det, 0, -e[7] / det, e[4] / det};
  out[3] = -(out[4] * e[3] + out[5] * e[6]) * out[0];
  out[6] = -(out[7] * e[3] + out[8] * e[6]) * out[0];
  return std::isfinite(out[0]) && det != 0 && std::isfinite(1 / det);
}

/// E^-1 of a unit.
bool invert(const Square& m, int count, Square& out) {
  out.fill(0);
  if (count == 1) {
    out[0] = 1 / m[0];
    return std::isfinite(out[0]);
  }
  if (m[1] == 0 && m[2] == 0) return invert_from_first(m, out);
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

}  // namespace

BlockSystem::BlockSystem(const BlockProblem& problem)
    : problem_(problem), units_(problem), u_(6 * size_t(problem.blocks)), a_(u_.size()) {
  units_.set_pattern(problem.blocks, factor_);
}

void BlockSystem::slack(const VecX& z, VecX& w) {
  charge_work(units_.parts.size(), 100);
  units_.gather(z, u_);
  for (size_t k = 0; k < units_.parts.size(); ++k) {
    const ConeUnit& unit = units_.parts[k];
    const Triple x = units_.rows_times(k, u_);
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      const int i = unit.row[r];
      w[i] = units_.b[i] + x[r];
    }
  }
}

Triple BlockSystem::swept_slack(size_t part) const {
  charge_work(100);
  Triple w = units_.rows_times(part, u_);
  const Triple b = units_.parts[part].of(units_.b);
  for (size_t r = 0; r < 3; ++r) w[r] += b[r];
  return w;
}

/// Factors 1 + G^T D G, unless D is unchanged.
bool BlockSystem::renew_factor(std::vector<Square> responses) {
  if (factored_ && responses == responses_) return true;
  responses_ = std::move(responses);
  factored_ = false;
  factor_.set_identity();
  for (size_t k = 0; k < responses_.size(); ++k) units_.add_response(k, responses_[k], factor_);
  ++systems;
  return factored_ = factor_.factor();
}

bool BlockSystem::step(std::span<const UnitValue> values, const VecX& f, double weight, VecX& dz) {
  charge_work(values.size(), 300);
  std::vector<Square> d(values.size(), Square{});
  std::vector<Triple> right(values.size(), Triple{});  // -E^-1 f
  std::fill(a_.begin(), a_.end(), 0.0);
  for (size_t k = 0; k < values.size(); ++k) {
    const ConeUnit& unit = units_.parts[k];
    const auto count = size_t(unit.count);
    Square e, inverse;
    for (size_t i = 0; i < 9; ++i) e[i] = values[k].by_z[i] + weight * values[k].by_w[i];
    if (!invert(e, unit.count, inverse)) return false;
    for (size_t r = 0; r < count; ++r)
      for (size_t q = 0; q < count; ++q) {
        right[k][r] -= inverse[3 * r + q] * f[unit.row[q]];
        for (size_t c = 0; c < count; ++c)
          d[k][3 * r + c] += inverse[3 * r + q] * values[k].by_w[3 * q + c];
      }
    units_.add_rows(k, right[k], a_);
  }
  if (!renew_factor(std::move(d))) return false;
  factor_.solve(a_);
  dz.resize(f.size());
  for (size_t k = 0; k < values.size(); ++k) {
    const ConeUnit& unit = units_.parts[k];
    const Triple moved = units_.rows_times(k, a_);
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      double x = right[k][r];
      for (size_t q = 0; q < size_t(unit.count); ++q) x -= responses_[k][3 * r + q] * moved[q];
      dz[unit.row[r]] = x;
    }
  }
  return dz.allFinite();
}

/// Residuals of z, and w; `unit` is the largest term.
LcpResidual BlockSystem::judged(const VecX& z, double unit, VecX& w) {
  const VecX scaled = in_scaled_units(z);
  w.resize(units_.n);
  slack(scaled, w);
  w = in_scaled_units(w);
  return judge(problem_.conditions, units_.d, unit, z, w);
}

double BlockSystem::residual(const VecX& z) {
  VecX w;
  return judged(z, units_.own_terms(in_scaled_units(z)), w).worst();
}

void BlockSystem::grade(double tolerance, LcpSolution& s) {
  const LcpResidual r = validate(s.z, s.w);
  const double rest = s.report.solved() ? largest_term(nearest_to_zero(problem_.conditions)) : 1;
  lcp::grade(r, rest, tolerance, s);
}

}  // namespace tumble::lcp
