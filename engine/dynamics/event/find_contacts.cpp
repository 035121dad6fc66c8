#include "engine/dynamics/event/find_contacts.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/contact_elements.hpp"
#include "engine/dynamics/event/earlier_contacts.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Removes points that several manifolds, or a face and its nearest point, have in common.
void drop_duplicates(std::span<const RigidBody> bodies, double near,
                     std::vector<EventContact>& contacts, size_t first) {
  std::vector<ElementPlace> seen;
  const auto again = [&](const EventContact& c) {
    const ElementPlace g = place_now(c, bodies);
    for (const ElementPlace& o : seen)
      if ((o.x_world - g.x_world).norm() <= near && o.normal.dot(g.normal) > 1 - near) return true;
    seen.push_back(g);
    return false;
  };
  contacts.erase(std::remove_if(contacts.begin() + std::ptrdiff_t(first), contacts.end(), again),
                 contacts.end());
}

/// Whether the elements chosen for a manifold point describe the shapes there: they overlap no
/// deeper than the shapes, and edges do not meet beyond their ends.
bool plausible(const ElementPlace& g, const EventPair& pair, const Vec3& x_world, double size) {
  if (!g.regular) return false;
  if (g.gap < pair.gap.gap - tolerances::deepest_unseen) return false;
  return g.gap > tolerances::far_off_of_size * size ||
         (g.x_world - x_world).norm() <= tolerances::far_off_of_size * size + std::fabs(g.gap);
}

/// Whether a manifold point is deeper than the shapes are, and than the accepted depth: where
/// surfaces cross only by rounding, the depth of the narrow phase may be wrong.
bool too_deep(const ManifoldPoint& p, const PairGap& pair, double accepted) {
  const double deepest = pair.gap - tolerances::deepest_unseen;
  const bool touch = pair.near && pair.gap >= -tolerances::deepest_unseen;
  return p.gap < deepest && (touch || p.gap < -accepted - tolerances::deepest_unseen);
}

void keep(EventContact& c, const EventContact& old) {
  c.offset = old.offset;
  c.impacts = old.impacts;
  c.closed = old.closed;
  c.force = old.force;
  c.impulse = old.impulse;
}

}  // namespace

std::vector<EventContact> find_event_contacts(std::span<const RigidBody> bodies,
                                              std::span<EventPair> pairs, NarrowPhase narrow_phase,
                                              const HierarchyKind* hierarchy,
                                              std::span<const EventContact> before,
                                              bool accept_overlap) {
  std::vector<EventContact> out;
  std::vector<Manifold> manifolds;
  const std::vector<const EventContact*> known = by_shapes(before);
  for (EventPair& pair : pairs) {
    if (stop_requested()) {
      pair.first_contact = pair.contacts = 0;
      continue;
    }
    charge_work(prices::pair);
    const PairShapes s(pair, bodies);
    manifolds.clear();
    find_manifolds(s, pair, narrow_phase, hierarchy, manifolds);
    const CombinedMaterial material = combine(s.sa.material, s.sb.material);
    Continued continued(bodies, known, {pair.a.body, pair.a.shape, pair.b.body, pair.b.shape, 0});
    const size_t first = out.size();
    const double limit =
        accept_overlap && continued.none() ? tolerances::no_limit : continued.offset();
    const auto add = [&](const Manifold& m) {
      for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[size_t(i)];
        if (too_deep(p, pair.gap, limit)) continue;
        charge_work(prices::contact);
        EventContact& c = out.emplace_back();
        c.key = {pair.a.body, pair.a.shape, pair.b.body, pair.b.shape, m.part};
        c.feature = p.feature;
        c.towards_b = m.normal;
        c.friction = material.friction;
        c.restitution = material.restitution;
        c.surface_velocity = s.a.pose.direction(s.sa.material.surface_velocity) -
                             s.b.pose.direction(s.sb.material.surface_velocity);
        const Vec3 on_a = p.x_world - 0.5 * p.gap * m.normal;
        const Vec3 on_b = p.x_world + 0.5 * p.gap * m.normal;
        choose_elements(c, s.a, s.b, on_a, on_b, m.normal);
        const ElementPlace g = place_now(c, bodies);
        const bool nearest = p.gap <= pair.gap.gap + tolerances::nearest_of_size * s.size();
        if (nearest &&
            !(std::fabs(g.gap - p.gap) <= tolerances::same_gap_of_size * s.size() +
                                              tolerances::same_gap_of_gap * std::fabs(p.gap)))
          choose_tangent(c, s.a, s.b, on_a, on_b, m.normal);
        else if (!plausible(g, pair, p.x_world, s.size()))
          out.pop_back();
      }
    };
    for (const Manifold& m : manifolds) add(m);
    // A pair that overlaps must not be left without a contact because all that were found are
    // implausible.
    const bool inside = pair.gap.near && pair.gap.gap < -tolerances::seen_depth;
    if (inside && out.size() == first) add(nearest_point(pair.gap));
    drop_rim_points(out, first);
    drop_duplicates(bodies, tolerances::same_place_of_size * s.size(), out, first);
    pair.offset = 0;
    for (size_t k = first; k < out.size(); ++k) {
      EventContact& c = out[k];
      const ElementPlace g = place_now(c, bodies);
      if (const EventContact* old =
              continued.of(c, g.x_world, tolerances::same_place_of_size * s.size())) {
        keep(c, *old);
      } else if (g.gap < -tolerances::touch_distance) {
        c.offset = std::min(-g.gap, limit);
      }
      pair.offset = std::max(pair.offset, c.offset);
    }
    keep_near(continued, bodies, pair, first, out);
    drop_rim_points(out, first);
    pair.first_contact = first;
    pair.contacts = out.size() - first;
  }
  return out;
}

}  // namespace tumble
