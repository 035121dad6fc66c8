#include "engine/collision/bounds_tree.hpp"
#include "engine/collision/particle_contacts/checks.hpp"
#include "engine/collision/particle_contacts/gather.hpp"
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/collision/shapes/validation.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A ball as a shape, reused for the next particle of the same radius.
class BallShape {
 public:
  const Shape& of(double radius) {
    const ShapeDef def = ball_def(std::max(radius, min_shape_size));
    if (!shape_ || shape_->def().radius != def.radius) shape_ = *make_shape(def);
    return *shape_;
  }

 private:
  std::shared_ptr<const Shape> shape_;
};

/// Bounds of a shape over its motion: a point deviates from the chord of its path by at most lever
/// angle^2 / 8, for rotations of less than half a turn.
Aabb swept_bounds(const MovingShape& s) {
  const Motion& m = s.motion;
  Aabb all = s.shape->bounds(m.pose(m.t0));
  all.include(s.shape->bounds(m.pose(m.t1)));
  const double angle = m.omega.norm() * (m.t1 - m.t0);
  if (angle == 0) return all;
  const double lever = m.lever(s.shape->bounding_radius());
  if (angle < 3) return all.inflated(lever * angle * angle / 8);
  Aabb carrier{m.start.x, m.start.x};
  carrier.include(m.carrier(m.t1).x);
  return carrier.inflated(lever);
}

std::vector<uint32_t>& sorted(std::vector<uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  return ids;
}

struct TouchMemory {
  std::vector<uint32_t> near;
};
struct MeetMemory {
  std::vector<uint32_t> near;
  BallShape ball;
};

}  // namespace

Status ParticleContactFinder::touching_shapes(const ParticleBalls& balls,
                                              std::span<const StillShape> shapes, double margin,
                                              std::vector<ParticleShapeContact>& out) {
  if (Status s = check_balls(balls); !s) return s;
  if (Status s = check_length("margin", margin, true); !s) return s;
  std::vector<Aabb> bounds;
  for (const StillShape& s : shapes) bounds.push_back(s.shape->bounds(s.pose));
  const BoundsTree tree(bounds, crew_);
  const auto touch = [&](size_t i, TouchMemory& memory, std::vector<ParticleShapeContact>& found) {
    const Vec3& x = balls.x[i];
    const double reach = balls.radius[i] + margin;
    memory.near.clear();
    const Aabb box = Aabb{x, x}.inflated(reach + 1e-15 * x.cwiseAbs().maxCoeff());
    tree.overlapping(box, [&](uint32_t k) {
      memory.near.push_back(k);
      return true;
    });
    for (const uint32_t k : sorted(memory.near)) {
      const auto near = near_to_touch(*shapes[k].shape, shapes[k].pose, x, reach);
      if (!near) continue;
      found.push_back({uint32_t(i), k, near->distance - balls.radius[i], near->x_world,
                       -near->normal, near->triangle});
    }
  };
  gather_found<TouchMemory>(crew_, balls.x.size(), out, touch);
  return {};
}

Status ParticleContactFinder::meeting_shapes(const ParticlePaths& paths,
                                             std::span<const MovingShape> shapes, double tolerance,
                                             std::vector<ParticleShapeMeeting>& out) {
  if (Status s = check_paths(paths); !s) return s;
  if (Status s = check_length("tolerance", tolerance, false); !s) return s;
  std::vector<Aabb> bounds;
  for (const MovingShape& s : shapes) bounds.push_back(swept_bounds(s));
  const BoundsTree tree(bounds, crew_);
  for (size_t i = 0; i < paths.v.size(); ++i)
    if (Status size = require_not_negative("radius", paths.start.radius[i]); !size) {
      Error e = size.error();
      e.place = fmt::format("particle {}", i);
      return e;
    }
  const auto meet = [&](size_t i, MeetMemory& memory, std::vector<ParticleShapeMeeting>& found) {
    const Ray way{paths.start.x[i], paths.h * paths.v[i]};
    const double radius = paths.start.radius[i];
    memory.near.clear();
    tree.along(way, Vec3::Constant(radius + tolerance), 1, [&](uint32_t k) {
      memory.near.push_back(k);
      return 1.0;
    });
    if (memory.near.empty()) return;
    Motion motion;
    motion.start.x = way.origin;
    motion.velocity = paths.v[i];
    motion.t1 = paths.h;
    for (const uint32_t k : sorted(memory.near)) {
      const MovingShape& s = shapes[k];
      const TimeOfContact toc =
          time_of_contact(memory.ball.of(radius), motion, *s.shape, s.motion, tolerance);
      if (toc.status == TimeOfContactStatus::separated) continue;
      if (toc.status == TimeOfContactStatus::invalid) continue;
      const bool from_start = toc.status == TimeOfContactStatus::initially_overlapping;
      found.push_back({uint32_t(i), k, from_start ? 0 : toc.time, toc.on_b, toc.normal,
                       toc.triangle_b, toc.status});
    }
  };
  gather_found<MeetMemory>(crew_, paths.v.size(), out, meet);
  return {};
}

}  // namespace tumble
