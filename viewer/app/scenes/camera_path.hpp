#pragma once
#include "viewer/render/camera.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Where a camera is at a moment of its flight.
struct CameraKey {
  double time = 0;  ///< [s]
  Camera camera;
  std::string follow{};          ///< a body that eye and target move along with; "": none
  Vec3 follow_x = Vec3::Zero();  ///< where that body was at the key's time [m]
};

/// The camera of a flight at a moment: through every key at its time, with a speed that does not
/// jump (cubic Hermite, the slope at an inner key that of the parabola through it and its
/// neighbours), at rest before the first and after the last. Keys ascend in time; at least one.
Camera camera_at(const std::vector<CameraKey>& path, double time);

/// The keys as they are while the bodies that they follow are where `place_of` says (nothing: it is
/// not there, and the key stays where it was). A flight goes between keys that move so: along with
/// a body that both follow, from one body to another, or from one to a fixed place.
std::vector<CameraKey> carried_along(
    const std::vector<CameraKey>& path,
    const std::function<std::optional<Vec3>(const std::string& body)>& place_of);

}  // namespace tumble
