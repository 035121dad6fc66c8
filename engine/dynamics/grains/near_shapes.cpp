#include "engine/dynamics/grains/near_shapes.hpp"

#include "engine/collision/particle_contacts/gather.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/core/chunks.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace tumble {
namespace {

/// Bounds of a shape on its path; a point deviates from the chord of its path by at most lever
/// angle^2 / 8.
Aabb swept_shape_bounds(const Shape& shape, const Pose& from, const Pose& to, double angle,
                        double lever) {
  Aabb all = shape.bounds(from);
  all.include(shape.bounds(to));
  if (angle == 0) return all;
  return all.inflated(lever * std::min(2.0, angle * angle / 8));
}

struct NothingKept {};

}  // namespace

Motion NearShapes::motion(const GrainTick& tick, uint32_t body) const {
  return Motion::between(tick.start_poses[body], tick.bodies.bodies[body].pose, 0, tick.h);
}

void NearShapes::collect(const GrainTick& tick, const GrainField& grains) {
  struct Extent {
    Aabb awake, all;
  };
  std::array<Extent, chunk_count> extents;
  for_chunks(tick.crew, grains.size(), [&](size_t chunk, size_t first, size_t last) {
    Extent& e = extents[chunk];
    for (size_t i = first; i < last; ++i) {
      const double reach = grains.points[i].radius * (2 + tolerances::grain_shape_foresight);
      const Aabb ball = Aabb{grains.points[i].x, grains.points[i].x}.inflated(reach);
      e.all.include(ball);
      if (grains.asleep[i]) continue;
      e.awake.include(ball.inflated(
          tick.h * (grains.movers[i].v.norm() + tick.h * grains.acceleration[i].norm())));
    }
  });
  Aabb awake, all;
  for (const Extent& e : extents) {
    awake.include(e.awake);
    all.include(e.all);
  }
  parts_.clear(), bounds_.clear(), moving_.clear(), moving_bounds_.clear();
  longest_way_ = 0;
  all.include(awake);
  for (uint32_t b = 0; b < tick.bodies.bodies.size(); ++b) {
    const RigidBody& body = tick.bodies.bodies[b];
    if (body.shapes.empty()) continue;
    const bool still = !body.awake();
    if (still && awake.empty()) continue;
    const Motion m = motion(tick, b);
    const double angle = m.omega.norm() * tick.h, along = m.velocity.norm() * tick.h;
    for (uint32_t k = 0; k < body.shapes.size(); ++k) {
      const BodyShape& shape = body.shapes[k];
      const double lever = angle > 0 ? m.lever(shape.shape->bounding_radius()) : 0;
      const Aabb box = swept_shape_bounds(*shape.shape, tick.start_poses[b] * shape.pose,
                                          body.pose * shape.pose, angle, lever);
      const double way = along + angle * lever;
      const bool moves =
          !still && (body.dynamic() || way > tolerances::grain_wakes * tick.h *
                                                 GrainField::rest_speed(tick, grains.least_radius));
      if (!box.overlaps(moves ? all : awake)) continue;
      if (moves && grains.sleepers > 0) {
        moving_.push_back(uint32_t(parts_.size()));
        moving_bounds_.push_back(box);
      }
      parts_.push_back({b, k, way});
      bounds_.push_back(box);
      longest_way_ = std::max(longest_way_, way);
    }
  }
  moving_count_ = moving_.size();
  forget_what_changed(tick);
  tree_ = BoundsTree(bounds_, tick.crew);
  moving_tree_ = BoundsTree(moving_bounds_, tick.crew);
}

void NearShapes::rouse(const GrainTick& tick, GrainField& grains) {
  if (moving_.empty() || grains.sleepers == 0) return;
  std::vector<uint32_t> roused;
  const auto near = [&](size_t i, NothingKept&, std::vector<uint32_t>& out) {
    if (!grains.asleep[i]) return;
    const double r = grains.points[i].radius, reach = r * (1 + tolerances::grain_margin);
    bool meets = false;
    moving_tree_.overlapping(
        Aabb{grains.points[i].x, grains.points[i].x}.inflated(reach), [&](uint32_t m) {
          const Part& part = parts_[moving_[m]];
          const RigidBody& body = tick.bodies.bodies[part.body];
          const BodyShape& shape = body.shapes[part.shape];
          meets = part.way > r ||
                  near_to_touch(*shape.shape, body.pose * shape.pose, grains.points[i].x, reach);
          return !meets;
        });
    if (meets) out.push_back(uint32_t(i));
  };
  gather_found<NothingKept>(tick.crew, grains.size(), roused, near);
  for (const uint32_t i : roused) grains.wake(tick, i);
  grains.sleepers -= roused.size();
}

bool NearShapes::Known::operator==(const Known& other) const {
  return body == other.body && shape == other.shape && of == other.of && pose.x == other.pose.x &&
         pose.q.coeffs() == other.pose.q.coeffs();
}

/// Clearances stay valid as long as the shapes are the same, and are where the last tick left them.
void NearShapes::forget_what_changed(const GrainTick& tick) {
  before_.clear();
  for (const Part& part : parts_) {
    const BodyShape& shape = tick.bodies.bodies[part.body].shapes[part.shape];
    before_.push_back(
        {part.body, part.shape, shape.shape, tick.start_poses[part.body] * shape.pose});
  }
  if (before_ != known_) clear_.clear();
  known_ = before_;
  for (Known& k : known_) {
    const RigidBody& body = tick.bodies.bodies[k.body];
    k.pose = body.pose * body.shapes[k.shape].pose;
  }
  moved_ += longest_way_;
}

std::vector<NearShapes::Placed> NearShapes::place(const GrainTick& tick, double t0,
                                                  double t1) const {
  std::vector<Placed> placed(parts_.size());
  for (size_t k = 0; k < parts_.size(); ++k) {
    const Motion m = motion(tick, parts_[k].body);
    const Pose start = m.carrier(t0);
    placed[k] = {start * tick.bodies.bodies[parts_[k].body].shapes[parts_[k].shape].pose, start,
                 m.carrier(t1) * start.inverse()};
  }
  return placed;
}

template <class Margin>
void NearShapes::find(const GrainTick& tick, std::span<const Placed> placed,
                      const GrainField& grains, size_t i, double h, const Margin& margin,
                      Memory& memory, std::vector<Touch>& found) const {
  const double r = grains.points[i].radius;
  const Vec3& x = grains.points[i].x;
  memory.near.clear();
  tree_.overlapping(Aabb{x, x}.inflated(r + margin(longest_way_)), [&](uint32_t k) {
    memory.near.push_back(k);
    return true;
  });
  std::ranges::sort(memory.near);
  for (const uint32_t k : memory.near) {
    const Part& part = parts_[k];
    const BodyShape& shape = tick.bodies.bodies[part.body].shapes[part.shape];
    const auto near = near_to_touch(*shape.shape, placed[k].pose, x, r + margin(part.way));
    if (!near) continue;
    Touch t{uint32_t(i),      k, near->distance - r, -near->normal, near->x_world, Vec3::Zero(),
            placed[k].start.x};
    if (part.way > 0) t.drift = (placed[k].carried.point(t.x) - t.x) / h;
    found.push_back(t);
  }
}

double NearShapes::clearance(const GrainTick& tick, std::span<const Placed> placed, const Vec3& x,
                             double most) const {
  double least = most;
  tree_.overlapping(Aabb{x, x}.inflated(most), [&](uint32_t k) {
    const BodyShape& shape = tick.bodies.bodies[parts_[k].body].shapes[parts_[k].shape];
    if (const auto near = near_to_touch(*shape.shape, placed[k].pose, x, least))
      least = std::min(least, near->distance);
    return true;
  });
  return least;
}

void NearShapes::touch(const GrainTick& tick, const GrainField& grains, double t0, double t1,
                       std::vector<Touch>& out) {
  const double h = t1 - t0;
  const std::vector<Placed> placed = place(tick, t0, t1);
  clear_.resize(grains.size());
  const auto find_near = [&](size_t i, Memory& memory, std::vector<Touch>& found) {
    if (grains.asleep[i]) return;
    const double r = grains.points[i].radius;
    const Vec3& x = grains.points[i].x;
    const double speed = grains.movers[i].v.norm() + h * grains.acceleration[i].norm();
    const auto margin = [&](double way) {
      return r * tolerances::grain_margin +
             std::min(r * tolerances::grain_shape_foresight, h * (speed + way / tick.h));
    };
    const double reach = r + margin(longest_way_);
    Clearance& clear = clear_[grains.ordinal[i]];
    const double gone = (x - clear.x).norm() + (moved_ - clear.moved);
    if (clear.key == grains.key[i] && gone + reach < clear.distance) return;
    const size_t before = found.size();
    find(tick, placed, grains, i, h, margin, memory, found);
    // Near shapes the clearance would be useless: the grain will search again anyway.
    const bool any = found.size() > before;
    clear = {grains.key[i], x, moved_ - longest_way_,
             any ? 0 : clearance(tick, placed, x, tolerances::grain_clearance * r)};
  };
  gather_found<Memory>(tick.crew, parts_.empty() ? 0 : grains.size(), out, find_near);
}

Result<size_t> NearShapes::hold_back(const GrainTick& tick, GrainField& grains,
                                     std::span<const Vec3> from, double t0, double t1) {
  if (parts_.empty()) return size_t{0};
  const double h = t1 - t0;
  std::vector<uint32_t>& who = far_.who;
  std::vector<Vec3>&start = far_.start, &v = far_.v;
  std::vector<double>& core = far_.core;
  std::vector<ParticleShapeMeeting>& met = far_.met;
  const auto went_far = [&](size_t i, NothingKept&, std::vector<uint32_t>& out) {
    const double way = (grains.points[i].x - from[i]).norm();
    const double far = tolerances::grain_looks * grains.points[i].radius;
    if (!grains.asleep[i] && way + longest_way_ * (h / tick.h) > far) out.push_back(uint32_t(i));
  };
  gather_found<NothingKept>(tick.crew, grains.size(), who, went_far);
  if (who.empty()) return size_t{0};
  start.resize(who.size());
  v.resize(who.size());
  core.resize(who.size());
  for_chunks(tick.crew, who.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = who[k];
      const GrainPoint& at = grains.points[i];
      start[k] = from[i];
      v[k] = (at.x - from[i]) / h;
      core[k] = tolerances::grain_core * at.radius;
    }
  });
  std::vector<MovingShape> shapes;
  for (const Part& part : parts_) {
    const BodyShape& shape = tick.bodies.bodies[part.body].shapes[part.shape];
    const Motion whole = motion(tick, part.body);
    Motion m = Motion::between(whole.carrier(t0), whole.carrier(t1), 0, h);
    m.offset = shape.pose;
    shapes.push_back({shape.shape.get(), m});
  }
  finder_.use_threads(tick.crew);
  if (Status found = finder_.meeting_shapes({{start, core}, v, h}, shapes,
                                            tolerances::grain_met * grains.least_radius, met);
      !found)
    return found.error();
  std::erase_if(met, [](const ParticleShapeMeeting& m) {
    return m.status == TimeOfContactStatus::initially_overlapping;
  });
  std::ranges::stable_sort(met, [](const auto& a, const auto& b) {
    return std::tuple(a.particle, a.time) < std::tuple(b.particle, b.time);
  });
  size_t held = 0;
  for (size_t k = 0; k < met.size(); ++k) {
    if (k > 0 && met[k].particle == met[k - 1].particle) continue;
    const Motion& m = shapes[met[k].shape].motion;
    const size_t i = met[k].particle;
    const Vec3 there = start[i] + met[k].time * v[i];
    grains.points[who[i]].x = (m.carrier(h) * m.carrier(met[k].time).inverse()).point(there);
    ++held;
  }
  return held;
}

}  // namespace tumble
