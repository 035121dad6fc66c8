#pragma once
#include "engine/collision/surface_element.hpp"
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// Shape::element_at() of a shape of a body, all in the body's frame (origin at the centre of mass,
/// body axes).
SurfaceElement element_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// Likewise Shape::border_at().
SurfaceElement border_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// Whether an element is a piece of the shape itself, not a material point somewhere on it.
bool is_feature(const BodyShape& shape, const SurfaceElement& element);

}  // namespace tumble
