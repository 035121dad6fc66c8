#include "engine/math/lcp/pivoting/lemke.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/standard_form.hpp"
#include "engine/math/lcp/tolerances.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

/// Rows of w - M v - e c = q in terms of the basic variables. Variables: 0..n-1 are w, n..2n-1 are
/// v, 2n is the covering one, column 2n+1 is the right-hand side.
class LemkeTableau {
 public:
  explicit LemkeTableau(const StandardForm& f) : n_(f.size), width_(2 * n_ + 2) {
    rows_.resize(size_t(n_) * size_t(width_), 0.0);
    for (int r = 0; r < n_; ++r) {
      double* t = row(r);
      t[r] = 1;
      for (int c = 0; c < n_; ++c) t[n_ + c] = -f.M[size_t(r) * size_t(n_) + size_t(c)];
      t[2 * n_] = -1;
      t[2 * n_ + 1] = f.q[size_t(r)];
      basic_.push_back(r);
    }
  }

  double* row(int r) { return rows_.data() + std::ptrdiff_t(r) * width_; }
  int covering() const { return 2 * n_; }
  int complement(int variable) const { return variable < n_ ? variable + n_ : variable - n_; }
  int basic(int r) const { return basic_[size_t(r)]; }
  double right(int r) { return row(r)[2 * n_ + 1]; }

  /// The row that leaves when `entering` grows, by lexicographic order of (right side, w columns);
  /// the covering variable leaves whenever it can. -1: none.
  int leaving(int entering) {
    int best = -1;
    for (int r = 0; r < n_; ++r) {
      if (row(r)[entering] <= tolerances::lemke_no_pivot) continue;
      if (best < 0 || before(r, best, entering)) best = r;
    }
    return best;
  }
  /// The row that is lexicographically most negative: of equal ones the last.
  int first_leaving() {
    int best = 0;
    for (int r = 1; r < n_; ++r)
      if (right(r) <= right(best)) best = r;
    return best;
  }
  void pivot(int r, int entering) {
    double* p = row(r);
    const double f = 1 / p[entering];
    for (int c = 0; c < width_; ++c) p[c] *= f;
    p[entering] = 1;
    for (int k = 0; k < n_; ++k) {
      if (k == r) continue;
      double* t = row(k);
      const double g = t[entering];
      if (g == 0) continue;
      add_scaled(t, -g, p, width_);
      t[entering] = 0;
    }
    basic_[size_t(r)] = entering;
  }

 private:
  bool before(int a, int b, int entering) {
    double *x = row(a), *y = row(b);
    const double fx = 1 / x[entering], fy = 1 / y[entering];
    const double d = x[2 * n_ + 1] * fx - y[2 * n_ + 1] * fy;
    const double unit = std::fabs(x[2 * n_ + 1] * fx) + std::fabs(y[2 * n_ + 1] * fy);
    if (std::fabs(d) > tolerances::lemke_same_side * (unit + fx + fy)) return d < 0;
    if (basic(a) == covering()) return true;
    if (basic(b) == covering()) return false;
    for (int c = 0; c < n_; ++c) {
      const double u = x[c] * fx, v = y[c] * fy;
      if (std::fabs(u - v) > tolerances::lemke_same_column * (1 + std::fabs(u) + std::fabs(v)))
        return u < v;
    }
    return a < b;
  }

  int n_, width_;
  std::vector<double> rows_;
  std::vector<int> basic_;
};

/// Runs the pivots; on a ray `direction` receives its v part.
LcpStatus run_lemke(LemkeTableau& t, const StandardForm& f, int limit, int& pivots,
                    std::vector<double>& direction) {
  int r = t.first_leaving();
  if (t.right(r) >= 0) return LcpStatus::solved;
  int entering = t.covering();
  for (pivots = 1;; ++pivots) {
    charge_work(size_t(f.size), 2 * size_t(f.size));
    const int left = t.basic(r);
    t.pivot(r, entering);
    if (left == t.covering()) return LcpStatus::solved;
    if (pivots >= limit || stop_requested()) return LcpStatus::max_iterations;
    entering = t.complement(left);
    r = t.leaving(entering);
    if (r >= 0) continue;
    direction.assign(size_t(f.size), 0.0);
    if (entering >= f.size) direction[size_t(entering - f.size)] = 1;
    for (int k = 0; k < f.size; ++k)
      if (t.basic(k) >= f.size && t.basic(k) < 2 * f.size)
        direction[size_t(t.basic(k) - f.size)] = -t.row(k)[entering];
    return LcpStatus::ray;
  }
}

}  // namespace

Result<LcpSolution> lemke(const LcpProblem& problem, const LcpOptions& options) {
  if (Status c = check(problem); !c) return c.error();
  if (!all_slide(problem))
    return Error{ErrorCode::unsupported, "lemke solves sliding groups only", "lcp",
                 "use baraff or cone_newton"};
  const StandardForm form(problem);
  LemkeTableau tableau(form);
  const int limit = options.max_iterations > 0 ? options.max_iterations : 50 * form.size + 2000;
  LcpSolution out;
  out.report.solver = "lemke";
  std::vector<double> direction;
  out.report.status = form.size == 0
                          ? LcpStatus::solved
                          : run_lemke(tableau, form, limit, out.report.iterations, direction);
  std::vector<double> v(size_t(form.size), 0.0);
  for (int r = 0; r < form.size; ++r) {
    const int k = tableau.basic(r) - form.size;
    if (k >= 0 && k < form.size) v[size_t(k)] = std::max(0.0, tableau.right(r));
  }
  out.z = form.back(v, false);
  if (out.report.solved()) polish(problem, options, out);
  if (out.report.status == LcpStatus::ray) {
    out.ray = form.back(direction, true);
    if (problem.groups.empty() && check_symmetric(problem).ok() &&
        ray_residual(problem, out.ray) < tolerances::ray_proof)
      out.report.status = LcpStatus::infeasible;
  }
  grade(problem, options.tolerance, out);
  return out;
}

}  // namespace tumble::lcp
