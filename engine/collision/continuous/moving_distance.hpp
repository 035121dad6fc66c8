#pragma once
#include "engine/collision/motion.hpp"

#include <cstdint>

namespace tumble {

/// Nearest points of two shapes at one time.
struct Nearest {
  /// Never more than the true distance; 0 when they overlap [m]
  double distance = 0;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< world [m]
  /// Unit, from A to B: A is behind a plane with this normal, and B is `distance` beyond it. Zero
  /// when they overlap.
  Vec3 normal = Vec3::Zero();
  uint32_t triangle_a = 0, triangle_b = 0;  ///< the nearest triangles, of meshes
};

/// The distance of two moving shapes as a function of time, with bounds on its rate of change: the
/// input of methods that search for its first root.
class MovingDistance {
 public:
  MovingDistance(const Motion& a, const Motion& b) : a_(a), b_(b) {}
  virtual ~MovingDistance() = default;

  /// At time t [s]. A distance beyond `reach` [m] need not be exact, but must not be too large. The
  /// next call starts from where this one ended.
  virtual Nearest at(double t, double reach) = 0;
  /// Bound on the rate at which the gap along `n` closes at any time, for a normal that at()
  /// returned; for -n, that at which it opens [m/s].
  virtual double approach(const Vec3& n) const = 0;
  /// Time from t on during which a gap of `gap` [m] along `n`, a normal that at(t) returned, is
  /// proven not to close [s].
  virtual double open_for(const Vec3& n, double t, double gap) const;
  /// Bound on the closing speed in any direction [m/s].
  double fastest() const { return fastest_; }
  /// Speed at which the points that are nearest at time t approach each other [m/s].
  double closing(const Nearest& near, double t) const;

 protected:
  const Motion &a_, &b_;
  double fastest_ = 0;
};

}  // namespace tumble
