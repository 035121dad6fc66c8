#pragma once
#include "engine/collision/motion.hpp"

#include <cstdint>

namespace tumble {

/// Nearest points of two shapes at one moment.
struct Nearest {
  /// Never more than the true distance; 0 when they overlap [m]
  double distance = 0;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< world [m]
  /// Unit, from A to B: all of A is behind a plane across it, and B `distance` beyond. Zero when
  /// they overlap.
  Vec3 normal = Vec3::Zero();
  uint32_t triangle_a = 0, triangle_b = 0;  ///< that are nearest, of meshes
};

/// The distance of two shapes in motion as a function of time, with bounds on how fast it changes:
/// all that the methods which look for its first root need to know.
class MovingDistance {
 public:
  MovingDistance(const Motion& a, const Motion& b) : a_(a), b_(b) {}
  virtual ~MovingDistance() = default;

  /// At time t [s]. Distances beyond `reach` [m] need not be exact, only not too long. Remembers
  /// where it ended, for the next call.
  virtual Nearest at(double t, double reach) = 0;
  /// Bound on how fast the gap along `n` closes at any time, for a normal that at() gave; along -n
  /// how fast it opens [m/s].
  virtual double approach(const Vec3& n) const = 0;
  /// How long from time t on a gap of `gap` [m] along `n`, for a normal that at(t) gave, is sure
  /// not to close [s].
  virtual double open_for(const Vec3& n, double t, double gap) const;
  /// Bound on the closing speed in any direction [m/s].
  double fastest() const { return fastest_; }
  /// How fast the points that are nearest at time t approach each other [m/s].
  double closing(const Nearest& near, double t) const;

 protected:
  const Motion &a_, &b_;
  double fastest_ = 0;
};

}  // namespace tumble
