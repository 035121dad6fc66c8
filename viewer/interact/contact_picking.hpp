#pragma once
#include "engine/world/frame.hpp"
#include "viewer/render/camera.hpp"

#include <optional>
#include <span>

namespace tumble {

/// A point where two bodies touch, to be found again in later pictures.
struct ContactPick {
  BodyId a, b;
  Vec3 x_world = Vec3::Zero();  ///< where it was last [m]
};

/// The contact that is drawn nearest to a place of the picture, and no farther than `reach` from
/// it; of those drawn at one place the one nearest to the eye. All in the units of width and
/// height.
std::optional<ContactPick> pick_contact(const Frame& frame, const Camera& camera, double x,
                                        double y, double width, double height, double reach = 9);

}  // namespace tumble
