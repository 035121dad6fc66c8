#include "engine/dynamics/contact/exact/event_contact.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The elements of one manifold point. Faces are planes only where the other side has a corner, an
/// edge or something round on them: of two faces the one without corners there is the plane.
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
  if (c.a.kind == plane && c.b.kind == line) c.b = border_at(sb, pb, nb);
  if (c.b.kind == plane && c.a.kind == line) c.a = border_at(sa, pa, na);
  if (c.a.kind == plane && c.b.kind == line) c.b = material_point(pb);
  if (c.b.kind == plane && c.a.kind == line) c.a = material_point(pa);
  if (!known_pair(c.a.kind, c.b.kind) ||
      !element_gap(c.a, {a.pose}, c.b, {b.pose}, normal).regular) {
    // Rims on edges, corners on corners: the tangent plane of A and the material point of B.
    c.a = {plane, pa, na, 0};
    c.b = material_point(pb);
  }
}

bool same_shapes(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

/// A rim that rolls has one element; the other points of its manifold lie on the same circle.
void drop_rim_points(std::vector<EventContact>& contacts, size_t first) {
  const auto rim = [](const EventContact& c) {
    return c.a.kind == ElementKind::circle || c.b.kind == ElementKind::circle;
  };
  if (std::none_of(contacts.begin() + std::ptrdiff_t(first), contacts.end(), rim)) return;
  contacts.erase(std::remove_if(contacts.begin() + std::ptrdiff_t(first), contacts.end(),
                                [&](const EventContact& c) { return !rim(c); }),
                 contacts.end());
}

const EventContact* find_before(std::span<const EventContact> before, const EventContact& c) {
  for (const EventContact& old : before)
    if (same_shapes(old.key, c.key) && old.feature == c.feature && old.key.part == c.key.part)
      return &old;
  return nullptr;
}

}  // namespace

BodyMotion motion_of(const RigidBody& body) {
  return {body.pose, body.v, body.omega};
}

ElementGap gap_now(const EventContact& c, std::span<const RigidBody> bodies) {
  return element_gap(c.a, motion_of(bodies[c.key.body_a]), c.b, motion_of(bodies[c.key.body_b]),
                     c.towards_b);
}

std::vector<EventContact> find_event_contacts(std::span<const RigidBody> bodies,
                                              std::span<const EventPair> pairs,
                                              NarrowPhase narrow_phase,
                                              const HierarchyKind* hierarchy,
                                              std::span<const EventContact> before) {
  std::vector<EventContact> out;
  std::vector<Manifold> manifolds;
  for (const EventPair& pair : pairs) {
    const RigidBody &a = bodies[pair.a.body], &b = bodies[pair.b.body];
    const BodyShape &sa = a.shapes[pair.a.shape], &sb = b.shapes[pair.b.shape];
    manifolds.clear();
    narrow_phase(*sa.shape, a.pose * sa.pose, *sb.shape, b.pose * sb.pose,
                 ContactQuery(pair.margin, hierarchy), manifolds);
    const CombinedMaterial material = combine(sa.material, sb.material);
    const size_t first = out.size();
    for (const Manifold& m : manifolds) {
      for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[size_t(i)];
        EventContact& c = out.emplace_back();
        c.key = {pair.a.body, pair.a.shape, pair.b.body, pair.b.shape, m.part};
        c.feature = p.feature;
        c.towards_b = m.normal;
        c.friction = material.friction;
        c.restitution = material.restitution;
        c.surface_velocity = a.pose.direction(sa.material.surface_velocity) -
                             b.pose.direction(sb.material.surface_velocity);
        choose_elements(c, a, b, p.x_world - 0.5 * p.gap * m.normal,
                        p.x_world + 0.5 * p.gap * m.normal, m.normal);
      }
    }
    drop_rim_points(out, first);
    for (size_t k = first; k < out.size(); ++k) {
      EventContact& c = out[k];
      const ElementGap g = gap_now(c, bodies);
      const EventContact* old = find_before(before, c);
      if (old) {
        c.offset = old->offset;
        c.impacts = old->impacts;
        c.closed = old->closed;
        c.force = old->force;
        c.impulse = old->impulse;
      }
      if (!old && c.room(g) < -touch_distance) c.offset = -g.gap;
    }
  }
  return out;
}

}  // namespace tumble
