#include "engine/dynamics/realtime/continuous.hpp"

#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/chunks.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/dynamics/realtime/swept_body.hpp"
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

bool triangles(const Shape& a, const Shape& b) {
  return (a.is_mesh() || b.is_mesh()) && a.polyhedral() && b.polyhedral();
}

/// Angular velocity of a body as a set of points [rad/s]: rotation of a body of revolution about
/// its axis does not count.
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
  const bool any = everything || starts_.size() != bodies.size();
  if (any) {
    stale_tracks_.note_all();
    stale_proxies_.note_all();
    least_unwatched_ = never;
    for (const RigidBody& body : bodies)
      if (body.dynamic() && !body.shapes.empty())
        least_unwatched_ = std::min(least_unwatched_, unwatched(body));
  }
  stale_tracks_.note(bodies.size(), involved_);
  stale_proxies_.note(bodies.size(), involved_);
  starts_.resize(bodies.size());
  for_chunks(crew, involved.size(), [&](size_t, size_t first, size_t last) {
    for (const uint32_t i : involved.subspan(first, last - first))
      starts_[i] = {bodies[i].pose, bodies[i].v};
  });
}

bool ContinuousStage::all_slow(std::span<const RigidBody> bodies, double h, Crew& crew) const {
  const auto slow = [this, h](const RigidBody& body, const Pose& start) {
    if (!is_active(body)) return true;
    if (!body.dynamic()) return !(way_of(body, start, h) > least_unwatched_);
    return !winds(body, h) && way_of(body, start, h) < unwatched(body);
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

void ContinuousStage::find_fast(std::span<const RigidBody> bodies, double h,
                                ContinuousStats& stats) {
  if (h != h_ || tracks_.size() != bodies.size()) {
    stale_tracks_.note_all();
    stale_proxies_.note_all();
  }
  h_ = h;
  tracks_.resize(bodies.size());
  sweeping_.clear();
  for (const uint32_t i : stale_tracks_.slots(bodies.size())) {
    Track& track = tracks_[i];
    const RigidBody& body = bodies[i];
    track.stop = h;
    track.fast = false;
    track.carrier = none;
    if (!is_active(body)) {
      track.motion = Motion::at_rest(body.pose, 0, h);
      continue;
    }
    const Pose& start = starts_[i].pose;
    track.motion = tick_motion(start, body, h);
    if (!body.dynamic()) {
      if (way_of(body, start, h) > least_unwatched_) sweeping_.push_back(i);
      continue;
    }
    const double turn = std::min(track.motion.omega.norm() * h, 2.0) * body.bounding_radius;
    track.fast = (body.pose.x - start.x).norm() + turn > unwatched(body);
    stats.fast += track.fast;
  }
  // They are of this tick only.
  stale_tracks_.clear();
  stale_tracks_.note(bodies.size(), involved_);
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

Aabb ContinuousStage::swept_bounds(const RigidBody& body, uint32_t slot, uint32_t shape) const {
  const BodyShape& part = body.shapes[shape];
  Aabb bounds = part.shape->bounds(body.pose * part.pose);
  if (!is_active(body)) return bounds;
  bounds.include(part.shape->bounds(starts_[slot].pose * part.pose));
  const Motion& m = tracks_[slot].motion;
  // Where the angular velocity represents several turns, the computed motion ends at another pose.
  const double angle = m.omega.norm() * (m.t1 - m.t0);
  return bounds.inflated(winds(body, h_) ? 2 * body.bounding_radius
                                         : arc_height(angle, body.bounding_radius));
}

void ContinuousStage::put_proxies(const RigidBody& body, uint32_t slot) {
  for (uint32_t s = 0; s < body.shapes.size(); ++s) {
    const uint32_t at = proxies_.first[slot] + s;
    proxies_.proxies[at] = {swept_bounds(body, slot, s), tracks_[slot].fast};
    proxies_.refs[at] = {slot, s};
    (tracks_[slot].fast ? proxies_.news.moving : proxies_.news.settled).push_back(at);
  }
}

void ContinuousStage::find_candidates(std::span<const RigidBody> bodies, BroadPhase& broad_phase) {
  if (stale_proxies_.all()) number_shape_proxies(bodies, proxies_);
  ++proxies_.news.number;
  proxies_.news.all = stale_proxies_.all();
  proxies_.news.moving.clear();
  proxies_.news.settled.clear();
  const std::span<const uint32_t> stale = stale_proxies_.slots(bodies.size());
  for (const uint32_t i : stale) put_proxies(bodies[i], i);
  const bool most = 2 * stale.size() > bodies.size();
  // Bounds that cover the motion of this tick are of this tick only.
  stale_proxies_.clear();
  stale_proxies_.note(bodies.size(), involved_);
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
  }
}

/// The pair with its allowed depth; sets what kind of pair it is.
SweptPair ContinuousStage::swept_pair(std::span<const RigidBody> bodies, Candidate& c) const {
  const Track& ta = tracks_[c.a.body];
  const Track& tb = tracks_[c.b.body];
  const RigidBody& a = bodies[c.a.body];
  const RigidBody& b = bodies[c.b.body];
  const BodyShape& sa = a.shapes[c.a.shape];
  const BodyShape& sb = b.shapes[c.b.shape];
  const double size = std::min(a.bounding_radius, b.bounding_radius);
  // Meshes may have no inside at all: some depth must be allowed.
  const bool neither = !ta.fast && !tb.fast;
  const auto inside = [neither](const RigidBody& body, bool fast) {
    return body.dynamic() && (fast || neither) ? body.inner_radius : never;
  };
  const double inner = std::max(std::min(inside(a, ta.fast), inside(b, tb.fast)),
                                tolerances::thin_pair_of_radius * size);
  const double shallow = tolerances::shallow_depth * inner;
  // The contacts of two triangulated surfaces find the way out up to the full thickness of both.
  const bool surfaces = triangles(*sa.shape, *sb.shape);
  const double thickness = std::min(sa.shape->least_thickness(), sb.shape->least_thickness());
  const double passable =
      (surfaces ? tolerances::passed_of_thickness : tolerances::shallow_depth) * thickness;
  const bool meshes = sa.shape->is_mesh() && sb.shape->is_mesh();
  c.thin = passable < shallow || (!meshes && thickness < tolerances::thin_pair_of_radius * size);
  c.firm = c.thin && (!a.dynamic() || !b.dynamic() || sa.shape->is_mesh() || sb.shape->is_mesh());
  const double allowed =
      std::max(c.thin || surfaces ? passable : shallow, tolerances::least_contact_distance);
  const double precision =
      std::max(tolerances::contact_of_radius * std::min(size, tolerances::contact_radius),
               tolerances::least_contact_distance);
  // The solver knows the contacts of touching pairs already. If two bodies that both can move were
  // stopped, they would hang in the air while the rest moves on; so these are left to the solver:
  // thin convex bodies, and triangulated surfaces that do not pass their thickness in the tick.
  const double passing = (ta.motion.velocity - tb.motion.velocity).norm() +
                         ta.motion.omega.norm() * a.bounding_radius +
                         tb.motion.omega.norm() * b.bounding_radius;
  const bool watch_touching = c.thin ? c.firm : !surfaces || passing * h_ > thickness;
  return {.a = *sa.shape,
          .b = *sb.shape,
          .offset_a = sa.pose,
          .offset_b = sb.pose,
          .motion_a = ta.motion,
          .motion_b = tb.motion,
          .stop_a = ta.stop,
          .stop_b = tb.stop,
          .lever_a = a.bounding_radius,
          .lever_b = b.bounding_radius,
          .swing_a = swing(a, ta.motion),
          .swing_b = swing(b, tb.motion),
          .reach = c.reach,
          .allowed = allowed,
          .growth = c.thin ? 0 : std::max(allowed, tolerances::growing_overlap * inner),
          .watch_touching = watch_touching,
          .time_touching = c.thin || !surfaces,
          .tolerance = std::min(precision, tolerances::look_step * allowed),
          .narrow_phase = methods_.narrow_phase,
          .contact_time = methods_.contact_time};
}

void ContinuousStage::time_candidate(std::span<const RigidBody> bodies, double h,
                                     Candidate& c) const {
  if (stop_requested()) return;
  c.stop_a = tracks_[c.a.body].stop;
  c.stop_b = tracks_[c.b.body].stop;
  c.stop = swept_stop(swept_pair(bodies, c), h);
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
    if (candidates_[i].stop.time <= h) events.insert({candidates_[i].stop.time, i});
  }
  if (events.empty()) return;
  index_candidates(bodies.size());
  // When a body stops early, its later contacts change and are computed anew.
  while (!events.empty() && !stop_requested()) {
    const size_t i = events.begin()->second;
    events.erase(events.begin());
    Candidate& c = candidates_[i];
    Track& a = tracks_[c.a.body];
    Track& b = tracks_[c.b.body];
    if (c.stop_a != a.stop || c.stop_b != b.stop) {
      time_candidate(bodies, h, c);
      if (c.stop.time <= h) events.insert({c.stop.time, i});
      continue;
    }
    std::vector<uint32_t> stopped;
    for (const uint32_t body : {c.a.body, c.b.body}) {
      const bool gives_way = bodies[body].dynamic() && bodies[body].awake();
      if (tracks_[body].stop > c.stop.time && (tracks_[body].fast || (c.firm && gives_way)))
        stopped.push_back(body);
    }
    for (const uint32_t body : stopped) tracks_[body].stop = c.stop.time;
    c.held = !stopped.empty();
    // A stopped body can also block a body that would have missed it.
    for (const uint32_t body : stopped) {
      for (const uint32_t k : candidates_of(body)) {
        Candidate& other = candidates_[k];
        if (k == i || other.stop.time <= h) continue;
        time_candidate(bodies, h, other);
        if (other.stop.time <= h) events.insert({other.stop.time, k});
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
      // The computed motion of a body with several turns ends at another pose.
      if (track.fast && watched[i] && winds(body, h)) put_at(body, track.motion.carrier(h));
      continue;
    }
    ++stats.stopped;
    const Vec3 a_free = body.gravity_scale * gravity_ + body.inverse_mass * body.force;
    const bool flew =
        (body.v - starts_[i].v - h * a_free).norm() < tolerances::free_flight * (1 + body.v.norm());
    put_at(body, track.motion.carrier(track.stop));
    // Removes the speed that gravity would have added on the rest of the path.
    if (flew) body.v -= (h - track.stop) * body.gravity_scale * gravity_;
  }
}

/// Stops fast bodies at obstacles.
void ContinuousStage::hold_fast(std::span<RigidBody> bodies, BroadPhase& broad_phase, double h,
                                Crew& crew, ContinuousStats& stats) {
  broad_phase.use_threads(&crew);
  find_candidates(bodies, broad_phase);
  stats.tested += candidates_.size();
  crew.each(candidates_.size(), [&](size_t i) {
    Candidate& c = candidates_[i];
    // Pairs that move together are timed only if one of them is stopped.
    if (far_apart(bodies, c.a, c.b)) time_candidate(bodies, h, c);
  });
  stop_in_order(bodies, h);
  place(bodies, h, stats);
  for (const Candidate& c : candidates_)
    if (c.held && c.thin && c.stop.deepens)
      stop_approach(bodies[c.a.body], bodies[c.b.body], c.stop.at, c.stop.normal);
}

ContinuousStats ContinuousStage::apply(std::span<RigidBody> bodies, BroadPhase& broad_phase,
                                       double h, const RealtimeSettings& settings, Crew& crew,
                                       const ContinuousMethods& methods) {
  ContinuousStats stats;
  methods_ = methods;
  woken_.clear();
  carried_.clear();
  if (!settings.continuous || starts_.size() != bodies.size()) return stats;
  if (all_slow(bodies, h, crew)) return stats;
  find_fast(bodies, h, stats);
  if (stats.fast > 0) hold_fast(bodies, broad_phase, h, crew, stats);
  if (!sweeping_.empty()) carry_along(bodies, h, crew, stats);
  return stats;
}

}  // namespace tumble
