#include "engine/math/lcp/pivoting/block_start.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

void find_beyond(const PivotState& s, double tolerance, std::vector<int>& positions) {
  positions.clear();
  const auto& members = s.members();
  for (int k = 0; k < int(members.size()); ++k)
    if (std::fabs(s.beyond(members[size_t(k)])) > tolerance) positions.push_back(k);
}

void find_wrong(const PivotState& s, std::vector<int>& indices) {
  indices.clear();
  for (int i = 0; i < s.n; ++i)
    if (s.wrong(i) > s.tolerance()) indices.push_back(i);
}

// Charges the work of the state's operations: a triangular solve for each unknown that is clamped,
// and for each that is freed an update of the factor, or a new factorisation if that is less.

bool pay_and_clamp(PivotState& s, int i) {
  const size_t m = s.members().size();
  charge_work(m + 1, m / 2 + 1);
  return s.enter(i, tolerances::least_start_pivot);
}
void pay_and_free(PivotState& s, const std::vector<int>& positions) {
  const size_t m = s.members().size();
  charge_work(m, m, std::min(positions.size(), m / 6 + 1));
  s.leave_many(positions);
}
void pay_and_solve(PivotState& s) {
  charge_work(size_t(s.n), 2 * s.members().size() + 1);
  s.solve();
}

}  // namespace

void restore_bounds(PivotState& s) {
  std::vector<int> out;
  for (;;) {
    find_beyond(s, s.tolerance(), out);
    if (out.empty() || stop_requested()) break;
    pay_and_free(s, out);
    pay_and_solve(s);
  }
}

void block_start(PivotState& s) {
  for (int i = 0; i < s.n && !stop_requested(); ++i)
    if (s.role[size_t(i)] == Role::resting) pay_and_clamp(s, i);
  pay_and_solve(s);
  std::vector<int> out, in;
  size_t best = size_t(s.n) + 1;
  for (int allowance = 3; allowance > 0 && !stop_requested();) {
    find_beyond(s, s.tolerance(), out);
    find_wrong(s, in);
    const size_t count = out.size() + in.size();
    if (count == 0) return;
    if (count < best) {
      best = count;
      allowance = 3;
    } else {
      --allowance;
    }
    pay_and_free(s, out);
    bool changed = !out.empty();
    for (size_t k = 0; k < in.size() && !stop_requested(); ++k) changed |= pay_and_clamp(s, in[k]);
    if (!changed) break;
    pay_and_solve(s);
  }
  restore_bounds(s);
}

}  // namespace tumble::lcp
