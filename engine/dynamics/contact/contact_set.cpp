#include "engine/dynamics/contact/contact_set.hpp"

#include "engine/collision/convex_pairs/pair.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/ellipsoid.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/parallel.hpp"
#include "engine/dynamics/rigid/point_mass.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace tumble {

Vec3 contact_position(const Contact& contact, int i, std::span<const RigidBody> bodies) {
  const ContactPoint& p = contact.points[size_t(i)];
  return 0.5 * (bodies[contact.key.body_a].pose.point(p.anchor_a) +
                bodies[contact.key.body_b].pose.point(p.anchor_b));
}

Vec3 contact_impulse(const Contact& contact, int i) {
  const ContactPoint& p = contact.points[size_t(i)];
  return p.normal_impulse * contact.normal + p.friction_impulse;
}

CombinedMaterial combine(const Material& a, const Material& b) {
  return {std::sqrt(a.friction * b.friction), std::max(a.restitution, b.restitution)};
}

namespace {

constexpr size_t chunk_pairs = 16;

/// Distance at which the contact of two bodies is foreseen: the margin of the smaller one, and as
/// far as they approach in the tick but no more than half a body, beyond which false contacts at
/// corners would do harm and the continuous stage watches instead. `share` scales the margin.
double pair_margin(const RigidBody& a, const RigidBody& b, const Vec3& gravity, double h,
                   double margin, double share) {
  double limit = std::numeric_limits<double>::infinity();
  double reach = 0;
  Vec3 v = Vec3::Zero();
  for (const RigidBody* body : {&a, &b}) {
    if (body->dynamic()) {
      limit = std::min(limit, foresight(*body));
      reach += std::min(body->omega.norm() * h, 1.0) * body->bounding_radius;
    }
    const Vec3 end = body->v + (body->dynamic() ? (h * body->gravity_scale * gravity).eval()
                                                : Vec3::Zero().eval());
    v += body == &b ? end : Vec3(-end);
  }
  const double base = std::min(contact_margin(a, margin), contact_margin(b, margin));
  return share * base + std::min(v.norm() * h + reach, limit);
}

/// Every triangle within the margin costs time, and meshes have many: for two surfaces of triangles
/// what they travel in the tick counts and little beyond it.
double margin_share(const BodyShape& a, const BodyShape& b) {
  const bool mesh =
      a.shape->type() == ShapeType::triangle_mesh || b.shape->type() == ShapeType::triangle_mesh;
  return mesh && a.shape->polyhedral() && b.shape->polyhedral() ? 0.25 : 1.0;
}

/// Carries the forces of one old point over to the new point that continues it.
class PointMatcher {
 public:
  PointMatcher(std::span<const Contact> old, double tolerance)
      : old_(old), tolerance2_(tolerance * tolerance) {}

  void match(Contact& contact) {
    for (int i = 0; i < contact.count; ++i) by_feature(contact, i);
    for (int i = 0; i < contact.count; ++i) by_place(contact, i);
    if (contact.count == 1) contact.spin_torque = torque_;
  }

 private:
  void by_feature(Contact& contact, int i) {
    ContactPoint& p = contact.points[size_t(i)];
    for (size_t k = 0; k < old_.size(); ++k) {
      if ((old_[k].key.part | second_manifold) != (contact.key.part | second_manifold)) continue;
      for (int j = 0; j < old_[k].count; ++j) {
        const ContactPoint& q = old_[k].points[size_t(j)];
        if (q.feature != p.feature || taken(k, j)) continue;
        take(p, i, k, j);
        return;
      }
    }
  }
  void by_place(Contact& contact, int i) {
    if (matched_ & (1u << i)) return;
    ContactPoint& p = contact.points[size_t(i)];
    size_t best_k = old_.size();
    int best_j = 0;
    double best = tolerance2_;
    for (size_t k = 0; k < old_.size(); ++k) {
      if (old_[k].normal.dot(contact.normal) < 0.9) continue;
      for (int j = 0; j < old_[k].count; ++j) {
        if (taken(k, j)) continue;
        const double d = (old_[k].points[size_t(j)].anchor_a - p.anchor_a).squaredNorm();
        if (d >= best) continue;
        best = d;
        best_k = k;
        best_j = j;
      }
    }
    if (best_k < old_.size()) take(p, i, best_k, best_j);
  }
  bool taken(size_t k, int j) const {
    return std::find(taken_.begin(), taken_.end(), 4 * k + size_t(j)) != taken_.end();
  }
  void take(ContactPoint& p, int i, size_t k, int j) {
    const ContactPoint& q = old_[k].points[size_t(j)];
    p.normal_force = q.normal_force;
    p.friction_force = q.friction_force;
    torque_ += old_[k].count == 1 ? old_[k].spin_torque : 0;
    matched_ |= 1u << i;
    taken_.push_back(4 * k + size_t(j));
  }

  std::span<const Contact> old_;
  double tolerance2_;
  unsigned matched_ = 0;
  double torque_ = 0;
  std::vector<size_t> taken_;

 public:
  void next() {
    matched_ = 0;
    torque_ = 0;
  }
};

ContactKey pair_key(const ShapeRef& a, const ShapeRef& b) {
  return {a.body, a.shape, b.body, b.shape, 0};
}

bool same_pair(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

/// The old contacts of one pair of shapes.
std::span<const Contact> contacts_of(std::span<const Contact> sorted, const ContactKey& pair) {
  const auto begin =
      std::lower_bound(sorted.begin(), sorted.end(), pair,
                       [](const Contact& c, const ContactKey& k) { return c.key < k; });
  auto end = begin;
  while (end != sorted.end() && same_pair(end->key, pair)) ++end;
  return {begin, end};
}

/// The features of the points that press.
void pressed_features(std::span<const Contact> contacts, std::vector<uint64_t>& out) {
  out.clear();
  for (const Contact& c : contacts)
    for (int i = 0; i < c.count; ++i)
      if (c.points[size_t(i)].normal_force > 0) out.push_back(c.points[size_t(i)].feature);
}

/// Radius at which a shape is round where it touches along `normal` (unit, world axes).
double rounding(const BodyShape& shape, const Pose& body, const Vec3& normal) {
  if (shape.shape->type() == ShapeType::cylinder) {
    const Vec3 axis = body.direction(shape.pose.direction(Vec3::UnitY()));
    return std::abs(axis.dot(normal)) < 0.05 ? shape.shape->def().radius : 0;
  }
  if (shape.shape->type() == ShapeType::ellipsoid) {
    const Vec3 n = shape.pose.inverse_direction(body.inverse_direction(normal));
    return mean_radius_of_curvature(shape.shape->def().half_extents, n);
  }
  const ConvexShape* convex = shape.shape->convex();
  return convex ? convex->rounding() : 0;
}

/// A twentieth of the radius of a round surface, a hundredth of the size of a corner's body; of
/// what does not turn there is none.
double spin_radius(const Contact& c, const RigidBody& a, const RigidBody& b) {
  if (c.count != 1 || is_particle(a) || is_particle(b)) return 0;
  const double round = std::max(c.rounding_a, c.rounding_b);
  if (round > 0) return 0.05 * round;
  const double size = std::min(a.dynamic() ? a.bounding_radius : b.bounding_radius,
                               b.dynamic() ? b.bounding_radius : a.bounding_radius);
  return 0.01 * size;
}

Contact make_contact(const ContactKey& key, const Manifold& m, const RigidBody& a,
                     const RigidBody& b) {
  Contact c;
  c.key = key;
  c.key.part = m.part;
  c.normal = m.normal;
  c.count = m.count;
  c.closest = m.closest;
  c.rounding_a = rounding(a.shapes[key.shape_a], a.pose, m.normal);
  c.rounding_b = rounding(b.shapes[key.shape_b], b.pose, m.normal);
  const Material& ma = a.shapes[key.shape_a].material;
  const Material& mb = b.shapes[key.shape_b].material;
  const CombinedMaterial combined = combine(ma, mb);
  c.friction = combined.friction;
  c.restitution = combined.restitution;
  c.surface_velocity =
      a.pose.direction(ma.surface_velocity) - b.pose.direction(mb.surface_velocity);
  c.spin_radius = spin_radius(c, a, b);
  for (int i = 0; i < m.count; ++i) {
    const ManifoldPoint& from = m.points[size_t(i)];
    ContactPoint& p = c.points[size_t(i)];
    p.anchor_a = a.pose.inverse_point(from.x_world - 0.5 * from.gap * m.normal);
    p.anchor_b = b.pose.inverse_point(from.x_world + 0.5 * from.gap * m.normal);
    p.gap = from.gap;
    p.feature = from.feature;
  }
  return c;
}

bool key_less(const Contact& a, const Contact& b) {
  return a.key < b.key;
}

}  // namespace

/// What the parallel part of an update reads.
struct ContactSet::Chunk {
  std::span<const RigidBody> bodies;
  const ProxySet& proxies;
  std::span<const ProxyPair> pairs;
  std::span<const Contact> old;
  const Vec3& gravity;
  double h, margin;
  NarrowPhase narrow_phase;
  const HierarchyKind* hierarchy;

  void collide_pair(const ProxyPair& pair, std::vector<Manifold>& manifolds,
                    std::vector<Contact>& out) const {
    const ShapeRef& ra = proxies.refs[pair.a];
    const ShapeRef& rb = proxies.refs[pair.b];
    if (ra.body == rb.body) return;
    const RigidBody& a = bodies[ra.body];
    const RigidBody& b = bodies[rb.body];
    if (!a.dynamic() && !b.dynamic()) return;
    manifolds.clear();
    const BodyShape& sa = a.shapes[ra.shape];
    const BodyShape& sb = b.shapes[rb.shape];
    const ContactKey key = pair_key(ra, rb);
    const std::span<const Contact> before = contacts_of(old, key);
    thread_local std::vector<uint64_t> kept;
    pressed_features(before, kept);
    ContactQuery query{pair_margin(a, b, gravity, h, margin, margin_share(sa, sb)), hierarchy,
                       kept};
    if (!before.empty()) query.start = &before.front().closest;
    narrow_phase(*sa.shape, a.pose * sa.pose, *sb.shape, b.pose * sb.pose, query, manifolds);
    std::stable_sort(manifolds.begin(), manifolds.end(),
                     [](const Manifold& x, const Manifold& y) { return x.part < y.part; });
    const double size = std::min(a.bounding_radius, b.bounding_radius);
    PointMatcher matcher(before, 0.1 * size);
    for (const Manifold& m : manifolds) {
      if (m.count <= 0) continue;
      out.push_back(make_contact(key, m, a, b));
      matcher.next();
      matcher.match(out.back());
    }
  }
};

ContactUpdateStats ContactSet::update(std::span<const RigidBody> bodies, const ProxySet& proxies,
                                      std::span<const ProxyPair> pairs, const Vec3& gravity,
                                      double h, const RealtimeSettings& settings,
                                      tbb::task_arena& arena, NarrowPhase narrow_phase,
                                      const HierarchyKind* hierarchy) {
  const size_t chunk_count = (pairs.size() + chunk_pairs - 1) / chunk_pairs;
  if (chunks_.size() < chunk_count) chunks_.resize(chunk_count);
  old_.swap(contacts_);
  const Chunk work{bodies,       proxies,  pairs, old_, gravity, h, settings.speculative_margin,
                   narrow_phase, hierarchy};
  parallel_for(arena, chunk_count, [&](size_t c) {
    static thread_local std::vector<Manifold> manifolds;
    chunks_[c].clear();
    const size_t end = std::min(pairs.size(), (c + 1) * chunk_pairs);
    for (size_t i = c * chunk_pairs; i < end; ++i) {
      work.collide_pair(pairs[i], manifolds, chunks_[c]);
    }
  });
  contacts_.clear();
  for (size_t c = 0; c < chunk_count; ++c) {
    contacts_.insert(contacts_.end(), chunks_[c].begin(), chunks_[c].end());
  }
  // Pairs at rest were not looked at; what they had stays.
  const auto middle = std::ptrdiff_t(contacts_.size());
  for (const Contact& c : old_) {
    const RigidBody& a = bodies[c.key.body_a];
    const RigidBody& b = bodies[c.key.body_b];
    if (!seeks_contacts(a) && !seeks_contacts(b)) contacts_.push_back(c);
  }
  std::inplace_merge(contacts_.begin(), contacts_.begin() + middle, contacts_.end(), key_less);

  ContactUpdateStats stats;
  stats.pairs = pairs.size();
  stats.contacts = contacts_.size();
  for (const Contact& c : contacts_) {
    stats.points += uint64_t(c.count);
    for (int i = 0; i < c.count; ++i) {
      stats.max_penetration = std::max(stats.max_penetration, -c.points[size_t(i)].gap);
    }
  }
  return stats;
}

void ContactSet::scale_impulses(int parts, std::span<const RigidBody> bodies) {
  if (parts == 1) return;
  for (Contact& c : contacts_) {
    if (!seeks_contacts(bodies[c.key.body_a]) && !seeks_contacts(bodies[c.key.body_b])) continue;
    for (ContactPoint& p : c.points) {
      p.normal_impulse *= parts;
      p.friction_impulse *= parts;
    }
  }
}

void ContactSet::remove_body(uint32_t body) {
  std::erase_if(contacts_,
                [body](const Contact& c) { return c.key.body_a == body || c.key.body_b == body; });
}

}  // namespace tumble
