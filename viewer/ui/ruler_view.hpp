#pragma once
#include "viewer/ui/measures.hpp"

#include <string>
#include <vector>

namespace tumble {

/// What a ruler between two points, or a protractor at three, says.
struct RulerReading {
  Quantity quantity;  ///< the distance [m], or the angle [rad]; to be plotted
  double value = 0;   ///< now, or when all of its bodies were there last
  bool there = true;  ///< all of them are
  bool angle = false;
  Vec3 apart = Vec3::Zero();  ///< of a distance: from the first point to the second [m]
};

/// Rulers and protractors in the scene, and how far the next one has come.
struct RulerView {
  std::vector<RulerReading> readings;
  size_t picked = 0;  ///< points of the next one
};
inline const RulerView no_rulers;

}  // namespace tumble
