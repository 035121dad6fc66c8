#include "engine/geometry/primitive_tests/box_pairs.hpp"

#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/support_face.hpp"

namespace tumble {

bool boxes_intersect(const OrientedBox& a, const OrientedBox& b) {
  return contains_origin(difference(a, b));
}

std::optional<PrimitiveContact> box_box_contact(const OrientedBox& a, const OrientedBox& b) {
  const SumSet set = difference(a, b);
  if (!contains_origin(set)) return std::nullopt;
  return deepest_contact(a, b, set);
}

namespace {

/// Whether a box that is a segment along X meets a triangle, by exact orientations; nothing if it
/// meets the border of the triangle's projection along X, or that has no area.
std::optional<bool> segment_meets(const Aabb& segment, const Triangle3& t) {
  const auto shadow = [](const Vec3& p) { return Vec2(p.y(), p.z()); };
  int left = 0, right = 0;
  for (size_t k = 0; k < 3; ++k) {
    const int side = orientation(shadow(t[k]), shadow(t[(k + 1) % 3]), shadow(segment.min));
    left += side > 0;
    right += side < 0;
  }
  if (left > 0 && right > 0) return false;
  if (left < 3 && right < 3) return std::nullopt;
  return orientation(t[0], t[1], t[2], segment.min) * orientation(t[0], t[1], t[2], segment.max) <=
         0;
}

}  // namespace

bool box_triangle_intersect(const OrientedBox& box, const Triangle3& t) {
  return contains_origin(difference(box, t));
}

bool box_triangle_intersect(const Aabb& box, const Triangle3& t) {
  Aabb around;
  for (const Vec3& c : t) around.include(c);
  if (box.empty() || !around.overlaps(box)) return false;
  // The rays of point_in_object.
  if (box.min.y() == box.max.y() && box.min.z() == box.max.z())
    if (const auto meets = segment_meets(box, t)) return *meets;
  return contains_origin(difference(box, t));
}

std::optional<PrimitiveContact> box_triangle_contact(const OrientedBox& box, const Triangle3& t) {
  const SumSet set = difference(box, t);
  if (!contains_origin(set)) return std::nullopt;
  return deepest_contact(box, t, set);
}

bool segment_box_intersect(const Segment& s, const OrientedBox& box) {
  return contains_origin(difference(s, box));
}

bool segment_box_intersect(const Vec3& p, const Vec3& q, const Aabb& box) {
  Aabb around;
  around.include(p);
  around.include(q);
  return !box.empty() && around.overlaps(box) && contains_origin(difference(Segment{p, q}, box));
}

std::optional<PrimitiveContact> segment_box_contact(const Segment& s, const OrientedBox& box) {
  const SumSet set = difference(s, box);
  if (!contains_origin(set)) return std::nullopt;
  return deepest_contact(s, box, set);
}

bool point_in_box(const Vec3& p, const OrientedBox& box) {
  return contains_origin(difference(p, box));
}

}  // namespace tumble
