#include "engine/dynamics/event/event_contact.hpp"

#include "engine/collision/convex_pairs/pair.hpp"
#include "engine/collision/feature_key.hpp"
#include "engine/collision/query.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

/// Lies along a plane, if it touches one.
bool is_straight(const SurfaceElement& e) {
  return e.kind == ElementKind::line || e.kind == ElementKind::cone;
}

bool is_sharp_point(const SurfaceElement& e) {
  return e.kind == ElementKind::point && e.radius == 0;
}

/// Whether a surface has one normal at each of its points.
bool is_smooth(const SurfaceElement& e) {
  using enum ElementKind;
  return e.kind == plane || e.kind == ellipsoid || e.kind == cone ||
         (e.kind != circle && e.radius > 0);
}

/// Where a corner meets a corner, an edge or a rim, or edges meet along each other, any normal
/// between their faces would do: that of the pair and the material point of B do for a moment.
void choose_tangent(EventContact& c, const RigidBody& a, const RigidBody& b, const Vec3& on_a,
                    const Vec3& on_b, const Vec3& normal) {
  c.a = {ElementKind::plane, a.pose.inverse_point(on_a), a.pose.inverse_direction(normal), 0};
  c.b = material_point(b.pose.inverse_point(on_b));
}

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

/// Whether a sharp point lies on the rim.
bool is_on_rim(const SurfaceElement& point, const SurfaceElement& rim) {
  const double near = tolerances::on_rim_of_radius * rim.radius;
  const Vec3 arm = point.origin - rim.origin;
  const double along = rim.direction.dot(arm);
  return std::fabs(along) <= near &&
         std::fabs((arm - along * rim.direction).norm() - rim.radius) <= near;
}

/// A rim that rolls on a face has one element; other points of its manifold on the same circle go.
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

/// Several manifolds, or a face and its nearest point, may have the same point.
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

auto shapes_of(const ContactKey& key) {
  return std::tie(key.body_a, key.body_b, key.shape_a, key.shape_b);
}

std::vector<const EventContact*> by_shapes(std::span<const EventContact> contacts) {
  std::vector<const EventContact*> out;
  for (const EventContact& c : contacts) out.push_back(&c);
  std::stable_sort(out.begin(), out.end(), [](const EventContact* a, const EventContact* b) {
    return shapes_of(a->key) < shapes_of(b->key);
  });
  return out;
}

/// Finds what a contact continues: what is at its place now, or else the same features.
class Continued {
 public:
  /// `before` in the order of their shapes.
  Continued(std::span<const RigidBody> bodies, std::span<const EventContact* const> before,
            const ContactKey& pair) {
    const auto earlier = [](const EventContact* c, const ContactKey& key) {
      return shapes_of(c->key) < shapes_of(key);
    };
    auto at = std::lower_bound(before.begin(), before.end(), pair, earlier);
    for (; at != before.end() && same_shapes((*at)->key, pair); ++at)
      known_.push_back({*at, place_now(**at, bodies)});
  }
  const EventContact* of(const EventContact& c, const Vec3& x_world, double near) {
    for (Known& k : known_)
      if (!k.taken && (k.now.x_world - x_world).norm() <= near) return k.taken = true, k.contact;
    if (c.feature == 0 || c.feature == nearest_points) return nullptr;
    for (Known& k : known_)
      if (!k.taken && k.contact->feature == c.feature && k.contact->key.part == c.key.part)
        return k.taken = true, k.contact;
    return nullptr;
  }
  bool none() const { return known_.empty(); }
  double offset() const {
    double most = 0;
    for (const Known& k : known_) most = std::max(most, k.contact->offset);
    return most;
  }
  /// Calls with each contact that nothing continues, and its gap.
  template <class Visit>
  void for_each_left(const Visit& visit) const {
    for (const Known& k : known_)
      if (!k.taken && k.now.regular) visit(*k.contact, k.now);
  }

 private:
  /// Of nearest points, which need not be at the same features for long.
  static constexpr uint64_t nearest_points = feature_key(FeaturePair::closest, 0, 0);
  struct Known {
    const EventContact* contact;
    ElementPlace now;
    bool taken = false;
  };
  std::vector<Known> known_;
};

/// Whether elements that were chosen for a manifold point say what the shapes do there: no feature
/// is deeper than the shapes are, and lines do not meet beyond the ends of their edges.
bool plausible(const ElementPlace& g, const EventPair& pair, const Vec3& x_world, double size) {
  if (!g.regular) return false;
  if (g.gap < pair.gap.gap - tolerances::deepest_unseen) return false;
  return g.gap > tolerances::far_off_of_size * size ||
         (g.x_world - x_world).norm() <= tolerances::far_off_of_size * size + std::fabs(g.gap);
}

/// Whether a manifold point is deeper than the shapes are, and than what was accepted: where
/// surfaces cross by rounding alone the narrow phase may be wrong about how far.
bool too_deep(const ManifoldPoint& p, const PairGap& pair, double accepted) {
  const double deepest = pair.gap - tolerances::deepest_unseen;
  const bool touch = pair.near && pair.gap >= -tolerances::deepest_unseen;
  return p.gap < deepest && (touch || p.gap < -accepted - tolerances::deepest_unseen);
}

struct PairShapes {
  const RigidBody &a, &b;
  const BodyShape &sa, &sb;
  Pose at_a, at_b;

  PairShapes(const EventPair& p, std::span<const RigidBody> bodies)
      : a(bodies[p.a.body]),
        b(bodies[p.b.body]),
        sa(a.shapes[p.a.shape]),
        sb(b.shapes[p.b.shape]),
        at_a(a.pose * sa.pose),
        at_b(b.pose * sb.pose) {}
  double size() const { return std::min(sa.shape->bounding_radius(), sb.shape->bounding_radius()); }
};

/// Whether a manifold says what there is about two pieces: that they are apart along its normal, or
/// no deeper than its points.
bool explains(const Manifold& m, const PairShapes& s, const PiecePair& pieces) {
  double least = -tolerances::seen_depth;
  for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[size_t(i)].gap);
  return piece_separation(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, m.normal) >=
         least - tolerances::same_depth;
}

Manifold nearest_point(const PairGap& g) {
  Manifold m;
  m.normal = g.normal;
  m.part = second_manifold;
  m.count = 1;
  m.points[0] = {0.5 * (g.on_a + g.on_b), g.gap, 0};
  return m;
}

/// Pieces of meshes that have just come in and have no contact yet, since a manifold holds four
/// points and a sheet's back has none: there their deepest points are one.
void unexplained_pieces(const PairShapes& s, const HierarchyKind* hierarchy,
                        std::vector<Manifold>& out) {
  std::vector<PiecePair> pieces;
  near_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, 0, hierarchy, pieces);
  for (const PiecePair& p : pieces) {
    const PairGap g = piece_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, p, 0, Vec3::Zero());
    if (!g.near || g.gap > -tolerances::seen_depth || g.gap < -tolerances::just_in) continue;
    if (std::any_of(out.begin(), out.end(), [&](const Manifold& m) { return explains(m, s, p); }))
      continue;
    out.push_back(nearest_point(g));
  }
}

void find_manifolds(const PairShapes& s, EventPair& pair, NarrowPhase narrow_phase,
                    const HierarchyKind* hierarchy, std::vector<Manifold>& out) {
  const ContactQuery query(pair.margin, hierarchy);
  if (!has_pair_gap(*s.sa.shape, *s.sb.shape)) {
    narrow_phase(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, query, out);
    const double near = std::min(pair.margin, tolerances::far_off_of_size * s.size());
    pair.gap = nearest_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, near, hierarchy).gap;
    if (pair.gap.near && pair.gap.gap < -tolerances::seen_depth)
      unexplained_pieces(s, hierarchy, out);
    return;
  }
  const Vec3 start = pair.gap.near ? pair.gap.normal : Vec3(Vec3::Zero());
  pair.gap = pair_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pair.margin, start);
  if (pair.gap.near)
    pair_manifolds(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, query, pair.gap, narrow_phase, out);
}

void keep(EventContact& c, const EventContact& old) {
  c.offset = old.offset;
  c.impacts = old.impacts;
  c.closed = old.closed;
  c.force = old.force;
  c.impulse = old.impulse;
}

/// Whether the elements of a contact still meet where both shapes have a surface.
bool still_there(const ElementPlace& g, const PairShapes& s) {
  const double off = 0.5 * std::fabs(g.gap) + tolerances::same_place_of_size * s.size();
  for (const auto& [shape, pose] : {std::pair(&s.sa, &s.at_a), std::pair(&s.sb, &s.at_b)})
    if (!closest_point(*shape->shape, *pose, g.x_world, off)) return false;
  return true;
}

/// Whether a rim lies flat on a face, where no point of it is furthest out.
bool lies_flat(const EventContact& c, const ElementPlace& g, const PairShapes& s) {
  const auto flat = [&](const SurfaceElement& e, const Pose& body) {
    return e.kind == ElementKind::circle &&
           body.direction(e.direction).cross(g.normal).norm() <= tolerances::same_place_of_size;
  };
  return flat(c.a, s.a.pose) || flat(c.b, s.b.pose);
}

/// A manifold holds no more than four points, and of a surface that is nearly flat other four every
/// time: points that nearly touch stay watched as long as they are what they were.
void keep_near(const Continued& continued, const PairShapes& s, const EventPair& pair, size_t first,
               std::vector<EventContact>& out) {
  continued.for_each_left([&](const EventContact& old, const ElementPlace& g) {
    if (out.size() >= first + tolerances::most_kept_contacts) return;
    if (g.gap > tolerances::kept_gap_of_size * s.size() ||
        g.gap < pair.gap.gap - tolerances::deepest_unseen)
      return;
    if (lies_flat(old, g, s)) return;
    if (is_feature(s.sa, old.a) && is_feature(s.sb, old.b) && still_there(g, s))
      out.push_back(old), out.back().towards_b = g.normal;
  });
}

/// The one of the two that is a particle, if just one is.
const RigidBody* particle_of(const EventContact& c, std::span<const RigidBody> bodies) {
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  const bool of_a = is_particle(a), of_b = is_particle(b);
  return of_a == of_b ? nullptr : of_a ? &a : &b;
}

}  // namespace

bool same_shapes(const ContactKey& a, const ContactKey& b) {
  return a.body_a == b.body_a && a.shape_a == b.shape_a && a.body_b == b.body_b &&
         a.shape_b == b.shape_b;
}

BodyMotion motion_of(const RigidBody& body) {
  return {body.pose, body.v, body.omega};
}

void put_motion(const BodyMotion& motion, RigidBody& body) {
  body.pose = motion.pose;
  body.v = motion.v;
  body.omega = motion.omega;
}

ElementGap gap_now(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementGap g = element_gap(c.a, motion_of(bodies[c.key.body_a]), c.b,
                             motion_of(bodies[c.key.body_b]), c.towards_b);
  if (!g.regular) g.gap = tolerances::no_limit;
  return g;
}

ElementPlace place_now(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementPlace g = element_place(c.a, motion_of(bodies[c.key.body_a]), c.b,
                                 motion_of(bodies[c.key.body_b]), c.towards_b);
  if (!g.regular) g.gap = tolerances::no_limit;
  return g;
}

void pieces_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double reach,
                    const HierarchyKind* hierarchy, std::vector<PiecePair>& out) {
  const PairShapes s(pair, bodies);
  near_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, reach, hierarchy, out);
}

PairGap gap_of_pieces(const EventPair& pair, const PiecePair& pieces,
                      std::span<const RigidBody> bodies, double margin, const Vec3& towards_b) {
  const PairShapes s(pair, bodies);
  return piece_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, margin, towards_b);
}

PairGap gap_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double margin,
                    const HierarchyKind* hierarchy) {
  const PairShapes s(pair, bodies);
  if (!has_pair_gap(*s.sa.shape, *s.sb.shape))
    return nearest_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, margin, hierarchy).gap;
  const Vec3 start = pair.gap.near ? pair.gap.normal : Vec3(Vec3::Zero());
  return pair_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, margin, start);
}

double separation_of_pieces(const EventPair& pair, const PiecePair& pieces,
                            std::span<const RigidBody> bodies, const Vec3& n) {
  const PairShapes s(pair, bodies);
  return piece_separation(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, n);
}

ElementPlace push_place(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementPlace g = place_now(c, bodies);
  if (const RigidBody* particle = particle_of(c, bodies); particle && g.regular)
    g.x_world = particle->pose.x;
  return g;
}

ElementGap push_gap(const EventContact& c, std::span<const RigidBody> bodies) {
  ElementGap g = gap_now(c, bodies);
  const RigidBody* particle = particle_of(c, bodies);
  if (!particle || !g.regular) return g;
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  g.x_world = particle->pose.x;
  const Vec3 change =
      particle == &b ? Vec3(-a.omega.cross(b.v - a.v)) : Vec3(b.omega.cross(a.v - b.v));
  g.tangential_bias = change - g.normal.dot(change) * g.normal;
  return g;
}

double free_acceleration(const EventContact& c, const ElementGap& g,
                         std::span<const RigidBody> bodies) {
  const auto at_point = [&](uint32_t slot) -> Vec3 {
    const RigidBody& b = bodies[slot];
    if (!b.dynamic()) return Vec3::Zero();
    const Vec3 gyroscopic = b.omega.cross(b.inertia_world() * b.omega);
    const Vec3 turn = b.inverse_inertia_world() * (b.torque - gyroscopic);
    return b.inverse_mass * b.force + turn.cross(g.x_world - b.pose.x);
  };
  return g.normal.dot(at_point(c.key.body_b) - at_point(c.key.body_a)) + g.bias;
}

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
    // What is in must not stay without a contact because all that were found are implausible.
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
    keep_near(continued, s, pair, first, out);
    drop_rim_points(out, first);
    pair.first_contact = first;
    pair.contacts = out.size() - first;
  }
  return out;
}

std::optional<Vec3> crossing_of(const EventContact& c, std::span<const RigidBody> bodies) {
  if (!is_straight(c.a) || !is_straight(c.b)) return {};
  return place_now(c, bodies).x_world;
}

bool ran_away(const EventContact& c, const Vec3& from, std::span<const RigidBody> bodies) {
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  const BodyShape &sa = a.shapes[c.key.shape_a], &sb = b.shapes[c.key.shape_b];
  const double size = std::min(sa.shape->bounding_radius(), sb.shape->bounding_radius());
  const Vec3 x = place_now(c, bodies).x_world;
  return (x - from).norm() > tolerances::far_along_of_size * size ||
         !closest_point(*sa.shape, a.pose * sa.pose, x, tolerances::far_off_of_size * size) ||
         !closest_point(*sb.shape, b.pose * sb.pose, x, tolerances::far_off_of_size * size);
}

Vec3 slip_of(const EventContact& c, const ElementPlace& g, std::span<const RigidBody> bodies) {
  const Vec3 u = bodies[c.key.body_b].velocity_at(g.x_world) -
                 bodies[c.key.body_a].velocity_at(g.x_world) - c.surface_velocity;
  return u - g.normal.dot(u) * g.normal;
}

}  // namespace tumble
