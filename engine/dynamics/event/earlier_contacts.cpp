#include "engine/dynamics/event/earlier_contacts.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/query.hpp"
#include "engine/dynamics/event/contact_elements.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tumble {
namespace {

auto shapes_of(const ContactKey& key) {
  return std::tie(key.body_a, key.body_b, key.shape_a, key.shape_b);
}

/// Feature of nearest points, which do not stay at the same features for long.
constexpr uint64_t nearest_points = feature_key(FeaturePair::closest, 0, 0);

/// Whether the elements of a contact still meet on the surfaces of both shapes.
bool still_there(const ElementPlace& g, const PairShapes& s) {
  const double off = 0.5 * std::fabs(g.gap) + tolerances::same_place_of_size * s.size();
  for (const auto& [shape, pose] : {std::pair(&s.sa, &s.at_a), std::pair(&s.sb, &s.at_b)})
    if (!closest_point(*shape->shape, *pose, g.x_world, off)) return false;
  return true;
}

}  // namespace

std::vector<const EventContact*> by_shapes(std::span<const EventContact> contacts) {
  std::vector<const EventContact*> out;
  for (const EventContact& c : contacts) out.push_back(&c);
  std::stable_sort(out.begin(), out.end(), [](const EventContact* a, const EventContact* b) {
    return shapes_of(a->key) < shapes_of(b->key);
  });
  return out;
}

Continued::Continued(std::span<const RigidBody> bodies, std::span<const EventContact* const> before,
                     const ContactKey& pair) {
  const auto earlier = [](const EventContact* c, const ContactKey& key) {
    return shapes_of(c->key) < shapes_of(key);
  };
  auto at = std::lower_bound(before.begin(), before.end(), pair, earlier);
  for (; at != before.end() && same_shapes((*at)->key, pair); ++at)
    known_.push_back({*at, place_now(**at, bodies)});
}

const EventContact* Continued::of(const EventContact& c, const Vec3& x_world, double near) {
  for (Known& k : known_)
    if (!k.taken && (k.now.x_world - x_world).norm() <= near) return k.taken = true, k.contact;
  if (c.feature == 0 || c.feature == nearest_points) return nullptr;
  for (Known& k : known_)
    if (!k.taken && k.contact->feature == c.feature && k.contact->key.part == c.key.part)
      return k.taken = true, k.contact;
  return nullptr;
}

void keep_near(const Continued& continued, std::span<const RigidBody> bodies, const EventPair& pair,
               size_t first, std::vector<EventContact>& out) {
  const PairShapes s(pair, bodies);
  continued.for_each_left([&](const EventContact& old, const ElementPlace& g) {
    if (out.size() >= first + tolerances::most_kept_contacts) return;
    if (g.gap > tolerances::kept_gap_of_size * s.size() ||
        g.gap < pair.gap.gap - tolerances::deepest_unseen)
      return;
    if (lies_flat(old, g, bodies)) return;
    if (is_feature(s.sa, old.a) && is_feature(s.sb, old.b) && still_there(g, s))
      out.push_back(old), out.back().towards_b = g.normal;
  });
}

}  // namespace tumble
