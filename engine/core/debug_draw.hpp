#pragma once
#include <string_view>

#include <Eigen/Core>

namespace tumble {

/// Where an algorithm draws what it sees. The viewer shows it, a recorder keeps it, tests count it.
/// Positions in world axes [m]; colours are linear RGBA in 0..1. Compound shapes (arrows, boxes,
/// frames) are free functions on top of these three.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;
  virtual void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                    const Eigen::Vector4f& colour) = 0;
  virtual void point(const Eigen::Vector3d& x, const Eigen::Vector4f& colour, float pixels) = 0;
  virtual void text(const Eigen::Vector3d& x, const Eigen::Vector4f& colour,
                    std::string_view s) = 0;
};

}  // namespace tumble
