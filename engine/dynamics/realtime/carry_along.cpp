// Bodies that kinematic bodies sweep over in a tick move along with these.
#include "engine/core/stop.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/dynamics/realtime/continuous.hpp"
#include "engine/dynamics/realtime/swept_body.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace tumble {

double ContinuousStage::way_along(std::span<const RigidBody> bodies, ShapeRef ref,
                                  uint32_t carrier) const {
  const RigidBody &body = bodies[ref.body], &frame = bodies[carrier];
  if (winds(frame, h_)) return std::numeric_limits<double>::infinity();
  const BodyShape& shape = body.shapes[ref.shape];
  const Motion& motion = tracks_[ref.body].motion;
  const Pose before = starts_[carrier].pose.inverse() * motion.start * shape.pose;
  const Pose after = frame.pose.inverse() * body.pose * shape.pose;
  const double angle = tracks_[carrier].motion.omega.norm() * h_;
  return (after.x - before.x).norm() + arc_height(angle, before.x.norm()) +
         turned_by(before.q, after.q, shape.shape->bounding_radius());
}

void ContinuousStage::list_places(std::span<const RigidBody> bodies) {
  places_.clear();
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& body = bodies[i];
    if (!body.dynamic() || body.shapes.empty() || tracks_[i].carrier != none) continue;
    const Vec3 reach = Vec3::Constant(body.bounding_radius);
    Aabb place{body.pose.x - reach, body.pose.x + reach};
    place.include(tracks_[i].motion.start.x - reach);
    place.include(tracks_[i].motion.start.x + reach);
    places_.push_back({place, i});
  }
}

void ContinuousStage::sort_places() {
  std::ranges::sort(places_, {},
                    [](const Place& p) { return std::pair(p.bounds.min.x(), p.slot); });
  widest_ = 0;
  for (const Place& p : places_) widest_ = std::max(widest_, p.bounds.max.x() - p.bounds.min.x());
}

std::span<const ContinuousStage::Place> ContinuousStage::places_from(double x) const {
  const auto first = std::ranges::lower_bound(places_, x - widest_, {},
                                              [](const Place& p) { return p.bounds.min.x(); });
  return {first, places_.end()};
}

void ContinuousStage::find_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier,
                                      bool sorted) {
  const RigidBody& moving = bodies[carrier];
  ways_.clear();
  Aabb all;
  for (uint32_t s = 0; s < moving.shapes.size(); ++s)
    all.include(ways_.emplace_back(swept_bounds(moving, carrier, s)));
  for (const Place& place : sorted ? places_from(all.min.x()) : std::span<const Place>(places_)) {
    if (sorted && place.bounds.min.x() > all.max.x()) return;
    if (!all.overlaps(place.bounds) || tracks_[place.slot].carrier != none) continue;
    if (apart_ && apart_->excludes(carrier, place.slot)) continue;
    list_shapes_in_the_way(bodies, carrier, place.slot);
  }
}

void ContinuousStage::list_shapes_in_the_way(std::span<const RigidBody> bodies, uint32_t carrier,
                                             uint32_t slot) {
  const RigidBody& body = bodies[slot];
  for (uint32_t s = 0; s < body.shapes.size(); ++s) {
    if (!(way_along(bodies, {slot, s}, carrier) > unwatched(body, *body.shapes[s].shape))) continue;
    const Aabb own = swept_bounds(body, slot, s);
    for (uint32_t k = 0; k < ways_.size(); ++k) {
      if (!ways_[k].overlaps(own)) continue;
      Candidate& met = in_the_way_.emplace_back();
      met.a = {carrier, k};
      met.b = {slot, s};
    }
  }
}

/// Computes when the listed pairs meet; keeps the first meeting of each body, ascending.
void ContinuousStage::time_in_the_way(std::span<const RigidBody> bodies, double h, Crew& crew,
                                      ContinuousStats& stats) {
  stats.tested += in_the_way_.size();
  for (Candidate& c : in_the_way_) {
    const RigidBody& b = bodies[c.b.body];
    const Motion &ma = tracks_[c.a.body].motion, &mb = tracks_[c.b.body].motion;
    const double size = b.shapes[c.b.shape].shape->bounding_radius();
    c.reach = 2 * size +
              h * (ma.velocity.norm() + mb.velocity.norm() + mb.omega.norm() * b.bounding_radius);
  }
  crew.each(in_the_way_.size(), [&](size_t i) { time_candidate(bodies, h, in_the_way_[i]); });
  std::erase_if(in_the_way_, [h](const Candidate& c) { return !(c.stop.time <= h); });
  std::ranges::sort(in_the_way_, {}, [](const Candidate& c) {
    return std::tuple(c.b.body, c.stop.time, c.a.body, c.a.shape, c.b.shape);
  });
  const auto same = [](const Candidate& c, const Candidate& d) { return c.b.body == d.b.body; };
  in_the_way_.erase(std::unique(in_the_way_.begin(), in_the_way_.end(), same), in_the_way_.end());
}

/// From where the two meet, the body moves as if it were part of the carrier.
void ContinuousStage::carry(std::span<RigidBody> bodies, const Candidate& met, double h) {
  const uint32_t slot = met.b.body;
  RigidBody& body = bodies[slot];
  const Track& with = tracks_[met.a.body];
  Track& track = tracks_[slot];
  if (body.asleep) {
    wake(body);
    woken_.push_back(slot);
    starts_[slot] = {body.pose, body.v};
  }
  const Pose at = track.motion.carrier(std::min(met.stop.time, track.stop));
  put_at(body, with.motion.carrier(h) * (with.motion.carrier(met.stop.time).inverse() * at));
  if (met.thin && met.stop.deepens)
    stop_approach(bodies[met.a.body], body, met.stop.at, met.stop.normal);
  // What it sweeps over itself is found along a straight path, on which it is never behind the
  // carrier.
  track.motion = Motion::between(starts_[slot].pose, body.pose, 0, h);
  track.stop = h;
  track.fast = true;
  track.carrier = with.carrier == none ? met.a.body : with.carrier;
}

void ContinuousStage::hold_carried(std::span<RigidBody> bodies, double h, Crew& crew,
                                   ContinuousStats& stats) {
  places_.clear();
  for (const uint32_t i : carried_) {
    Place& place = places_.emplace_back(Place{{}, i});
    for (uint32_t s = 0; s < bodies[i].shapes.size(); ++s)
      place.bounds.include(swept_bounds(bodies[i], i, s));
  }
  sort_places();
  in_the_way_.clear();
  for (uint32_t i = 0; i < bodies.size() && !stop_requested(); ++i) {
    if (bodies[i].dynamic()) continue;
    for (uint32_t k = 0; k < bodies[i].shapes.size(); ++k) {
      const Aabb way = swept_bounds(bodies[i], i, k);
      for (const Place& place : places_from(way.min.x())) {
        if (place.bounds.min.x() > way.max.x()) break;
        if (!way.overlaps(place.bounds) || tracks_[place.slot].carrier == i) continue;
        if (apart_ && apart_->excludes(i, place.slot)) continue;
        for (uint32_t s = 0; s < bodies[place.slot].shapes.size(); ++s) {
          Candidate& met = in_the_way_.emplace_back();
          met.a = {i, k};
          met.b = {place.slot, s};
        }
      }
    }
  }
  time_in_the_way(bodies, h, crew, stats);
  for (const Candidate& met : in_the_way_) {
    RigidBody& body = bodies[met.b.body];
    put_at(body, tracks_[met.b.body].motion.carrier(met.stop.time));
    if (met.thin && met.stop.deepens)
      stop_approach(bodies[met.a.body], body, met.stop.at, met.stop.normal);
  }
}

/// Moves the bodies that kinematic bodies sweep over, then those that these sweep over, and so on:
/// each body is carried once.
void ContinuousStage::carry_along(std::span<RigidBody> bodies, double h, Crew& crew,
                                  ContinuousStats& stats) {
  list_places(bodies);
  bool sorted = false;
  while (!sweeping_.empty() && !stop_requested()) {
    if (!sorted && sweeping_.size() > tolerances::few_carriers) {
      sort_places();
      sorted = true;
    }
    in_the_way_.clear();
    for (const uint32_t i : sweeping_) {
      if (stop_requested()) return;
      find_in_the_way(bodies, i, sorted);
    }
    sweeping_.clear();
    time_in_the_way(bodies, h, crew, stats);
    for (const Candidate& met : in_the_way_) {
      carry(bodies, met, h);
      sweeping_.push_back(met.b.body);
    }
    carried_.insert(carried_.end(), sweeping_.begin(), sweeping_.end());
  }
  stats.carried += carried_.size();
  std::ranges::sort(carried_);
  std::ranges::sort(woken_);
  stale_tracks_.note(bodies.size(), woken_);
  stale_proxies_.note(bodies.size(), woken_);
  if (!carried_.empty()) hold_carried(bodies, h, crew, stats);
}

}  // namespace tumble
