#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/camera.hpp"

#include <optional>
#include <span>

namespace tumble {

/// A point where two bodies touch, which can be found again in later pictures.
struct ContactPick {
  BodyId a, b;
  Vec3 x_world = Vec3::Zero();  ///< last position [m]
};

/// The contact whose mark is nearest to a point of the picture and within `reach` of it; of several
/// marks at the same place, the one nearest to the eye. x, y and reach in the units of width and
/// height.
std::optional<ContactPick> pick_contact(const Frame& frame, const Camera& camera, double x,
                                        double y, double width, double height, double reach = 9);

}  // namespace tumble
