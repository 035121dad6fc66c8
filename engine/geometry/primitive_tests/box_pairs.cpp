#include "engine/geometry/primitive_tests/box_pairs.hpp"

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

bool box_triangle_intersect(const OrientedBox& box, const Triangle3& t) {
  return contains_origin(difference(box, t));
}

bool box_triangle_intersect(const Aabb& box, const Triangle3& t) {
  Aabb around;
  for (const Vec3& c : t) around.include(c);
  return !box.empty() && around.overlaps(box) && contains_origin(difference(box, t));
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
