#include "engine/math/lcp/blocks/block_newton.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_units.hpp"
#include "engine/math/lcp/cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::lcp {
namespace {

constexpr int most_systems = 400;  ///< where options name no other number
constexpr int most_sweeps = 2600;
constexpr double goal = 1e-13;  ///< of the residual

/// P and Q of a unit's rows of the Newton step, by rows of 3.
struct StepRows {
  std::array<double, 9> plain{}, slack{};
};

/// E^-1 and D = E^-1 Q of a unit, by rows of 3.
struct Response {
  std::array<double, 9> inverse{}, d{};
  bool operator==(const Response&) const = default;
};

/// E = [[p, 0], [q, S]] of a unit: its first row has no entries beside the diagonal.
bool invert(const std::array<double, 9>& e, int count, std::array<double, 9>& out) {
  out.fill(0);
  out[0] = 1 / e[0];
  if (count == 1) return std::isfinite(out[0]);
  const double det = e[4] * e[8] - e[5] * e[7];
  out[4] = e[8] / det, out[5] = -e[5] / det;
  out[7] = -e[7] / det, out[8] = e[4] / det;
  out[3] = -(out[4] * e[3] + out[5] * e[6]) * out[0];
  out[6] = -(out[7] * e[3] + out[8] * e[6]) * out[0];
  return std::isfinite(out[0]) && det != 0 && std::isfinite(1 / det);
}

class BlockNewton {
 public:
  explicit BlockNewton(const BlockProblem& problem)
      : problem_(problem),
        units_(problem),
        centre_(VecX::Zero(units_.n)),
        w_(units_.n),
        f_(units_.n),
        best_(VecX::Zero(units_.n)),
        u_(6 * size_t(problem.blocks)),
        a_(u_.size()),
        responses_(units_.units.size()) {
    std::vector<std::pair<int, int>> pairs;
    for (const BlockUnit& unit : units_.units)
      if (unit.block[0] >= 0 && unit.block[1] >= 0)
        pairs.emplace_back(unit.block[0], unit.block[1]);
    factor_.set_pattern(problem.blocks, std::move(pairs));
  }

  LcpSolution run(const LcpOptions& options, const VecX* start);

 private:
  void evaluate(const VecX& z);
  double merit() const { return 0.5 * dot(f_.data(), f_.data(), units_.n); }
  std::array<double, 3> targets(const BlockUnit& unit, const VecX& z) const;
  StepRows rows_of(const BlockUnit& unit, const VecX& z) const;
  bool renew_factor(const std::vector<Response>& wanted);
  bool step(const VecX& z, bool inside, VecX& dz);
  bool inner(VecX& z);
  bool attempt(VecX z, double weight, bool about_zero);
  bool consider(const VecX& z);
  double sweep(VecX& z);
  void sweep_group(const BlockUnit& unit, std::array<double, 3>& x, std::array<double, 3>& w) const;

  const BlockProblem& problem_;
  const BlockUnits units_;
  VecX centre_;
  double weight_ = 0;
  VecX w_, f_, best_;
  double best_residual_ = std::numeric_limits<double>::infinity();
  std::vector<double> u_, a_;
  std::vector<Response> responses_;
  bool factored_ = false;
  BlockFactor factor_;
  int systems_ = 0, limit_ = most_systems;
};

/// P(z - w) of the natural map (natural_map.hpp).
std::array<double, 3> BlockNewton::targets(const BlockUnit& unit, const VecX& z) const {
  const int a = unit.row[0];
  if (!unit.group) return {std::clamp(z[a] - w_[a], unit.lower, unit.upper), 0, 0};
  const int s = unit.row[1], t = unit.row[2];
  const double axial = std::max(0.0, z[a] - w_[a]);
  const auto to = nearest_lateral(*unit.group, axial, {z[s] - w_[s], z[t] - w_[t]});
  return {axial, to[0], to[1]};
}

void BlockNewton::evaluate(const VecX& z) {
  units_.gather(z, u_);
  units_.slack(u_, w_);
  for (int i = 0; i < units_.n; ++i) w_[i] += weight_ * (z[i] - centre_[i]);
  for (const BlockUnit& unit : units_.units) {
    const auto to = targets(unit, z);
    for (size_t r = 0; r < size_t(unit.count); ++r) f_[unit.row[r]] = z[unit.row[r]] - to[r];
  }
}

/// An element of the generalised Jacobian, as in NaturalMap.
StepRows BlockNewton::rows_of(const BlockUnit& unit, const VecX& z) const {
  StepRows out;
  const auto still = [&](size_t r) { out.plain[4 * r] = 1; };
  const auto equation = [&](size_t r) { out.slack[4 * r] = 1; };
  const int a = unit.row[0];
  const double axial = z[a] - w_[a];
  if (!unit.group) {
    axial > unit.lower&& axial < unit.upper ? equation(0) : still(0);
    return out;
  }
  if (axial <= 0) {
    for (const size_t r : {0, 1, 2}) still(r);
    return out;
  }
  equation(0);
  const ConeGroup& g = *unit.group;
  const double radius = g.slope * axial;
  const std::array<double, 2> t{z[unit.row[1]] - w_[unit.row[1]], z[unit.row[2]] - w_[unit.row[2]]};
  const double length = std::sqrt(t[0] * t[0] + t[1] * t[1]);
  for (size_t k = 0; k < 2; ++k) {
    const size_t r = k + 1;
    const auto slides = [&](double u) {  // F_t = z_t - u slope (z_a - w_a)
      out.plain[4 * r] = 1;
      out.plain[3 * r] = -g.slope * u;
      out.slack[3 * r] = g.slope * u;
    };
    if (g.mode == ConeMode::sliding) {
      slides(-g.direction[k]);
    } else if (g.shape == ConeShape::pyramid) {
      std::fabs(t[k]) <= radius ? equation(r) : slides(t[k] > 0 ? 1 : -1);
    } else if (length <= radius) {
      equation(r);
    } else {
      const double f = radius / length, u = t[k] / length, v = t[1 - k] / length;
      slides(u);
      const size_t other = 3 * r + 2 - k;
      out.plain[4 * r] = 1 - f * (1 - u * u), out.slack[4 * r] = f * (1 - u * u);
      out.plain[other] = f * u * v, out.slack[other] = -f * u * v;
    }
  }
  return out;
}

/// Factors 1 + G^T D G, unless it is that of the last time.
bool BlockNewton::renew_factor(const std::vector<Response>& wanted) {
  if (factored_ && wanted == responses_) return true;
  responses_ = wanted;
  factored_ = false;
  factor_.set_identity();
  for (size_t k = 0; k < wanted.size(); ++k) add_response(units_.units[k], wanted[k].d, factor_);
  ++systems_;
  return factored_ = factor_.factor();
}

/// dz of the Newton step at the last evaluate(); `inside`: as if no group were on its cone.
bool BlockNewton::step(const VecX& z, bool inside, VecX& dz) {
  std::vector<Response> wanted(units_.units.size());
  std::fill(a_.begin(), a_.end(), 0.0);
  std::vector<std::array<double, 3>> right(wanted.size());  // -E^-1 F
  for (size_t k = 0; k < wanted.size(); ++k) {
    const BlockUnit& unit = units_.units[k];
    const auto count = size_t(unit.count);
    StepRows rows;
    if (inside && unit.group && unit.group->mode == ConeMode::undecided)
      rows.slack = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    else
      rows = rows_of(unit, z);
    std::array<double, 9> e;
    for (size_t i = 0; i < 9; ++i) e[i] = rows.plain[i] + weight_ * rows.slack[i];
    Response& x = wanted[k];
    if (!invert(e, unit.count, x.inverse)) return false;
    right[k].fill(0);
    for (size_t r = 0; r < count; ++r)
      for (size_t q = 0; q < count; ++q) {
        for (size_t c = 0; c < count; ++c)
          x.d[3 * r + c] += x.inverse[3 * r + q] * rows.slack[3 * q + c];
        const int i = unit.row[q];
        const bool equation = inside && unit.group && unit.group->mode == ConeMode::undecided;
        right[k][r] -= x.inverse[3 * r + q] * (equation ? w_[i] : f_[i]);
      }
    units_.add_rows(unit, right[k], a_);
  }
  if (!renew_factor(wanted)) return false;
  factor_.solve(a_);
  for (size_t k = 0; k < wanted.size(); ++k) {
    const BlockUnit& unit = units_.units[k];
    const auto moved = units_.rows_times(unit, a_);
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      double x = right[k][r];
      for (size_t q = 0; q < size_t(unit.count); ++q) x -= wanted[k].d[3 * r + q] * moved[q];
      dz[unit.row[r]] = x;
    }
  }
  return true;
}

/// Newton on the map as it is; true when F is as small as rounding allows.
bool BlockNewton::inner(VecX& z) {
  VecX dz(units_.n), trial;
  evaluate(z);
  double now = merit();
  const double largest = units_.own_terms(z);
  const double size = 1e-30 * largest * largest;
  for (int k = 0; k < 40 && systems_ < limit_ && !stop_requested(); ++k) {
    if (!(now > size)) return true;
    if (!step(z, false, dz)) return false;
    double t = 1, next = 0, least = std::numeric_limits<double>::infinity(), best_t = 0;
    for (int half = 0; half < 12; ++half, t *= 0.5) {
      trial = z + t * dz;
      evaluate(trial);
      next = merit();
      if (next < least) {
        least = next;
        best_t = t;
      }
      if (next <= (1 - 1e-3 * t) * now) break;
    }
    if (!(least < now * (1 - 1e-6))) return now <= 1e6 * size;
    z += best_t * dz;
    evaluate(z);
    now = least;
  }
  return !(now > size);
}

/// True when z is as good as can be asked.
bool BlockNewton::consider(const VecX& z) {
  units_.gather(z, u_);
  units_.slack(u_, w_);
  VecX plain = z, slack = w_;
  for (int i = 0; i < units_.n; ++i) {
    plain[i] *= units_.d[size_t(i)];
    slack[i] /= units_.d[size_t(i)];
  }
  const double residual =
      judge(problem_.conditions, units_.d, units_.own_terms(z), plain, slack).worst();
  if (residual < best_residual_) {
    best_residual_ = residual;
    best_ = plain;
  }
  return best_residual_ <= goal;
}

/// Proximal steps of the given weight; the first about 0, or about z.
bool BlockNewton::attempt(VecX z, double weight, bool about_zero) {
  factored_ = factored_ && weight_ == weight;
  weight_ = weight;
  if (about_zero)
    centre_.setZero();
  else
    centre_ = z;
  int idle = 0;
  for (int k = 0; k < 60 && idle < 3 && !stop_requested(); ++k) {
    const bool converged = inner(z);
    const double before = best_residual_;
    if (consider(z)) return true;
    if (!converged) break;
    idle = best_residual_ > 0.5 * before ? idle + 1 : 0;
    centre_ = z;
  }
  return best_residual_ <= 100 * goal;
}

void BlockNewton::sweep_group(const BlockUnit& unit, std::array<double, 3>& x,
                              std::array<double, 3>& w) const {
  const ConeGroup& g = *unit.group;
  const std::array<double, 9>& A = unit.own;
  const auto change = [&](size_t i, double to) {
    const double by = to - x[i];
    x[i] = to;
    for (size_t k = 0; k < 3; ++k) w[k] += by * A[3 * k + i];
  };
  double slope = A[0];
  if (g.mode == ConeMode::sliding)
    slope -= g.slope * (A[1] * g.direction[0] + A[2] * g.direction[1]);
  if (slope > 1e-12) change(0, std::max(0.0, x[0] - w[0] / slope));
  const double mean = 0.5 * (A[4] + A[8]), half = 0.5 * (A[4] - A[8]);
  const double greatest = mean + std::sqrt(half * half + A[5] * A[5]);
  const double f = greatest > 1e-12 ? 1 / greatest : 0;
  for (int k = 0; k < (g.mode == ConeMode::sliding ? 1 : 3); ++k) {
    const auto to = nearest_lateral(g, x[0], {x[1] - f * w[1], x[2] - f * w[2]});
    change(1, to[0]);
    change(2, to[1]);
  }
}

/// Projected Gauss-Seidel, as in Sweeper; u_ must be G^T z and stays it. The greatest change.
double BlockNewton::sweep(VecX& z) {
  double most = 0;
  for (const BlockUnit& unit : units_.units) {
    std::array<double, 3> w = units_.rows_times(unit, u_), x{};
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      w[r] += units_.b[unit.row[r]];
      x[r] = z[unit.row[r]];
    }
    if (unit.group)
      sweep_group(unit, x, w);
    else if (unit.own[0] > 0)
      x[0] = std::clamp(x[0] - w[0] / unit.own[0], unit.lower, unit.upper);
    std::array<double, 3> by{};
    for (size_t r = 0; r < size_t(unit.count); ++r) {
      by[r] = x[r] - z[unit.row[r]];
      z[unit.row[r]] = x[r];
      most = std::max(most, std::fabs(by[r]));
    }
    if (by != std::array<double, 3>{}) units_.add_rows(unit, by, u_);
  }
  return most;
}

LcpSolution BlockNewton::run(const LcpOptions& options, const VecX* start) {
  constexpr double weight = 1e-7;
  VecX swept = VecX::Zero(units_.n), z = swept;
  if (options.max_iterations > 0) limit_ = options.max_iterations;
  bool done = units_.n == 0;
  if (!done && start) {
    for (int i = 0; i < units_.n; ++i) swept[i] = (*start)[i] / units_.d[size_t(i)];
    done = consider(swept) || attempt(swept, weight, true);
  }
  if (!done) {
    // From where no cone matters, which is mostly near.
    weight_ = weight;
    centre_.setZero();
    factored_ = false;
    evaluate(z);
    VecX dz(units_.n);
    if (step(z, true, dz)) z = dz;
    done = attempt(z, weight, true);
  }
  // What is as good as was asked for is not sought anew from elsewhere.
  done = done || best_residual_ <= options.tolerance;
  for (int sweeps = 10; !done && sweeps <= most_sweeps && systems_ < limit_; sweeps *= 4) {
    bool finite = true;
    units_.gather(swept, u_);
    for (int k = 0; k < sweeps && finite; ++k) {
      const double moved = sweep(swept);
      finite = moved < 1e100 && !stop_requested();
      if (moved == 0) break;
    }
    if (!finite) break;
    done = consider(swept) || attempt(swept, weight, true);
    for (const double other : {1e-4, 1e-2, 1e-10}) done = done || attempt(swept, other, false);
  }
  LcpSolution out;
  out.report.solver = "cone_newton";
  out.report.iterations = systems_;
  out.report.status = LcpStatus::solved;
  out.z = best_;
  settle(problem_, options.tolerance, out);
  if (!out.report.solved()) out.report.status = LcpStatus::max_iterations;
  const LcpProblem& p = problem_.conditions;
  for (int i = 0; i < units_.n; ++i)
    out.places.push_back(out.z[i] <= p.lower[i]   ? Place::lower
                         : out.z[i] >= p.upper[i] ? Place::upper
                                                  : Place::between);
  return out;
}

}  // namespace

Result<LcpSolution> block_newton(const BlockProblem& problem, const LcpOptions& options,
                                 const VecX* start) {
  if (Status c = check(problem); !c) return c.error();
  if (start && (start->size() != problem.size() || !start->allFinite()))
    return Error{ErrorCode::invalid_argument,
                 "the start is not finite, or not of the problem's size",
                 "lcp",
                 {}};
  return BlockNewton(problem).run(options, start);
}

}  // namespace tumble::lcp
