#include "engine/dynamics/joints/force_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

double held_between(double x, double least, double most) {
  return std::min(std::max(x, least), most);
}

}  // namespace

double ForceLaw::Part::left(double v) const {
  if (step) return v <= at ? most : least;
  return held_between(force - gain * v, least, most);
}

double ForceLaw::Part::right(double v) const {
  if (step) return v < at ? most : least;
  return held_between(force - gain * v, least, most);
}

/// The velocity nearest to v that steps unbounded on one side allow.
double ForceLaw::allowed(double v) const {
  for (const Part& p : all()) {
    if (!p.step || unbounded(p.least, p.most)) continue;
    if (std::isinf(p.most)) v = std::max(v, p.at);
    if (std::isinf(p.least)) v = std::min(v, p.at);
  }
  return v;
}

/// The solution at a known velocity: first the parts without a step there, then the rest by the
/// steps in their order.
ForceLaw::Solution ForceLaw::shares_at(double v, double free, double compliance) const {
  Solution out;
  out.v = v;
  bool steps = false;
  for (size_t i = 0; i < count_; ++i) {
    const Part& p = parts_[i];
    if (p.step && p.at == v) {
      steps = true;
      continue;
    }
    out.force += out.parts[i] = p.left(v);
  }
  if (!steps) return out;
  double rest = (v - free) / compliance - out.force;
  for (size_t i = 0; i < count_; ++i) {
    const Part& p = parts_[i];
    if (!p.step || p.at != v) continue;
    out.parts[i] = held_between(rest, p.least, p.most);
    rest -= out.parts[i];
    out.force += out.parts[i];
  }
  return out;
}

/// The solution between two breakpoints, where the law is linear.
double ForceLaw::between(double below, double above, double free, double compliance) const {
  const double inside = std::isinf(below)   ? (std::isinf(above) ? free : above - 1)
                        : std::isinf(above) ? below + 1
                                            : 0.5 * (below + above);
  double force = 0, gain = 0;
  for (const Part& p : all()) {
    const double here = p.left(inside);
    if (p.step || p.gain == 0 || here == p.least || here == p.most) {
      force += here;
    } else {
      force += p.force;
      gain += p.gain;
    }
  }
  return held_between((free + compliance * force) / (1 + compliance * gain), below, above);
}

ForceLaw::Solution ForceLaw::solve(double free, double compliance) const {
  if (!(compliance > 0)) return {.v = free, .force = 0, .parts = {}};
  std::array<double, 2 * most_parts> breaks;
  size_t n = 0;
  for (const Part& p : all()) {
    if (p.step) {
      breaks[n++] = p.at;
    } else if (p.gain > 0) {
      for (const double bound : {p.most, p.least})
        if (std::isfinite(bound)) breaks[n++] = (p.force - bound) / p.gain;
    }
  }
  std::sort(breaks.begin(), breaks.begin() + n);
  double below = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < n; ++i) {
    const double v = breaks[i];
    double left = 0, right = 0;
    for (const Part& p : all()) left += p.left(v), right += p.right(v);
    // free + compliance F(v) - v decreases in v.
    if (free + compliance * left - v < 0)
      return shares_at(between(below, v, free, compliance), free, compliance);
    if (free + compliance * right - v <= 0) return shares_at(v, free, compliance);
    below = v;
  }
  const double above = std::numeric_limits<double>::infinity();
  return shares_at(between(below, above, free, compliance), free, compliance);
}

}  // namespace tumble
