#include "viewer/render/trails.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Samples of a trail: smooth even if it is half of an ellipse.
constexpr double samples_of_one = 240;
/// Total number of lines, for all bodies, that a renderer draws fluently.
constexpr double samples_of_all = 60000;
constexpr double fewest_samples = 8;

constexpr float brightest = 0.85f;  ///< opacity right behind the body
constexpr float line_width = 2;     ///< [px]

uint64_t interval_for(const Frame& frame, double seconds) {
  double bodies = 0;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    bodies += frame.info(slot).type == BodyType::dynamic ? 1 : 0;
  const double samples =
      std::clamp(samples_of_all / std::max(bodies, 1.0), fewest_samples, samples_of_one);
  return uint64_t(std::max(1.0, std::ceil(seconds / frame.rate.tick() / samples)));
}

Vec4f colour_of(const BodyInfo& info, float opacity) {
  const Vec3f& c = info.look.colour;
  return {c.x(), c.y(), c.z(), opacity};
}

}  // namespace

void Trails::start(double seconds) {
  *this = Trails{};
  seconds_ = std::isfinite(seconds) ? std::max(seconds, 0.0) : 0;
}

void Trails::see(const Frame& frame) {
  particles_.see(frame);
  if (!(seconds_ > 0)) return;
  if (interval_ == 0) interval_ = interval_for(frame, seconds_);
  while (!samples_.empty() && samples_.back().tick > frame.tick) samples_.pop_back();
  // After going back, every body counts as jumped, since it moved to its place without a path.
  came_back_ = frame.tick < seen_tick_ || (came_back_ && frame.tick == seen_tick_);
  seen_tick_ = frame.tick;
  for (size_t slot = 0; slot < frame.body_slots() && !came_back_; ++slot)
    if (frame.body(slot).jumped) jumped_.push_back(frame.body(slot).id);
  // The window may skip the tick at which a sample is due.
  if (samples_.empty() || frame.tick / interval_ > samples_.back().tick / interval_) keep(frame);
}

void Trails::keep(const Frame& frame) {
  Sample sample{frame.tick, frame.time, {}};
  sample.places.resize(frame.body_slots());
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyFrame& body = frame.body(slot);
    if (frame.info(slot).type != BodyType::dynamic || !body.pose.x.allFinite()) continue;
    sample.places[slot] = {body.id, body.pose.x};
  }
  for (Sample& old : samples_)
    for (const BodyId id : jumped_)
      if (id.index < old.places.size()) old.places[id.index].id = {};
  jumped_.clear();
  samples_.push_back(std::move(sample));
  // One sample before the reach is kept: the oldest line ends there.
  while (samples_.size() > 2 && samples_[1].time < frame.time - seconds_) samples_.pop_front();
}

void Trails::draw(const Frame& from, const Frame& to, double s, RenderScene& out) const {
  particles_.draw(from, to, s, out);
  if (samples_.empty()) return;
  const double now = from.time + s * (to.time - from.time);
  const auto opacity = [&](double time) {
    return brightest * float(std::clamp(1 - (now - time) / seconds_, 0.0, 1.0));
  };
  for (size_t slot = 0; slot < to.body_slots(); ++slot) {
    const BodyFrame& body = to.body(slot);
    if (body.id.is_null() || !to.info(slot).look.visible) continue;
    const BodyInfo& info = to.info(slot);
    Vec3 next = s >= 1 ? body.pose.x : interpolated_pose(from, to, slot, s).x;
    double next_time = now;
    for (auto it = samples_.rbegin(); it != samples_.rend() && opacity(next_time) > 0; ++it) {
      if (it->time >= now) continue;
      if (slot >= it->places.size() || it->places[slot].id != body.id) break;
      const Vec3& x = it->places[slot].x;
      out.lines.push_back(
          {.a = x.cast<float>(),
           .b = next.cast<float>(),
           .colour = colour_of(info, 0.5f * (opacity(it->time) + opacity(next_time))),
           .width = line_width,
           .occlusion = Occlusion::hidden});
      next = x;
      next_time = it->time;
    }
  }
}

}  // namespace tumble
