#include "engine/collision/shapes/cylinder.hpp"

#include "engine/collision/shapes/validation.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"

#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr double half_root = 0.70710678118654752440;
/// Directions of the rim points, counter-clockwise about +y seen from above (x, z).
constexpr std::array<std::array<double, 2>, CylinderShape::rim_points> rim{
    {{1, 0},
     {half_root, -half_root},
     {0, -1},
     {-half_root, -half_root},
     {-1, 0},
     {-half_root, half_root},
     {0, 1},
     {half_root, half_root}}};
/// Id of the rim point that follows the tilt; the fixed ones are 0 .. 7 (top) and 8 .. 15.
constexpr uint32_t tilt_id = 16;

}  // namespace

Result<std::shared_ptr<const Shape>> CylinderShape::make(const ShapeDef& def) {
  if (auto s = require_positive("radius", def.radius); !s) return s.error();
  if (auto s = require_positive("height", def.height); !s) return s.error();
  return std::shared_ptr<const Shape>(new CylinderShape(def));
}

double CylinderShape::bounding_radius() const {
  return std::sqrt(radius() * radius() + half_height_ * half_height_);
}

Result<MassProperties> CylinderShape::mass_properties() const {
  return cylinder_mass(half_height_, radius());
}

std::optional<RayHit> CylinderShape::ray_cast(const Vec3& origin, const Vec3& direction,
                                              double t_max) const {
  return ray_cylinder({origin, direction}, half_height_, radius(), t_max);
}

Vec3 CylinderShape::support(const Vec3& d) const {
  const double y = d.y() < 0 ? -half_height_ : half_height_;
  const double lateral = std::sqrt(d.x() * d.x() + d.z() * d.z());
  if (lateral == 0) return {0, y, 0};
  const double f = radius() / lateral;
  return {f * d.x(), y, f * d.z()};
}

void CylinderShape::supporting_face(const Vec3& direction, SupportingFace& face) const {
  const double lateral = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
  face.count = 0;
  if (lateral > std::abs(direction.y())) {
    const double x = radius() * direction.x() / lateral, z = radius() * direction.z() / lateral;
    face.add({x, -half_height_, z}, tilt_id + 1);
    face.add({x, half_height_, z}, tilt_id + 2);
    return;
  }
  const bool top = direction.y() > 0;
  const double y = top ? half_height_ : -half_height_;
  // The rim point that a tilt puts furthest out keeps one id all the way round, so that a coin
  // rolling on its rim keeps its contact. A level cap rests on the fixed points alone.
  const bool tilted = lateral > 1e-4;
  const double ex = tilted ? direction.x() / lateral : 0, ez = tilted ? direction.z() / lateral : 0;
  for (uint32_t i = 0; i < rim_points; ++i) {
    const uint32_t k = top ? i : rim_points - 1 - i;
    const uint32_t next = top ? (k + 1) % rim_points : (k + rim_points - 1) % rim_points;
    face.add({radius() * rim[k][0], y, radius() * rim[k][1]}, k + (top ? 0 : rim_points));
    if (!tilted) continue;
    // between this rim point and the next, by the signs of two cross products about the axis
    const double from = rim[k][1] * ex - rim[k][0] * ez;
    const double to = ez * rim[next][0] - ex * rim[next][1];
    const double toward = rim[k][0] * ex + rim[k][1] * ez;
    if (toward > 0 && (top ? from > 1e-6 && to > 1e-6 : from < -1e-6 && to < -1e-6))
      face.add({radius() * ex, y, radius() * ez}, tilt_id);
  }
}

}  // namespace tumble
