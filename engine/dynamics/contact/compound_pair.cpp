#include "engine/dynamics/contact/compound_pair.hpp"

#include "engine/core/recycler.hpp"
#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// What is remembered of two shapes; null if nothing is.
const CachedShapes* find_shapes(const KnownShapes& near, const ShapesOfPair& at) {
  const auto found = std::ranges::lower_bound(near.shapes, at, {}, &CachedShapes::shapes);
  return found != near.shapes.end() && found->shapes == at ? &*found : nullptr;
}

/// Position of one of the shapes of a side in the side's frame.
Vec3 centre_in(const PairSide& side, uint32_t shape) {
  return side.several ? side.several->shapes[shape].pose.x : Vec3(Vec3::Zero());
}

double radius_of(const PairSide& side, uint32_t shape) {
  return side.several ? side.several->shapes[shape].shape->bounding_radius() : side.shape_radius;
}

bool flat_surface(const PairSide& side, uint32_t shape) {
  return side.planes || (side.several && made_of_planes(*side.several->shapes[shape].shape));
}

/// One of the shapes of a body that is paired as a whole, as shape_side() makes it but without
/// material.
PairSide shape_of(const PairSide& whole, uint32_t shape, double h) {
  const BodyShape& of_body = whole.several->shapes[shape];
  PairSide side = whole;
  side.several = nullptr;
  side.shape_pose = whole.body_pose * of_body.pose;
  side.shape_radius = of_body.shape->bounding_radius();
  side.shape = of_body.shape.get();
  side.shape_index = shape;
  side.polyhedral = whole.polyhedral || side.shape->polyhedral() != nullptr;
  side.planes = whole.planes || made_of_planes(*side.shape);
  side.mesh = side.shape->is_mesh();
  side.sphere = side.shape->is_ball();
  if (side.dynamic) {
    const ShapeTurning turning = shape_turning(*whole.several, of_body, h);
    side.end_velocity += turning.velocity;
    side.turning = turning.reach;
  }
  return side;
}

/// Memory for one pair at a time.
struct Memory {
  PairSide a, b;  ///< the shapes that side_of() was last asked for
  ShapeManifolds found;
  std::vector<ShapesNear> near;
  std::vector<uint64_t> features, kept;
  std::vector<uint32_t> touched;
  Recycler<KnownShapes> lists{tolerances::lists_kept};
};

Memory& memory() {
  static thread_local Memory m;
  return m;
}

constexpr ShapesOfPair no_shapes{~uint32_t{0}, ~uint32_t{0}};

const KnownShapes& known_near(const PairHistory& history) {
  static const KnownShapes nothing;
  return history.near ? *history.near->near : nothing;
}

}  // namespace

CompoundPair::CompoundPair(const PairContacts& finder, const PairSide& a, const PairSide& b,
                           const PairHistory& history)
    : finder_(finder),
      a_(a),
      b_(b),
      history_(history),
      before_(known_near(history)),
      now_(relative_pose(a, b)),
      reach_(finder.reach(a, b)),
      slack_(2 * seen_tolerance(std::min(a.margin, b.margin))),
      named_(no_shapes) {}

const PairSide& CompoundPair::side_a(const CachedShapes& piece) {
  return side_of(a_, piece.shapes.a, named_.a, memory().a);
}

const PairSide& CompoundPair::side_b(const CachedShapes& piece) {
  return side_of(b_, piece.shapes.b, named_.b, memory().b);
}

/// The side for one shape of a body; made in `side` unless it is the one that was asked for last.
const PairSide& CompoundPair::side_of(const PairSide& whole, uint32_t shape, uint32_t& named,
                                      PairSide& side) const {
  if (!whole.several) return whole;
  if (shape != named) side = shape_of(whole, shape, finder_.tick.h);
  named = shape;
  return side;
}

/// PairContacts::reach of two shapes [m].
double CompoundPair::reach_of(const CachedShapes& piece) {
  return finder_.reach(side_a(piece), side_b(piece));
}

/// Motion of the bodies since `then`; several shapes often share the same time.
CompoundPair::Motion& CompoundPair::motion_since(const Pose& then) {
  if (motion_ && motion_->since.x == then.x && motion_->since.q == then.q) return *motion_;
  const double turn = 2 * (now_.q * then.q.conjugate()).vec().norm();
  const double shift = (now_.x - then.x).norm();
  motion_ = {then, shift + turn * std::min(a_.shape_radius, b_.shape_radius), {}};
  return *motion_;
}

/// The same, for single points.
const MotionSince& CompoundPair::points_since(const Pose& then) {
  Motion& motion = motion_since(then);
  if (!motion.points) motion.points.emplace(then, now_);
  return *motion.points;
}

/// Bound on the relative motion of two shapes since the last tick's list, at the smaller of them
/// [m].
double CompoundPair::moved(const CachedShapes& piece) {
  const bool first = smaller_first(a_, b_);
  const PairSide &small = first ? a_ : b_, &large = first ? b_ : a_;
  const uint32_t of_small = first ? piece.shapes.a : piece.shapes.b;
  const uint32_t of_large = first ? piece.shapes.b : piece.shapes.a;
  const MotionSince& motion =
      points_since(piece.touch ? before_.relative_touching : before_.relative_apart);
  const double radius = radius_of(small, of_small), other = radius_of(large, of_large);
  return other < radius ? motion.shift(centre_in(large, of_large), other)
                        : motion.shift(now_.point(centre_in(small, of_small)), radius);
}

/// Lower bound on the distance of two shapes by their bounding spheres [m].
double CompoundPair::spheres_apart(const CachedShapes& piece) const {
  const Vec3 a = centre_in(a_, piece.shapes.a), b = centre_in(b_, piece.shapes.b);
  const bool first = smaller_first(a_, b_);
  const Vec3 between = now_.point(first ? a : b) - (first ? b : a);
  return between.norm() - radius_of(a_, piece.shapes.a) - radius_of(b_, piece.shapes.b);
}

/// What is left now of the margin of two shapes of the last tick's list that were apart: a lower
/// bound on their distance, which is no closer than it must be where it exceeds the reach [m].
double CompoundPair::margin_left(const CachedShapes& piece) {
  const double left = piece.margin - motion_since(before_.relative_apart).most;
  if (left >= reach_) return left;
  const double apart = spheres_apart(piece);
  return apart >= reach_ ? apart : std::max(apart, piece.margin - moved(piece));
}

/// Whether two shapes of the last tick's list, which were apart or had gaps up to a margin, still
/// have no other gap in reach.
bool CompoundPair::still_seen(const CachedShapes& piece) {
  const double left = piece.touch ? piece.margin - moved(piece) : margin_left(piece);
  return left >= reach_ || left >= reach_of(piece);
}

/// Whether the contacts may be carried along. The narrow phase last ran on all touching shapes at
/// once.
bool CompoundPair::contacts_hold() {
  if (!hold_) hold_ = find_whether_they_hold();
  return *hold_;
}

bool CompoundPair::find_whether_they_hold() {
  if (history_.contacts.empty() || before_.touching == 0)
    return history_.contacts.empty() && before_.touching == 0;
  const double most = motion_since(before_.relative_touching).most;
  if (most > seen_tolerance(std::min(a_.margin, b_.margin)) && !points_hold()) return false;
  const bool all_seen = before_.margin_touching - most >= reach_;
  return std::ranges::all_of(before_.shapes, [this, all_seen](const CachedShapes& p) {
    return !p.touch || (flat_surface(a_, p.shapes.a) && flat_surface(b_, p.shapes.b) &&
                        (all_seen || still_seen(p)));
  });
}

/// Whether no point of the contacts has moved so far that these must be found anew.
bool CompoundPair::points_hold() {
  const bool first = smaller_first(a_, b_);
  const Pose in_large = (first ? b_ : a_).shape_pose.inverse() * (first ? a_ : b_).body_pose;
  const MotionSince& motion = points_since(before_.relative_touching);
  const double tolerance = seen_tolerance(std::min(a_.margin, b_.margin));
  for (const Contact& c : history_.contacts)
    for (const ContactPoint& p : c.used())
      if (motion.shift(in_large.point(first ? p.anchor_a : p.anchor_b)) > tolerance) return false;
  return true;
}

bool CompoundPair::knows() {
  if (!history_.seen) return false;
  if (history_.seen->margin - motion_since(history_.seen->relative).most < reach_) return false;
  const bool all_apart = before_.margin_apart - motion_since(before_.relative_apart).most >= reach_;
  if (!contacts_hold()) return false;
  return all_apart || std::ranges::all_of(before_.shapes, [this](const CachedShapes& p) {
           return p.touch || still_seen(p);
         });
}

/// Appends what is remembered of the bodies, and lists all pairs of their shapes that are near each
/// other with what is left of their margins; pairs that were not listed before are known by the
/// distance of their bounding spheres only.
void CompoundPair::renew_list(Sights& sights, KnownShapes& near) {
  const double asked = reach_ + slack_;
  const ContactKey key{a_.body, a_.shape_index, b_.body, b_.shape_index, 0};
  if (history_.seen) {
    const double left = history_.seen->margin - motion_since(history_.seen->relative).most;
    if (left >= asked) {
      sights.seen.push_back({key, now_, left});
      near.shapes = before_.shapes;
      for (CachedShapes& s : near.shapes)
        if (!s.touch) s.margin = margin_left(s);
      return;
    }
  }
  std::vector<ShapesNear>& found = memory().near;
  const double wanted = tolerances::list_of_reach * asked + std::min(a_.margin, b_.margin);
  const double listed =
      find_shape_pairs(side_shapes(finder_.bodies[a_.body], a_.shape_index),
                       side_shapes(finder_.bodies[b_.body], b_.shape_index), wanted, found);
  sights.seen.push_back({key, now_, listed});
  near.shapes.clear();
  for (const ShapesNear& at : found) {
    const CachedShapes* known = find_shapes(before_, at.shapes);
    near.shapes.push_back(known ? *known : CachedShapes{at.shapes, at.apart, {}, false});
    if (known && !known->touch)
      near.shapes.back().margin = at.apart >= reach_ ? at.apart : margin_left(*known);
  }
}

/// Runs the narrow phase on two shapes, and collects the manifolds.
void CompoundPair::look_at(CachedShapes& piece) {
  Memory& m = memory();
  const PairSide &a = side_a(piece), &b = side_b(piece);
  const uint64_t mark = mark_of(piece.shapes);
  m.kept.assign(pressed_.begin(), pressed_.end());
  for (uint64_t& feature : m.kept) feature ^= mark;
  ContactQuery query{finder_.reach(a, b) + slack_, finder_.hierarchy, m.kept};
  if (piece.touch) query.start = &piece.closest;
  const size_t first = m.found.manifolds.size();
  const PairContacts::Look seen = finder_.look_at_shapes(a, b, query, m.found.manifolds);
  m.found.shapes.resize(m.found.manifolds.size(), piece.shapes);
  for (size_t i = first; i < m.found.manifolds.size(); ++i)
    for (ManifoldPoint& p : m.found.manifolds[i].used()) p.feature ^= mark;
  piece.margin = seen.margin;
  piece.touch = !seen.none;
  piece.closest = seen.none ? ClosestFeatures{} : m.found.manifolds[first].closest;
  asked_ = std::max(asked_, query.margin);
}

/// Runs the narrow phase on pairs of shapes that were apart and may have come near. Returns whether
/// any of them touches now.
bool CompoundPair::look_at_those_apart(KnownShapes& near) {
  bool touch = false;
  for (CachedShapes& piece : near.shapes) {
    if (piece.touch || piece.margin >= reach_ || piece.margin >= reach_of(piece)) continue;
    look_at(piece);
    touch = touch || piece.touch;
  }
  near.relative_apart = now_;
  return touch;
}

bool CompoundPair::look(Sights& sights) {
  if (knows()) {
    sights.seen.push_back(*history_.seen);
    if (history_.near) sights.near.push_back(*history_.near);
    return true;
  }
  Memory& m = memory();
  m.found.manifolds.clear();
  m.found.shapes.clear();
  pressed_ = pressed_features(history_.contacts, m.features);
  const std::shared_ptr<KnownShapes> near = m.lists.get();
  renew_list(sights, *near);
  if (!near->shapes.empty()) sights.near.push_back({sights.seen.back().pair, near});
  m.touched.clear();
  for (uint32_t i = 0; i < near->shapes.size(); ++i)
    if (near->shapes[i].touch) m.touched.push_back(i);
  const bool carried = m.touched.size() == before_.touching && contacts_hold();
  near->relative_touching = before_.relative_touching;
  const bool touch = look_at_those_apart(*near);
  if (touch || !carried) {
    for (const uint32_t i : m.touched) look_at(near->shapes[i]);
    near->relative_touching = now_;
  }
  near->sum_up();
  if (!touch && carried) return true;
  share_manifolds(finder_.bodies[a_.body], finder_.bodies[b_.body], m.found, asked_, pressed_,
                  sights.manifolds, sights.shapes);
  return false;
}

}  // namespace tumble
