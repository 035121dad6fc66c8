#pragma once
#include "engine/world/frame.hpp"

namespace tumble {

/// Scales of a world, so that arrows suit marbles and bridges alike.
struct SceneScales {
  double size = 0.5;    ///< typical radius of a dynamic body [m]
  double weight = 9.8;  ///< typical weight of one [N]
};

/// Medians over the dynamic bodies; the defaults where there are none.
SceneScales typical_scales(const Frame& frame);

}  // namespace tumble
