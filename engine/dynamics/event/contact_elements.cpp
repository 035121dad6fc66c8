#include "engine/dynamics/event/contact_elements.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool is_sharp_point(const SurfaceElement& e) {
  return e.kind == ElementKind::point && e.radius == 0;
}

/// Whether a surface has a unique normal at each of its points.
bool is_smooth(const SurfaceElement& e) {
  using enum ElementKind;
  return e.kind == plane || e.kind == ellipsoid || e.kind == cone ||
         (e.kind != circle && e.radius > 0);
}

/// Whether a sharp point lies on the rim.
bool is_on_rim(const SurfaceElement& point, const SurfaceElement& rim) {
  const double near = tolerances::on_rim_of_radius * rim.radius;
  const Vec3 arm = point.origin - rim.origin;
  const double along = rim.direction.dot(arm);
  return std::fabs(along) <= near &&
         std::fabs((arm - along * rim.direction).norm() - rim.radius) <= near;
}

}  // namespace

bool is_straight(const SurfaceElement& e) {
  return e.kind == ElementKind::line || e.kind == ElementKind::cone;
}

void choose_tangent(EventContact& c, const RigidBody& a, const RigidBody& b, const Vec3& on_a,
                    const Vec3& on_b, const Vec3& normal) {
  c.a = {ElementKind::plane, a.pose.inverse_point(on_a), a.pose.inverse_direction(normal), 0};
  c.b = material_point(b.pose.inverse_point(on_b));
}

void choose_elements(EventContact& c, const RigidBody& a, const RigidBody& b, const Vec3& on_a,
                     const Vec3& on_b, const Vec3& normal) {
  using enum ElementKind;
  const BodyShape &sa = a.shapes[c.key.shape_a], &sb = b.shapes[c.key.shape_b];
  const Vec3 pa = a.pose.inverse_point(on_a), na = a.pose.inverse_direction(normal);
  const Vec3 pb = b.pose.inverse_point(on_b), nb = b.pose.inverse_direction(-normal);
  c.a = element_at(sa, pa, na);
  c.b = element_at(sb, pb, nb);
  if (c.a.kind == plane && c.b.kind == plane) {
    const SurfaceElement corner_b = border_at(sb, pb, nb), corner_a = border_at(sa, pa, na);
    const bool at_a = corner_a.kind == point && corner_a.origin != pa;
    const bool at_b = corner_b.kind == point && corner_b.origin != pb;
    if (at_a && !at_b) {
      c.a = corner_a;
    } else {
      c.b = corner_b.kind == point ? corner_b : material_point(pb);
    }
  }
  if (c.a.kind == plane && is_straight(c.b)) c.b = border_at(sb, pb, nb);
  if (c.b.kind == plane && is_straight(c.a)) c.a = border_at(sa, pa, na);
  if (c.a.kind == plane && is_straight(c.b)) c.b = material_point(pb);
  if (c.b.kind == plane && is_straight(c.a)) c.a = material_point(pa);
  if (known_pair(c.a.kind, c.b.kind)) {
    const ElementPlace g = element_place(c.a, {a.pose}, c.b, {b.pose}, normal);
    const bool corners =
        (is_sharp_point(c.a) && !is_smooth(c.b)) || (is_sharp_point(c.b) && !is_smooth(c.a));
    if (g.regular && !(corners && g.gap < tolerances::corners_touch)) return;
  }
  choose_tangent(c, a, b, on_a, on_b, normal);
}

void drop_rim_points(std::vector<EventContact>& contacts, size_t first) {
  using enum ElementKind;
  std::vector<SurfaceElement> rims_a, rims_b;
  for (size_t k = first; k < contacts.size(); ++k) {
    const EventContact& c = contacts[k];
    if (c.a.kind == circle && c.b.kind == plane) rims_a.push_back(c.a);
    if (c.a.kind == plane && c.b.kind == circle) rims_b.push_back(c.b);
  }
  if (rims_a.empty() && rims_b.empty()) return;
  const auto on_one = [](const SurfaceElement& e, const std::vector<SurfaceElement>& rims) {
    return is_sharp_point(e) &&
           std::ranges::any_of(rims, [&](const auto& rim) { return is_on_rim(e, rim); });
  };
  const auto on_rim = [&](const EventContact& c) {
    return (c.b.kind == plane && on_one(c.a, rims_a)) || (c.a.kind == plane && on_one(c.b, rims_b));
  };
  const auto begin = contacts.begin() + std::ptrdiff_t(first);
  contacts.erase(std::remove_if(begin, contacts.end(), on_rim), contacts.end());
}

bool lies_flat(const EventContact& c, const ElementPlace& g, std::span<const RigidBody> bodies) {
  const auto flat = [&](const SurfaceElement& e, const Pose& body) {
    return e.kind == ElementKind::circle &&
           body.direction(e.direction).cross(g.normal).norm() <= tolerances::same_place_of_size;
  };
  return flat(c.a, bodies[c.key.body_a].pose) || flat(c.b, bodies[c.key.body_b].pose);
}

}  // namespace tumble
