#pragma once
#include "viewer/render/camera.hpp"

#include <vector>

namespace tumble {

/// Where a camera is at a moment of its flight.
struct CameraKey {
  double time = 0;  ///< [s]
  Camera camera;
};

/// The camera of a flight at a moment: through every key at its time, with a speed that does not
/// jump (cubic Hermite, the slope at an inner key that of the parabola through it and its
/// neighbours), at rest before the first and after the last. Keys ascend in time; at least one.
Camera camera_at(const std::vector<CameraKey>& path, double time);

}  // namespace tumble
