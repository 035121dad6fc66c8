#include "engine/dynamics/realtime/continuous.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/chunks.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/dynamics/realtime/swept_pair.hpp"
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

/// How far a body came in a tick, at most [m].
double way_of(const RigidBody& body, const Pose& start, double h) {
  const double straight = (body.pose.x - start.x).norm();
  // The angle is 2 asin(sine) <= pi sine.
  const double sine = (body.pose.q * start.q.conjugate()).vec().norm();
  if (sine == 0 && !winds(body, h)) return straight;
  return straight + (winds(body, h) ? 2.0 : std::min(3.2 * sine, 2.0)) * body.bounding_radius;
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
  struct Part {
    bool fast = false;
    double least = never;  ///< unwatched() of the dynamic
    double farthest = 0;   ///< way of any
  };
  std::array<Part, chunk_count> parts{};
  for_chunks(&crew, involved_.size(), [&](size_t chunk, size_t first, size_t last) {
    Part& part = parts[chunk];
    for (size_t k = first; k < last && !part.fast; ++k) {
      prefetch<sizeof(RigidBody)>(
          &bodies[involved_[std::min(k + tolerances::bodies_ahead, last - 1)]]);
      const RigidBody& body = bodies[involved_[k]];
      if (!is_active(body)) continue;
      const double way = way_of(body, starts_[involved_[k]].pose, h);
      part.farthest = std::max(part.farthest, way);
      if (!body.dynamic()) continue;
      const double least = unwatched(body);
      part.least = std::min(part.least, least);
      part.fast = winds(body, h) || !(way < least);
    }
  });
  Part all;
  for (const Part& part : parts) {
    all.fast |= part.fast;
    all.least = std::min(all.least, part.least);
    all.farthest = std::max(all.farthest, part.farthest);
  }
  return !all.fast && !(all.farthest > all.least);
}

double ContinuousStage::least_unwatched(std::span<const RigidBody> bodies) const {
  double least = never;
  for (const uint32_t i : involved_)
    if (bodies[i].dynamic() && bodies[i].awake()) least = std::min(least, unwatched(bodies[i]));
  return least;
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
  const double least = least_unwatched(bodies);
  for (const uint32_t i : stale_) {
    Track& track = tracks_[i];
    const RigidBody& body = bodies[i];
    track.fast = track.sweeps = false;
    if (!is_active(body)) {
      track.motion = Motion::at_rest(body.pose, 0, h);
      continue;
    }
    const Pose& start = starts_[i].pose;
    track.motion = tick_motion(start, body, h);
    if (body.dynamic()) {
      const double turn = std::min(track.motion.omega.norm() * h, 2.0) * body.bounding_radius;
      track.fast = (body.pose.x - start.x).norm() + turn > unwatched(body);
    }
    track.sweeps = track.fast || way_of(body, start, h) > least;
    stats.fast += track.sweeps;
  }
}

double ContinuousStage::way_along(std::span<const RigidBody> bodies, ShapeRef ref,
                                  uint32_t kinematic) const {
  const RigidBody &body = bodies[ref.body], &frame = bodies[kinematic];
  if (winds(frame, h_)) return never;
  const BodyShape& shape = body.shapes[ref.shape];
  const Pose& start = is_active(body) ? starts_[ref.body].pose : body.pose;
  const Pose before = starts_[kinematic].pose.inverse() * start * shape.pose;
  const Pose after = frame.pose.inverse() * body.pose * shape.pose;
  const double sine = (after.q * before.q.conjugate()).vec().norm();
  const double angle = tracks_[kinematic].motion.omega.norm() * h_;
  return (after.x - before.x).norm() + arc_height(angle, before.x.norm()) +
         std::min(3.2 * sine, 2.0) * shape.shape->bounding_radius();
}

bool ContinuousStage::goes_over(std::span<const RigidBody> bodies, uint32_t body,
                                uint32_t other) const {
  const Track& track = tracks_[body];
  return track.fast || (track.sweeps && bodies[other].dynamic() &&
                        way_of(bodies[body], starts_[body].pose, h_) > unwatched(bodies[other]));
}

bool ContinuousStage::far_apart(std::span<const RigidBody> bodies, ShapeRef a, ShapeRef b) const {
  if (!goes_over(bodies, a.body, b.body) && !goes_over(bodies, b.body, a.body)) return false;
  for (const auto& [ref, other] : {std::pair(a, b.body), std::pair(b, a.body)}) {
    const RigidBody& body = bodies[ref.body];
    if (tracks_[ref.body].fast || bodies[other].dynamic() || !is_active(bodies[other])) continue;
    return way_along(bodies, ref, other) > unwatched(body, *body.shapes[ref.shape].shape);
  }
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
    proxies_.proxies[at] = {bounds, tracks_[slot].sweeps};
    proxies_.refs[at] = {slot, s};
    (tracks_[slot].sweeps ? proxies_.news.moving : proxies_.news.settled).push_back(at);
  }
}

void ContinuousStage::find_candidates(std::span<const RigidBody> bodies, BroadPhase& broad_phase) {
  if (all_stale_) number_shape_proxies(bodies, proxies_);
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
  candidates_.clear();
  pairs_.clear();
  find_pairs(broad_phase, most);
}

/// What is known of pairs that were found before stays.
void ContinuousStage::find_pairs(BroadPhase& broad_phase, bool most) {
  const std::vector<ProxyPair> old_pairs = std::move(pairs_);
  const std::vector<Candidate> old = std::move(candidates_);
  pairs_.clear();
  candidates_.clear();
  broad_phase.set_owners(proxies_.owners);
  if (most)
    broad_phase.find_pairs(proxies_.proxies, pairs_);
  else
    broad_phase.find_pairs(proxies_.proxies, proxies_.news, pairs_);
  if (apart_) apart_->apply(proxies_, pairs_);
  auto known = old_pairs.begin();
  for (const ProxyPair& p : pairs_) {
    while (known != old_pairs.end() && *known < p) ++known;
    if (known != old_pairs.end() && *known == p) {
      candidates_.push_back(old[size_t(known - old_pairs.begin())]);
      continue;
    }
    Candidate& c = candidates_.emplace_back();
    c.a = proxies_.refs[p.a];
    c.b = proxies_.refs[p.b];
  }
}

/// Which pair it is, and how deep it may come.
SweptPair ContinuousStage::swept_pair(std::span<const RigidBody> bodies, const JoinedWays& ways,
                                      Candidate& c) const {
  const Track& ta = tracks_[c.a.body];
  const Track& tb = tracks_[c.b.body];
  const RigidBody& a = bodies[c.a.body];
  const RigidBody& b = bodies[c.b.body];
  const BodyShape& sa = a.shapes[c.a.shape];
  const BodyShape& sb = b.shapes[c.b.shape];
  const double size = std::min(a.bounding_radius, b.bounding_radius);
  // Meshes may have no inside at all: some depth must pass as shallow.
  const auto inside = [](const RigidBody& body, bool counts) {
    return body.dynamic() && counts ? body.inner_radius : never;
  };
  const bool neither = !ta.fast && !tb.fast;
  const double inner =
      std::max(std::min(inside(a, ta.fast || neither), inside(b, tb.fast || neither)),
               tolerances::thin_pair_of_radius * size);
  const double shallow = tolerances::shallow_depth * inner;
  // Contacts of two surfaces of triangles know the way out up to the full thickness of both.
  const bool surfaces = triangles(*sa.shape, *sb.shape);
  const double thickness = std::min(sa.shape->least_thickness(), sb.shape->least_thickness());
  const double passable =
      (surfaces ? tolerances::passed_of_thickness : tolerances::shallow_depth) * thickness;
  const bool meshes = sa.shape->is_mesh() && sb.shape->is_mesh();
  c.thin = passable < shallow || (!meshes && thickness < tolerances::thin_pair_of_radius * size);
  c.firm = c.thin && (!a.dynamic() || !b.dynamic() || sa.shape->is_mesh() || sb.shape->is_mesh());
  const Way way_a = ways.way(c.a.body), way_b = ways.way(c.b.body);
  const bool carried = way_a.carried() || way_b.carried();
  double allowed = c.thin || surfaces ? passable : shallow;
  if (carried) allowed = std::min(allowed, tolerances::pressed_depth * inner);
  allowed = std::max(allowed, tolerances::least_contact_distance);
  const double precision =
      std::max(tolerances::contact_of_radius * std::min(size, tolerances::contact_radius),
               tolerances::least_contact_distance);
  // What touches has been in the solver's hands already. Held back, two bodies that both give way
  // would hang in the air while the rest moves on: thin convex ones, and surfaces of triangles that
  // do not come past each other in the tick.
  const double passing = (ta.motion.velocity - tb.motion.velocity).norm() +
                         ta.motion.omega.norm() * a.bounding_radius +
                         tb.motion.omega.norm() * b.bounding_radius;
  const bool watch_touching = carried || (c.thin ? c.firm : !surfaces || passing * h_ > thickness);
  return {.a = *sa.shape,
          .b = *sb.shape,
          .offset_a = sa.pose,
          .offset_b = sb.pose,
          .way_a = way_a,
          .way_b = way_b,
          .lever_a = a.bounding_radius,
          .lever_b = b.bounding_radius,
          .swing_a = swing(a, ta.motion),
          .swing_b = swing(b, tb.motion),
          .allowed = allowed,
          .growth = c.thin || carried ? 0 : std::max(allowed, tolerances::growing_overlap * inner),
          .watch_touching = watch_touching,
          .time_touching = c.thin || !surfaces,
          .tolerance = std::min(precision, tolerances::look_step * allowed),
          .narrow_phase = methods_.narrow_phase,
          .contact_time = methods_.contact_time};
}

void ContinuousStage::time_candidate(std::span<const RigidBody> bodies, const JoinedWays& ways,
                                     double h, Candidate& c) const {
  if (stop_requested()) return;
  c.version_a = ways.version(c.a.body);
  c.version_b = ways.version(c.b.body);
  c.timed = true;
  c.stop = swept_stop(swept_pair(bodies, ways, c), h);
}

void ContinuousStage::time_own(std::span<const RigidBody> bodies, const JoinedWays& own, double h,
                               Crew& crew) {
  crew.each(candidates_.size(), [&](size_t i) {
    Candidate& c = candidates_[i];
    c.held.reset();
    if (c.timed && c.version_a == 0 && c.version_b == 0) return;
    c.stop = {};
    c.version_a = c.version_b = 0;
    // Pairs that move together are timed only when one of them meets something.
    if (far_apart(bodies, c.a, c.b)) time_candidate(bodies, own, h, c);
  });
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

void ContinuousStage::join_in_order(std::span<const RigidBody> bodies, double h, JoinedWays& ways) {
  std::set<std::pair<double, size_t>> events;
  for (size_t i = 0; i < candidates_.size(); ++i) {
    if (candidates_[i].stop.time <= h) events.insert({candidates_[i].stop.time, i});
  }
  if (events.empty()) return;
  index_candidates(bodies.size());
  while (!events.empty() && !stop_requested()) {
    const auto [now, i] = *events.begin();
    events.erase(events.begin());
    Candidate& c = candidates_[i];
    const SweptStop stop = c.stop;
    const std::vector<uint32_t> changed =
        ways.meet(c.a.body, c.b.body, now, c.firm || goes_over(bodies, c.a.body, c.b.body),
                  c.firm || goes_over(bodies, c.b.body, c.a.body));
    if (!changed.empty()) c.held = stop;
    // What these were to meet changes, and they can get into the way of what would have missed
    // them.
    for (const uint32_t body : changed) {
      for (const uint32_t k : candidates_of(body)) {
        Candidate& other = candidates_[k];
        if (other.version_a == ways.version(other.a.body) &&
            other.version_b == ways.version(other.b.body))
          continue;
        events.erase({other.stop.time, k});
        if (ways.together(other.a.body, other.b.body)) continue;
        time_candidate(bodies, ways, h, other);
        if (other.stop.time >= now && other.stop.time <= h) events.insert({other.stop.time, k});
      }
    }
  }
}

bool ContinuousStage::follow_carried(std::span<const RigidBody> bodies, double h,
                                     const JoinedWays& ways, BroadPhase& broad_phase) {
  bool any = false;
  for (const uint32_t i : involved_) {
    const Way way = ways.way(i);
    if (!way.carried()) continue;
    for (uint32_t s = 0; s < bodies[i].shapes.size(); ++s) {
      const BodyShape& shape = bodies[i].shapes[s];
      BroadPhaseProxy& proxy = proxies_.proxies[proxies_.first[i] + s];
      Aabb bounds;
      for (double t = 0; t < h; t = std::min(way.next(t), h)) {
        const Motion& leg = way.leg(t);
        const double end = std::min(way.next(t), h);
        Aabb swept = shape.shape->bounds(leg.pose(t) * shape.pose);
        swept.include(shape.shape->bounds(leg.pose(end) * shape.pose));
        bounds.include(swept.inflated(
            arc_height(leg.omega.norm() * (end - t), leg.lever(bodies[i].bounding_radius))));
      }
      if (proxy.moving && proxy.bounds.contains(bounds.min) && proxy.bounds.contains(bounds.max))
        continue;
      proxy.bounds.include(bounds);
      proxy.moving = any = true;
    }
  }
  if (!any) return false;
  ++proxies_.news.number;
  proxies_.news.all = false;
  proxies_.news.moving.clear();
  proxies_.news.settled.clear();
  for (uint32_t k = 0; k < proxies_.proxies.size(); ++k)
    if (proxies_.proxies[k].moving) proxies_.news.moving.push_back(k);
  find_pairs(broad_phase, 2 * proxies_.news.moving.size() > proxies_.proxies.size());
  return true;
}

void ContinuousStage::place(std::span<RigidBody> bodies, double h, const JoinedWays& ways,
                            ContinuousStats& stats) const {
  std::vector<bool> watched(bodies.size(), false);
  for (const Candidate& c : candidates_)
    if (c.timed) watched[c.a.body] = watched[c.b.body] = true;
  for (const uint32_t i : involved_) {
    const Track& track = tracks_[i];
    RigidBody& body = bodies[i];
    const Way way = ways.way(i);
    if (!way.met() || !body.dynamic()) {
      // Where the angular velocity stood in for many turns it ends elsewhere.
      if (body.dynamic() && track.fast && watched[i] && winds(body, h))
        put_back(body, track.motion.carrier(h));
      continue;
    }
    ++stats.stopped;
    const Vec3 a_free = body.gravity_scale * gravity_ + body.inverse_mass * body.force;
    const bool flew =
        (body.v - starts_[i].v - h * a_free).norm() < tolerances::free_flight * (1 + body.v.norm());
    put_back(body, way.pose(h));
    // What gravity would have added on the way that it did not go must not stay with it.
    if (flew && !Way::moves(way.last()))
      body.v -= (h - way.last().t0) * body.gravity_scale * gravity_;
  }
}

ContinuousStats ContinuousStage::apply(std::span<RigidBody> bodies, BroadPhase& broad_phase,
                                       const IslandSet& islands, double h,
                                       const RealtimeSettings& settings, Crew& crew,
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
  const JoinedWays own(bodies, tracks_, islands, h);
  JoinedWays ways = own;
  bool more = true;
  while (more) {
    time_own(bodies, own, h, crew);
    ways = JoinedWays(bodies, tracks_, islands, h);
    join_in_order(bodies, h, ways);
    more = !stop_requested() && follow_carried(bodies, h, ways, broad_phase);
  }
  stats.tested = candidates_.size();
  place(bodies, h, ways, stats);
  for (const Candidate& c : candidates_)
    if (c.held && c.thin && c.held->deepens)
      stop_approach(bodies[c.a.body], bodies[c.b.body], c.held->at, c.held->normal);
  return stats;
}

}  // namespace tumble
