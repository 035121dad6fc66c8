#pragma once
#include "engine/collision/surface_element.hpp"
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// Shape::element_at() of a shape of a body; point, direction and result in the body's frame
/// (origin at the centre of mass, body axes).
SurfaceElement element_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// Shape::border_at(), likewise.
SurfaceElement border_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// Whether an element is a feature of the shape (all but points that are no corner or centre of
/// it), not just a material point of its surface.
bool is_feature(const BodyShape& shape, const SurfaceElement& element);

}  // namespace tumble
