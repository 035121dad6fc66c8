#include "engine/dynamics/contact/compound_pair.hpp"

#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// What is remembered of two shapes; null if nothing is.
const CachedShapes* find_piece(std::span<const CachedShapes> pieces, const ShapesOfPair& at) {
  const auto found = std::ranges::lower_bound(pieces, at, {}, &CachedShapes::shapes);
  return found != pieces.end() && found->shapes == at ? &*found : nullptr;
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
};

Memory& memory() {
  static thread_local Memory m;
  return m;
}

constexpr ShapesOfPair no_shapes{~uint32_t{0}, ~uint32_t{0}};

}  // namespace

CompoundPair::CompoundPair(const PairContacts& finder, const PairSide& a, const PairSide& b,
                           const PairHistory& history)
    : finder_(finder),
      a_(a),
      b_(b),
      history_(history),
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

/// Bound on the relative motion of two shapes, at the smaller of them [m].
double CompoundPair::moved(const CachedShapes& piece) {
  const bool first = smaller_first(a_, b_);
  const PairSide &small = first ? a_ : b_, &large = first ? b_ : a_;
  const uint32_t of_small = first ? piece.shapes.a : piece.shapes.b;
  const uint32_t of_large = first ? piece.shapes.b : piece.shapes.a;
  const MotionSince& motion = points_since(piece.relative);
  const double radius = radius_of(small, of_small), other = radius_of(large, of_large);
  return other < radius ? motion.shift(centre_in(large, of_large), other)
                        : motion.shift(now_.point(centre_in(small, of_small)), radius);
}

/// Whether two shapes, which were apart or had gaps up to a margin, still have no other gap in
/// reach.
bool CompoundPair::still_seen(const CachedShapes& piece) {
  if (piece.margin - motion_since(piece.relative).most >= reach_) return true;
  const double left = piece.margin - moved(piece);
  return left >= reach_ || left >= reach_of(piece);
}

/// Whether the contacts may be carried along. The narrow phase last ran on all touching shapes at
/// once.
bool CompoundPair::contacts_hold() {
  if (!hold_) hold_ = find_whether_they_hold();
  return *hold_;
}

bool CompoundPair::find_whether_they_hold() {
  const auto touching = std::ranges::find_if(history_.pieces, &CachedShapes::touch);
  if (history_.contacts.empty() || touching == history_.pieces.end())
    return history_.contacts.empty() && touching == history_.pieces.end();
  const bool first = smaller_first(a_, b_);
  const Pose in_large = (first ? b_ : a_).shape_pose.inverse() * (first ? a_ : b_).body_pose;
  const MotionSince& motion = points_since(touching->relative);
  const double tolerance = seen_tolerance(std::min(a_.margin, b_.margin));
  for (const Contact& c : history_.contacts)
    for (const ContactPoint& p : c.used())
      if (motion.shift(in_large.point(first ? p.anchor_a : p.anchor_b)) > tolerance) return false;
  return std::ranges::all_of(history_.pieces, [this](const CachedShapes& p) {
    return !p.touch ||
           (flat_surface(a_, p.shapes.a) && flat_surface(b_, p.shapes.b) && still_seen(p));
  });
}

bool CompoundPair::knows() {
  if (!history_.seen) return false;
  if (history_.seen->margin - motion_since(history_.seen->relative).most < reach_) return false;
  return contacts_hold() && std::ranges::all_of(history_.pieces, [this](const CachedShapes& p) {
           return p.touch || still_seen(p);
         });
}

/// Appends what is remembered of the bodies, and of all pairs of their shapes that are near each
/// other; pairs that were not listed before are known by the distance of their bounding spheres
/// only.
void CompoundPair::renew_list(Sights& sights) {
  const double asked = reach_ + slack_;
  const ContactKey key{a_.body, a_.shape_index, b_.body, b_.shape_index, 0};
  if (history_.seen) {
    const double left = history_.seen->margin - motion_since(history_.seen->relative).most;
    if (left >= asked) {
      sights.seen.push_back({key, now_, left});
      sights.pieces.insert(sights.pieces.end(), history_.pieces.begin(), history_.pieces.end());
      return;
    }
  }
  std::vector<ShapesNear>& near = memory().near;
  const double wanted = tolerances::list_of_reach * asked + std::min(a_.margin, b_.margin);
  const double listed =
      find_shape_pairs(side_shapes(finder_.bodies[a_.body], a_.shape_index),
                       side_shapes(finder_.bodies[b_.body], b_.shape_index), wanted, near);
  sights.seen.push_back({key, now_, listed});
  for (const ShapesNear& at : near) {
    const CachedShapes* known = find_piece(history_.pieces, at.shapes);
    sights.pieces.push_back(known ? *known
                                  : CachedShapes{key, at.shapes, now_, at.apart, {}, false});
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
  piece.relative = now_;
  piece.margin = seen.margin;
  piece.touch = !seen.none;
  piece.closest = seen.none ? ClosestFeatures{} : m.found.manifolds[first].closest;
  asked_ = std::max(asked_, query.margin);
}

/// Runs the narrow phase on pairs of shapes that were apart and may have come near. Returns whether
/// any of them touches now.
bool CompoundPair::look_at_those_apart(std::span<CachedShapes> pieces) {
  bool touch = false;
  for (CachedShapes& piece : pieces) {
    if (piece.touch) continue;
    const double left = piece.margin - moved(piece);
    if (left >= reach_ || left >= reach_of(piece)) {
      piece.margin = left;
      piece.relative = now_;
      continue;
    }
    look_at(piece);
    touch = touch || piece.touch;
  }
  return touch;
}

bool CompoundPair::look(Sights& sights) {
  if (knows()) {
    sights.seen.push_back(*history_.seen);
    sights.pieces.insert(sights.pieces.end(), history_.pieces.begin(), history_.pieces.end());
    return true;
  }
  Memory& m = memory();
  m.found.manifolds.clear();
  m.found.shapes.clear();
  pressed_ = pressed_features(history_.contacts, m.features);
  const size_t place = sights.pieces.size();
  renew_list(sights);
  const std::span pieces = std::span(sights.pieces).subspan(place);
  m.touched.clear();
  for (uint32_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].touch) m.touched.push_back(i);
  const bool all_listed =
      m.touched.size() == size_t(std::ranges::count_if(history_.pieces, &CachedShapes::touch));
  const bool carried = all_listed && contacts_hold();
  if (!look_at_those_apart(pieces) && carried) return true;
  for (const uint32_t i : m.touched) look_at(pieces[i]);
  share_manifolds(finder_.bodies[a_.body], finder_.bodies[b_.body], m.found, asked_, pressed_,
                  sights.manifolds, sights.shapes);
  return false;
}

}  // namespace tumble
