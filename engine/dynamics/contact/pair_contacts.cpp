#include "engine/dynamics/contact/pair_contacts.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

/// Gap within which contacts are foreseen even of shapes that do not move [m]. Each triangle within
/// it costs time and meshes have many, so that for two triangulated surfaces it is small beside
/// their approach in the tick.
double standing_reach(const PairSide& a, const PairSide& b) {
  const bool triangles = (a.mesh || b.mesh) && a.polyhedral && b.polyhedral;
  return (triangles ? tolerances::triangles_of_margin : 1.0) * std::min(a.margin, b.margin);
}

/// Carries the forces of old points over to the new points that continue them.
class PointMatcher {
 public:
  /// `taken` is scratch memory.
  PointMatcher(std::span<const Contact> old, double tolerance, std::vector<unsigned>& taken)
      : old_(old), tolerance2_(tolerance * tolerance), taken_(taken) {
    taken_.assign(old.size(), 0);
  }

  void match(Contact& contact) {
    if (old_.empty()) return;
    matched_ = 0;
    turning_torque_.setZero();
    for (int i = 0; i < contact.count; ++i) by_feature(contact, i);
    for (int i = 0; i < contact.count; ++i) by_place(contact, i);
    contact.turning_torque = turning_torque_;
  }

 private:
  void by_feature(Contact& contact, int i) {
    ContactPoint& p = contact.points[size_t(i)];
    for (size_t k = 0; k < old_.size(); ++k) {
      // Any manifold of the same patch.
      if (uint32_t(old_[k].key.part) != uint32_t(contact.key.part)) continue;
      unsigned same = 0;
      for (int j = 0; j < old_[k].count; ++j)
        same |= unsigned{old_[k].points[size_t(j)].feature == p.feature} << j;
      same &= ~taken_[k];
      if (same == 0) continue;
      take(p, i, k, std::countr_zero(same));
      return;
    }
  }
  void by_place(Contact& contact, int i) {
    if (matched_ & (1u << i)) return;
    ContactPoint& p = contact.points[size_t(i)];
    size_t best_k = old_.size();
    int best_j = 0;
    double best = tolerance2_;
    for (size_t k = 0; k < old_.size(); ++k) {
      if (old_[k].normal.dot(contact.normal) < tolerances::same_normal) continue;
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
  bool taken(size_t k, int j) const { return taken_[k] >> j & 1; }
  void take(ContactPoint& p, int i, size_t k, int j) {
    const ContactPoint& q = old_[k].points[size_t(j)];
    p.normal_force = q.normal_force;
    p.friction_force = q.friction_force;
    // once: the torque belongs to the contact as a whole
    if (taken_[k] == 0) turning_torque_ += old_[k].turning_torque;
    matched_ |= 1u << i;
    taken_[k] |= 1u << j;
  }

  std::span<const Contact> old_;
  double tolerance2_;
  unsigned matched_ = 0;
  Vec3 turning_torque_ = Vec3::Zero();
  std::vector<unsigned>& taken_;  ///< by old contact: a bit for each point that is taken
};

/// Indices of the manifolds in the order of their parts; those of one part in their given order.
void order_by_part(std::span<const Manifold> manifolds, std::vector<uint32_t>& order) {
  order.assign(manifolds.size(), 0u);
  if (manifolds.size() < 2) return;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t x, uint32_t y) {
    const uint64_t part_x = manifolds[x].part, part_y = manifolds[y].part;
    return part_x != part_y ? part_x < part_y : x < y;
  });
}

/// Radius of curvature of a shape where it touches along `outward` (unit, world axes); 0 for
/// planes.
double rounding(const PairSide& side, uint32_t shape, const Vec3& outward) {
  if (side.planes) return 0;
  if (!side.several) return side.shape->rounding_along(side.shape_pose.inverse_direction(outward));
  const BodyShape& of_body = side.several->shapes[shape];
  if (made_of_planes(*of_body.shape)) return 0;
  return of_body.shape->rounding_along((side.body_pose.q * of_body.pose.q).conjugate() * outward);
}

void make_contact(const ContactKey& key, const ShapesOfPair& shapes, const Manifold& m,
                  const PairSide& a, const PairSide& b, Contact& c) {
  const ContactHead fresh;
  static_cast<ContactHead&>(c) = fresh;
  c.key = key;
  c.key.part = m.part;
  c.shapes = shapes;
  c.normal = m.normal;
  c.normal_a = a.body_pose.inverse_direction(m.normal);
  c.count = m.count;
  c.closest = m.closest;
  c.rounding_a = rounding(a, shapes.a, m.normal);
  c.rounding_b = rounding(b, shapes.b, -m.normal);
  const Mat3 to_a = a.body_pose.q.conjugate().toRotationMatrix();
  const Mat3 to_b = b.body_pose.q.conjugate().toRotationMatrix();
  for (int i = 0; i < m.count; ++i) {
    const ManifoldPoint& from = m.points[size_t(i)];
    ContactPoint& p = c.points[size_t(i)] = {};
    const Vec3 half_gap = (0.5 * from.gap) * m.normal;
    p.anchor_a = to_a * (from.x_world - half_gap - a.body_pose.x);
    p.anchor_b = to_b * (from.x_world + half_gap - b.body_pose.x);
    p.gap = from.gap;
    p.feature = from.feature;
  }
}

}  // namespace

double PairContacts::reach(const PairSide& a, const PairSide& b) const {
  const double approach =
      (b.end_velocity - a.end_velocity).norm() * tick.h + (a.turning + b.turning);
  return standing_reach(a, b) + std::min(approach, std::min(a.foresight, b.foresight));
}

bool PairContacts::knows(const ProxyPair& pair, const PairHistory& history) const {
  if (!history.seen) return false;
  const PairSide &a = sides[pair.a], &b = sides[pair.b];
  const bool apart = history.contacts.empty();
  if (!apart && !(a.planes && b.planes)) return false;
  const double reach_now = reach(a, b);
  const double left = history.seen->margin - reach_now;
  if (!(left >= 0)) return false;
  const double tolerance = seen_tolerance(std::min(a.margin, b.margin));
  const double moved = moved_since(*history.seen, a, b, tolerance + (apart ? left : 0));
  const double reaches = reach_now + moved;
  if (moved <= tolerance && reaches <= history.seen->margin) return true;
  return apart && reaches + 2 * tolerance <= history.seen->margin;
}

PairContacts::Look PairContacts::look_at_shapes(const PairSide& a, const PairSide& b,
                                                ContactQuery query,
                                                std::vector<Manifold>& out) const {
  double apart = query.margin;
  query.apart = &apart;
  const auto first = std::ptrdiff_t(out.size());
  narrow_phase(*a.shape, a.shape_pose, *b.shape, b.shape_pose, query, out);
  if (std::ptrdiff_t(out.size()) == first) return {std::max(query.margin, apart), true};
  out.erase(std::remove_if(out.begin() + first, out.end(),
                           [](const Manifold& m) { return m.count <= 0; }),
            out.end());
  const bool none = std::ptrdiff_t(out.size()) == first;
  return {none ? std::max(query.margin, apart) : query.margin, none};
}

void PairContacts::look(const ProxyPair& pair, const PairHistory& history, Sights& sights) const {
  const PairSide &a = sides[pair.a], &b = sides[pair.b];
  const bool can_be_carried = a.planes && b.planes;
  const double reach_now = reach(a, b);
  // Searches farther, so that the result survives some motion.
  const double slack = can_be_carried ? 2 * seen_tolerance(std::min(a.margin, b.margin)) : 0;
  static thread_local std::vector<uint64_t> memory;
  ContactQuery query{reach_now + slack, hierarchy, pressed_features(history.contacts, memory)};
  if (!history.contacts.empty()) query.start = &history.contacts.front().closest;
  const Look seen = look_at_shapes(a, b, query, sights.manifolds);
  if (can_be_carried || (seen.none && seen.margin > reach_now && !a.sphere && !b.sphere))
    sights.seen.push_back(look_at(key(pair), a, b, seen.margin));
}

void PairContacts::make(const ProxyPair& pair, std::span<const Contact> before,
                        std::span<const Manifold> manifolds, std::span<const ShapesOfPair> shapes,
                        std::span<Contact> contacts) const {
  const ContactKey pair_key = key(pair);
  const PairSide &a = sides[pair.a], &b = sides[pair.b];
  const ShapesOfPair two{a.shape_index, b.shape_index};
  static thread_local std::vector<unsigned> taken;
  static thread_local std::vector<uint32_t> order;
  order_by_part(manifolds, order);
  PointMatcher matcher(before, tolerances::same_place_of_radius * std::min(a.radius, b.radius),
                       taken);
  for (size_t i = 0; i < manifolds.size(); ++i) {
    const uint32_t at = order[i];
    make_contact(pair_key, shapes.empty() ? two : shapes[at], manifolds[at], a, b, contacts[i]);
    matcher.match(contacts[i]);
    take_materials(contacts[i], a, b);
  }
}

}  // namespace tumble
