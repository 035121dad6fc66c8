#pragma once
#include "viewer/ui/measures.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Reading of a ruler between two points, or of a protractor at three.
struct RulerReading {
  Quantity quantity;  ///< the distance [m] or the angle [rad], for plotting
  double value = 0;   ///< now, or when all of its bodies existed last
  bool there = true;  ///< all of its bodies exist
  bool angle = false;
  Vec3 apart = Vec3::Zero();  ///< of a ruler: from the first point to the second [m]
};

/// Rulers and protractors in the scene, and the progress in placing the next one.
struct RulerView {
  std::vector<RulerReading> readings;
  size_t picked = 0;  ///< points of the next one that are already placed
};
inline const RulerView no_rulers;

}  // namespace tumble
