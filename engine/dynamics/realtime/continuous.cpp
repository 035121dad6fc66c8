#include "engine/dynamics/realtime/continuous.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/chunks.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/dynamics/realtime/thin_contact.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace tumble {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Whether a body turns so far in a tick that the shortest way from pose to pose may not be its
/// way.
bool winds(const RigidBody& body, double h) {
  return body.omega.norm() * h > tolerances::winding_of_half_turn * std::numbers::pi;
}

/// The motion over a tick that ended at `body.pose`.
Motion tick_motion(const Pose& start, const RigidBody& body, double h) {
  Motion m = Motion::between(start, body.pose, 0, h);
  // More than half a turn looks like less: the angular velocity knows.
  if (winds(body, h)) m.omega = body.omega;
  return m;
}

bool triangles(const Shape& a, const Shape& b) {
  return (a.is_mesh() || b.is_mesh()) && a.polyhedral() && b.polyhedral();
}

/// Whether two surfaces of triangles overlap.
bool meshes_touch(const BodyShape& a, const Pose& pose_a, const BodyShape& b, const Pose& pose_b,
                  NarrowPhase narrow_phase) {
  if (!triangles(*a.shape, *b.shape)) return false;
  std::vector<Manifold> manifolds;
  narrow_phase(*a.shape, pose_a * a.pose, *b.shape, pose_b * b.pose, 0, manifolds);
  return !manifolds.empty();
}

/// How far two shapes may close without being stopped [m]. Contacts of two surfaces of triangles
/// know the way out up to the full thickness of both.
double allowed_depth(const Shape& a, const Shape& b, double inner) {
  if (!triangles(a, b)) return tolerances::shallow_depth * inner;
  const double thin =
      std::min(a.polyhedral()->surface().min_thickness, b.polyhedral()->surface().min_thickness);
  return std::max(tolerances::shallow_depth * inner, tolerances::passed_of_thickness * thin);
}

Vec3 point_velocity(const Motion& m, double t, const Vec3& x_world) {
  return m.velocity + m.omega.cross(x_world - m.carrier(t).x);
}

/// How far a body may come in a tick before it is watched [m]: as far as its contacts foresee, but
/// a thin convex one, which has no inside to be pushed out of, by no more than a fiftieth of its
/// size.
double unwatched(const RigidBody& body) {
  constexpr double share = tolerances::thin_of_size;
  const bool thin = body.inner_radius < share * body.bounding_radius &&
                    std::all_of(body.shapes.begin(), body.shapes.end(),
                                [](const BodyShape& s) { return !s.shape->is_mesh(); });
  return thin ? share * body.bounding_radius : foresight(body);
}

/// The same of one of its shapes, which may be small beside the body.
double unwatched(const RigidBody& body, const Shape& shape) {
  const double own =
      std::max(shape.inner_radius(), tolerances::foresight_of_radius * shape.bounding_radius());
  return std::min(unwatched(body), own);
}

/// How fast the set of a body's points turns [rad/s]: without the spin of what is round about an
/// axis about it.
double swing(const RigidBody& body, const Motion& m) {
  if (body.shapes.size() != 1) return m.omega.norm();
  const BodyShape& s = body.shapes[0];
  const Vec3 axis = s.pose.direction(Vec3::UnitY());
  const bool round = s.shape->symmetry() == ShapeSymmetry::axis;
  if (!round ||
      s.pose.x.cross(axis).norm() > tolerances::axis_through_centre * body.bounding_radius)
    return m.omega.norm();
  return m.omega.cross(m.start.direction(axis)).norm();
}

/// Sets a body to an earlier pose. Its angular velocity goes with it, so that its energy stays:
/// with the moments of inertia of another orientation a needle would have many times as much.
void put_back(RigidBody& body, const Pose& pose) {
  if (!isotropic_inertia(body.inertia_body))
    body.omega = pose.direction(body.pose.inverse_direction(body.omega));
  body.pose = pose;
}

}  // namespace

TimeOfContactOptions ContinuousMethods::by_advancement() {
  TimeOfContactOptions options;
  for (const ContactTimeMethod& method : all_contact_time_methods())
    if (method.name == "conservative_advancement") options.method = &method;
  return options;
}

void ContinuousStage::remember(std::span<const RigidBody> bodies,
                               std::span<const uint32_t> involved, const Vec3& gravity, Crew* crew,
                               bool everything) {
  gravity_ = gravity;
  involved_.assign(involved.begin(), involved.end());
  note_stale(bodies.size(), everything || starts_.size() != bodies.size());
  starts_.resize(bodies.size());
  for_chunks(crew, involved.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t i : involved.subspan(first, last - first))
      starts_[i] = {bodies[i].pose, bodies[i].v};
  });
}

bool ContinuousStage::all_slow(std::span<const RigidBody> bodies, double h, Crew& crew) const {
  const auto slow = [h](const RigidBody& body, const Pose& start) {
    if (!body.awake() || !body.dynamic()) return true;
    if (winds(body, h)) return false;
    // The angle is 2 asin(sine) <= pi sine.
    const double sine = (body.pose.q * start.q.conjugate()).vec().norm();
    const double turn = std::min(3.2 * sine, 2.0) * body.bounding_radius;
    return (body.pose.x - start.x).norm() + turn < unwatched(body);
  };
  std::array<bool, chunk_count> fast{};
  for_chunks(&crew, involved_.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t k = first; k < last && !fast[chunk]; ++k) {
      prefetch<sizeof(RigidBody)>(
          &bodies[involved_[std::min(k + tolerances::bodies_ahead, last - 1)]]);
      fast[chunk] = !slow(bodies[involved_[k]], starts_[involved_[k]].pose);
    }
  });
  return std::ranges::none_of(fast, [](bool any) { return any; });
}

/// What was worked out of the involved when something was fast does not hold any more.
void ContinuousStage::note_stale(size_t bodies, bool everything) {
  all_stale_ |= everything;
  if (all_stale_) return;
  is_stale_.resize(bodies, 0);
  for (const uint32_t i : involved_)
    if (!std::exchange(is_stale_[i], uint8_t{1})) stale_.push_back(i);
}

void ContinuousStage::find_fast(std::span<const RigidBody> bodies, double h,
                                ContinuousStats& stats) {
  if (h != h_ || tracks_.size() != bodies.size()) all_stale_ = true;
  h_ = h;
  tracks_.resize(bodies.size());
  if (all_stale_) {
    stale_.resize(bodies.size());
    std::iota(stale_.begin(), stale_.end(), 0u);
  } else {
    std::ranges::sort(stale_);
  }
  for (const uint32_t i : stale_) {
    Track& track = tracks_[i];
    const RigidBody& body = bodies[i];
    track.stop = h;
    track.fast = false;
    if (!is_active(body)) {
      track.motion = Motion::at_rest(body.pose, 0, h);
      continue;
    }
    const Pose& start = starts_[i].pose;
    track.motion = tick_motion(start, body, h);
    if (!body.dynamic()) continue;
    const double turn = std::min(track.motion.omega.norm() * h, 2.0) * body.bounding_radius;
    track.fast = (body.pose.x - start.x).norm() + turn > unwatched(body);
    stats.fast += track.fast;
  }
}

bool ContinuousStage::far_apart(std::span<const RigidBody> bodies, ShapeRef a, ShapeRef b) const {
  double allowed = never, turning = 0;
  const auto way = [&](ShapeRef ref) -> Vec3 {
    const RigidBody& body = bodies[ref.body];
    const Track& track = tracks_[ref.body];
    const BodyShape& shape = body.shapes[ref.shape];
    if (body.dynamic()) allowed = std::min(allowed, unwatched(body, *shape.shape));
    if (!is_active(body)) return Vec3::Zero();
    const Pose& start = starts_[ref.body].pose;
    const double angle = track.motion.omega.norm() * (track.motion.t1 - track.motion.t0);
    if (angle >= tolerances::series_turn) {
      turning += std::min(angle, 2.0) * body.bounding_radius;
      return body.pose.x - start.x;
    }
    if (angle > 0)
      turning += angle * shape.shape->bounding_radius() + arc_height(angle, shape.pose.x.norm());
    return body.pose.point(shape.pose.x) - start.point(shape.pose.x);
  };
  const double straight = (way(a) - way(b)).norm();
  return straight + turning > allowed;
}

void ContinuousStage::put_proxies(const RigidBody& body, uint32_t slot) {
  const Motion& m = tracks_[slot].motion;
  // Where the angular velocity stands in for many turns, the end of the motion is elsewhere.
  const double angle = m.omega.norm() * (m.t1 - m.t0);
  const double height =
      winds(body, h_) ? 2 * body.bounding_radius : arc_height(angle, body.bounding_radius);
  for (uint32_t s = 0; s < body.shapes.size(); ++s) {
    const Shape& shape = *body.shapes[s].shape;
    Aabb bounds = shape.bounds(body.pose * body.shapes[s].pose);
    if (is_active(body)) {
      bounds.include(shape.bounds(starts_[slot].pose * body.shapes[s].pose));
      bounds = bounds.inflated(height);
    }
    const uint32_t at = proxies_.first[slot] + s;
    proxies_.proxies[at] = {bounds, tracks_[slot].fast};
    proxies_.refs[at] = {slot, s};
    (tracks_[slot].fast ? proxies_.news.moving : proxies_.news.settled).push_back(at);
  }
}

void ContinuousStage::find_candidates(std::span<const RigidBody> bodies, BroadPhase& broad_phase) {
  if (all_stale_) number_proxies(bodies, proxies_);
  ++proxies_.news.number;
  proxies_.news.all = all_stale_;
  proxies_.news.moving.clear();
  proxies_.news.settled.clear();
  for (const uint32_t i : stale_) put_proxies(bodies[i], i);
  const bool most = 2 * stale_.size() > bodies.size();
  // What is involved now has been somewhere else when something is fast again.
  for (const uint32_t i : stale_)
    if (i < is_stale_.size()) is_stale_[i] = 0;
  stale_.clear();
  all_stale_ = false;
  note_stale(bodies.size(), false);
  broad_phase.set_owners(proxies_.owners);
  if (most)
    broad_phase.find_pairs(proxies_.proxies, pairs_);
  else
    broad_phase.find_pairs(proxies_.proxies, proxies_.news, pairs_);
  if (apart_) apart_->apply(proxies_, pairs_);
  candidates_.clear();
  for (const ProxyPair& p : pairs_) {
    Candidate& c = candidates_.emplace_back();
    c.a = proxies_.refs[p.a];
    c.b = proxies_.refs[p.b];
    c.time = never;
  }
}

double ContinuousStage::overlap_time(std::span<const RigidBody> bodies, double from, double h,
                                     const Candidate& c, double allowed) const {
  const Track& ta = tracks_[c.a.body];
  const Track& tb = tracks_[c.b.body];
  const RigidBody& a = bodies[c.a.body];
  const RigidBody& b = bodies[c.b.body];
  const BodyShape& sa = a.shapes[c.a.shape];
  const BodyShape& sb = b.shapes[c.b.shape];
  const auto depth = [&](double t) {
    std::vector<Manifold> manifolds;
    methods_.narrow_phase(*sa.shape, ta.motion.carrier(std::min(t, ta.stop)) * sa.pose, *sb.shape,
                          tb.motion.carrier(std::min(t, tb.stop)) * sb.pose, 0, manifolds);
    double deepest = 0;
    for (const Manifold& m : manifolds) {
      for (int i = 0; i < m.count; ++i) deepest = std::max(deepest, -m.points[size_t(i)].gap);
    }
    return deepest;
  };
  double speed = (ta.fast ? ta.motion.speed_bound(a.bounding_radius) : 0) +
                 (tb.fast ? tb.motion.speed_bound(b.bounding_radius) : 0);
  if (triangles(*sa.shape, *sb.shape)) {
    // Things that tumble together need few looks, and each costs time.
    speed = (ta.motion.velocity - tb.motion.velocity).norm() +
            ta.motion.omega.norm() * a.bounding_radius + tb.motion.omega.norm() * b.bounding_radius;
  }
  const double step = allowed / speed;
  const double start = depth(from);
  constexpr int most = tolerances::most_samples;
  for (int k = 1; k <= most && !stop_requested(); ++k) {
    const double t = std::min(from + k * step, h);
    if (depth(t) > start + allowed) return t - step;
    if (t >= h) return never;
  }
  // It turns too fast to be sampled over the whole tick: it goes as far as was sampled.
  return from + most * step;
}

void ContinuousStage::time_candidate(std::span<const RigidBody> bodies, double h,
                                     Candidate& c) const {
  const Track& ta = tracks_[c.a.body];
  const Track& tb = tracks_[c.b.body];
  const RigidBody& a = bodies[c.a.body];
  const RigidBody& b = bodies[c.b.body];
  const BodyShape& sa = a.shapes[c.a.shape];
  const BodyShape& sb = b.shapes[c.b.shape];
  c.time = never;
  c.deepens = c.firm = false;
  if (stop_requested()) return;
  c.stop_a = ta.stop;
  c.stop_b = tb.stop;
  const double size = std::min(a.bounding_radius, b.bounding_radius);
  // Meshes may have no inside at all: some depth must pass as shallow.
  const double inner =
      std::max(std::min(ta.fast ? a.inner_radius : never, tb.fast ? b.inner_radius : never),
               tolerances::thin_pair_of_radius * size);
  const double allowed = allowed_depth(*sa.shape, *sb.shape, inner);
  const double tolerance =
      std::max(tolerances::contact_of_radius * std::min(size, tolerances::contact_radius),
               tolerances::least_contact_distance);
  const double thin = std::min(sa.shape->least_thickness(), sb.shape->least_thickness());
  const double passable = (triangles(*sa.shape, *sb.shape) ? tolerances::passed_of_thickness
                                                           : tolerances::shallow_depth) *
                          thin;
  const bool meshes = sa.shape->is_mesh() && sb.shape->is_mesh();
  if (passable < allowed || (!meshes && thin < tolerances::thin_pair_of_radius * size)) {
    c.firm = !a.dynamic() || !b.dynamic() || sa.shape->is_mesh() || sb.shape->is_mesh();
    const SweptPair pair{*sa.shape,
                         *sb.shape,
                         sa.pose,
                         sb.pose,
                         ta.motion,
                         tb.motion,
                         ta.stop,
                         tb.stop,
                         a.bounding_radius,
                         b.bounding_radius,
                         swing(a, ta.motion),
                         swing(b, tb.motion),
                         c.firm,
                         methods_.narrow_phase,
                         methods_.contact_time};
    const double share = std::max(passable, tolerances::least_contact_distance);
    const ThinStop stop =
        thin_contact_time(pair, h, share, std::min(tolerance, tolerances::thin_step * share));
    c.time = stop.time;
    c.deepens = stop.deepens;
    c.at = stop.at;
    c.normal = stop.normal;
    return;
  }
  if (meshes_touch(sa, ta.motion.carrier(0), sb, tb.motion.carrier(0), methods_.narrow_phase)) {
    // Triangles inside the overlap would be hit at once, which means nothing; and the solver has
    // had this pair already. Held back, both would hang in the air while the rest moves on: only
    // what could pass through the other in a tick is looked at.
    const double travel = (ta.motion.velocity - tb.motion.velocity).norm() +
                          ta.motion.omega.norm() * a.bounding_radius +
                          tb.motion.omega.norm() * b.bounding_radius;
    if (travel * h > thin)
      c.time =
          overlap_time(bodies, 0, h, c, std::max(allowed, tolerances::growing_overlap * inner));
    return;
  }
  const double stops[4] = {0, std::min(ta.stop, tb.stop), std::max(ta.stop, tb.stop), h};
  for (int k = 0; k < 3; ++k) {
    double from = stops[k];
    // Shallow contacts are passed by; behind them there may be a wall of the same mesh.
    for (int tries = 0; tries < tolerances::most_passed_contacts && from < stops[k + 1]; ++tries) {
      const Motion ma = motion_section(ta.motion, ta.stop, from, stops[k + 1], sa.pose);
      const Motion mb = motion_section(tb.motion, tb.stop, from, stops[k + 1], sb.pose);
      const TimeOfContact hit =
          time_of_contact(*sa.shape, ma, *sb.shape, mb, tolerance, methods_.contact_time);
      if (!hit.hit()) {
        const bool touches = hit.status == TimeOfContactStatus::initially_overlapping && from == 0;
        const bool unknown = hit.status == TimeOfContactStatus::max_iterations;
        if (!touches && !unknown) break;
        c.time = overlap_time(bodies, touches ? from : hit.time, h, c,
                              std::max(allowed, tolerances::growing_overlap * inner));
        if (c.time <= h) return;
        break;
      }
      const double closing = hit.normal.dot(point_velocity(ma, hit.time, hit.on_a) -
                                            point_velocity(mb, hit.time, hit.on_b));
      if (closing * (stops[k + 1] - hit.time) > allowed) {
        c.time = hit.time;
        return;
      }
      if (!(hit.time > from)) break;
      from = hit.time;
    }
  }
}

void ContinuousStage::index_candidates(size_t bodies) {
  first_of_.assign(bodies + 1, 0);
  for (const Candidate& c : candidates_) ++first_of_[c.a.body + 1], ++first_of_[c.b.body + 1];
  for (size_t i = 1; i <= bodies; ++i) first_of_[i] += first_of_[i - 1];
  by_body_.resize(2 * candidates_.size());
  for (uint32_t k = 0; k < candidates_.size(); ++k)
    for (const uint32_t body : {candidates_[k].a.body, candidates_[k].b.body})
      by_body_[first_of_[body]++] = k;
  for (size_t i = bodies; i > 0; --i) first_of_[i] = first_of_[i - 1];
  first_of_[0] = 0;
}

void ContinuousStage::stop_in_order(std::span<const RigidBody> bodies, double h) {
  std::set<std::pair<double, size_t>> events;
  for (size_t i = 0; i < candidates_.size(); ++i) {
    if (candidates_[i].time <= h) events.insert({candidates_[i].time, i});
  }
  if (events.empty()) return;
  index_candidates(bodies.size());
  // Contacts ahead of a body that stops early change: whatever it was to meet is timed anew.
  while (!events.empty() && !stop_requested()) {
    const size_t i = events.begin()->second;
    events.erase(events.begin());
    Candidate& c = candidates_[i];
    Track& a = tracks_[c.a.body];
    Track& b = tracks_[c.b.body];
    if (c.stop_a != a.stop || c.stop_b != b.stop) {
      time_candidate(bodies, h, c);
      if (c.time <= h) events.insert({c.time, i});
      continue;
    }
    std::vector<uint32_t> stopped;
    for (const uint32_t body : {c.a.body, c.b.body}) {
      const bool gives_way = bodies[body].dynamic() && bodies[body].awake();
      if (tracks_[body].stop > c.time && (tracks_[body].fast || (c.firm && gives_way)))
        stopped.push_back(body);
    }
    for (const uint32_t body : stopped) tracks_[body].stop = c.time;
    c.held = !stopped.empty();
    // A stopped body can also get into the way of what would have missed it.
    for (const uint32_t body : stopped) {
      for (const uint32_t k : candidates_of(body)) {
        Candidate& other = candidates_[k];
        if (k == i || other.time <= h) continue;
        time_candidate(bodies, h, other);
        if (other.time <= h) events.insert({other.time, k});
      }
    }
  }
}

void ContinuousStage::place(std::span<RigidBody> bodies, double h, ContinuousStats& stats) const {
  std::vector<bool> watched(bodies.size(), false);
  for (const Candidate& c : candidates_)
    if (c.stop_a > 0 || c.stop_b > 0) watched[c.a.body] = watched[c.b.body] = true;
  for (const uint32_t i : involved_) {
    const Track& track = tracks_[i];
    RigidBody& body = bodies[i];
    if (track.stop >= h) {
      // Where the angular velocity stood in for many turns it ends elsewhere.
      if (track.fast && watched[i] && winds(body, h)) put_back(body, track.motion.carrier(h));
      continue;
    }
    ++stats.stopped;
    const Vec3 a_free = body.gravity_scale * gravity_ + body.inverse_mass * body.force;
    const bool flew =
        (body.v - starts_[i].v - h * a_free).norm() < tolerances::free_flight * (1 + body.v.norm());
    put_back(body, track.motion.carrier(track.stop));
    // What gravity would have added on the way that it did not go must not stay with it.
    if (flew) body.v -= (h - track.stop) * body.gravity_scale * gravity_;
  }
}

ContinuousStats ContinuousStage::apply(std::span<RigidBody> bodies, BroadPhase& broad_phase,
                                       double h, const RealtimeSettings& settings, Crew& crew,
                                       const ContinuousMethods& methods) {
  ContinuousStats stats;
  methods_ = methods;
  if (!settings.continuous || starts_.size() != bodies.size()) return stats;
  if (all_slow(bodies, h, crew)) return stats;
  find_fast(bodies, h, stats);
  if (stats.fast == 0) {
    if (all_stale_) stale_.clear();
    return stats;
  }
  broad_phase.use_threads(&crew);
  find_candidates(bodies, broad_phase);
  stats.tested = candidates_.size();
  crew.each(candidates_.size(), [&](size_t i) {
    Candidate& c = candidates_[i];
    // Pairs that move together are timed only when one of them is stopped.
    if (far_apart(bodies, c.a, c.b)) time_candidate(bodies, h, c);
  });
  stop_in_order(bodies, h);
  place(bodies, h, stats);
  for (const Candidate& c : candidates_)
    if (c.held && c.deepens) stop_approach(bodies[c.a.body], bodies[c.b.body], c.at, c.normal);
  return stats;
}

}  // namespace tumble
