#pragma once
#include "viewer/render/camera.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A key of a camera's flight.
struct CameraKey {
  double time = 0;  ///< [s]
  Camera camera;
  std::string follow{};          ///< a body with which eye and target translate; "": none
  Vec3 follow_x = Vec3::Zero();  ///< position of that body at the key's time [m]
};

/// The camera of a flight at a time: through every key at its time, with continuous velocity (cubic
/// Hermite interpolation; the slope at an inner key is that of the parabola through it and its
/// neighbours), at rest before the first and after the last key. There must be at least one key, in
/// ascending order of time.
Camera camera_at(const std::vector<CameraKey>& path, double time);

/// The keys moved by the present displacement of the bodies that they follow; `place_of` gives a
/// body's present position (empty: it does not exist, and the key stays). The flight interpolates
/// keys moved in this way, so it goes along with a body that both follow, from one body to another,
/// or from a body to a fixed place.
std::vector<CameraKey> carried_along(
    const std::vector<CameraKey>& path,
    const std::function<std::optional<Vec3>(const std::string& body)>& place_of);

}  // namespace tumble
