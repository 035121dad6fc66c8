#pragma once
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>

namespace tumble {

/// A force along one direction that never increases with the velocity v along it: the sum of parts,
/// each
///   clamp(force - gain v, least, most)
/// (dampers, motors of limited force, constant forces), or a step at a velocity: `most` below that
/// velocity, `least` above it, anything between at it (dry friction, hard limits, motors that hold
/// a rate). Bounds may be infinite. As a set-valued map of v it is maximal monotone (decreasing),
/// so that the problem of solve() always has exactly one solution.
class ForceLaw {
 public:
  static constexpr size_t most_parts = 8;

  void clear() { count_ = 0; }
  /// Parts are numbered in the order in which they are added.
  size_t add(double force, double gain, double least, double most) {
    return put({force, gain, 0, least, most, false});
  }
  /// A step that is unbounded on both sides holds the velocity nearest to `at` that the steps added
  /// before it allow: steps that are unbounded on one side, as limits are, exclude others.
  size_t add_step(double at, double least, double most) {
    return put({0, 0, unbounded(least, most) ? allowed(at) : at, least, most, true});
  }
  size_t size() const { return count_; }
  /// The velocity at which a step lies.
  double step_at(size_t part) const { return parts_[part].at; }

  struct Solution {
    double v = 0;      ///< velocity with the force
    double force = 0;  ///< sum of all parts at velocity v
    std::array<double, most_parts> parts{};
  };
  /// Solves v = free + compliance F(v) with this law F exactly, by its breakpoints. If several
  /// steps lie at v they share the force in their order. With zero compliance the force is 0.
  Solution solve(double free, double compliance) const;

 private:
  struct Part {
    double force = 0, gain = 0, at = 0, least = 0, most = 0;
    bool step = false;
    /// Limits of the force from below and from above v; they differ at a step.
    double left(double v) const;
    double right(double v) const;
  };
  static bool unbounded(double least, double most) { return std::isinf(least) && std::isinf(most); }
  double allowed(double v) const;
  size_t put(const Part& part) {
    assert(count_ < most_parts);
    parts_[count_] = part;
    return count_++;
  }
  std::span<const Part> all() const { return {parts_.data(), count_}; }
  Solution shares_at(double v, double free, double compliance) const;
  double between(double below, double above, double free, double compliance) const;

  size_t count_ = 0;
  std::array<Part, most_parts> parts_;
};

}  // namespace tumble
