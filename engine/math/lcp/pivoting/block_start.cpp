#include "engine/math/lcp/pivoting/block_start.hpp"

#include "engine/math/lcp/tolerances.hpp"

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

}  // namespace

void restore_bounds(PivotState& s) {
  std::vector<int> out;
  for (;;) {
    find_beyond(s, s.tolerance(), out);
    if (out.empty()) break;
    s.leave_many(out);
    s.solve();
  }
}

void block_start(PivotState& s) {
  for (int i = 0; i < s.n; ++i)
    if (s.role[size_t(i)] == Role::resting) s.enter(i, tolerances::least_start_pivot);
  s.solve();
  std::vector<int> out, in;
  size_t best = size_t(s.n) + 1;
  for (int allowance = 3; allowance > 0;) {
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
    s.leave_many(out);
    bool changed = !out.empty();
    for (const int i : in) changed |= s.enter(i, tolerances::least_start_pivot);
    if (!changed) break;
    s.solve();
  }
  restore_bounds(s);
}

}  // namespace tumble::lcp
