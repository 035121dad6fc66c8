#include "engine/dynamics/grains/grain_bodies.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/grains/tolerances.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

void GrainBodies::carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h) {
  carried_.clear();
  for (const GrainLoad& load : touches.loads()) {
    if (load.slot >= bodies.bodies.size()) continue;
    RigidBody& body = bodies.bodies[load.slot];
    if (!body.dynamic() || !body.awake()) continue;
    const double weight = std::abs(body.gravity_scale) * body.mass * gravity.norm() * h;
    const double size = load.impulse.norm(), share = size > weight ? weight / size : 1;
    carried_.push_back({load.slot, share * load.impulse, share * load.moment});
    body.force += carried_.back().impulse / h;
    body.torque += carried_.back().moment / h;
  }
}

void GrainBodies::take_back(const GrainTick& tick, GrainReport& report) const {
  for (const GrainLoad& load : carried_) {
    RigidBody& body = tick.bodies.bodies[load.slot];
    report.bodies.push_back({uint32_t(load.slot), body.v, body.omega});
    body.v -= body.inverse_mass * load.impulse;
    body.omega -= body.inverse_inertia_world() * load.moment;
  }
}

void GrainBodies::begin_tick(const GrainTick& tick) {
  bodies_.clear();
  walls_.clear();
  held_.clear();
  index_.assign(tick.bodies.bodies.size(), ~uint32_t{0});
}

uint32_t GrainBodies::body_of(const GrainTick& tick, uint32_t slot) {
  if (index_[slot] != ~uint32_t{0}) return index_[slot];
  const RigidBody& body = tick.bodies.bodies[slot];
  GrainBody b;
  b.slot = slot;
  b.x = body.pose.x;
  if (body.awake()) {
    b.v = body.v;
    b.omega = body.omega;
  }
  b.gives_way = body.dynamic() && body.awake();
  if (b.gives_way) {
    b.inverse_mass = body.inverse_mass;
    b.inverse_inertia = body.inverse_inertia_world();
  }
  index_[slot] = uint32_t(bodies_.size());
  bodies_.push_back(b);
  return index_[slot];
}

uint32_t GrainBodies::touched_body(const GrainTick& tick, const GrainField& grains,
                                   const NearShapes::Part& part, const NearShapes::Touch& t,
                                   GrainReport& report) {
  RigidBody& body = tick.bodies.bodies[part.body];
  const GrainMover& grain = grains.movers[t.grain];
  // Wakes a body that the grain would move faster than bodies sleep.
  if (body.dynamic() && body.asleep && t.gap <= 0 &&
      t.n.dot(grain.v) * body.inverse_mass > tick.settings.sleep_speed * grain.inverse_mass) {
    wake(body);
    report.woke_bodies = true;
    index_[part.body] = ~uint32_t{0};
  }
  return body_of(tick, part.body);
}

GrainBodyRow GrainBodies::row(const GrainTick& tick, const GrainField& grains,
                              const NearShapes& shapes, const NearShapes::Touch& t,
                              uint32_t of) const {
  const NearShapes::Part& part = shapes.parts()[t.part];
  const RigidBody& body = tick.bodies.bodies[part.body];
  const Material& material = body.shapes[part.shape].material;
  const GrainMover& grain = grains.movers[t.grain];
  const ParticleSystem& p = tick.systems[grains.owner[t.grain].system];
  GrainBodyRow row;
  row.a = t.grain;
  row.b = of;
  const GrainBody& b = bodies_[row.b];
  row.key = shape_key(part.body, part.shape);
  row.n = t.n;
  row.from = grains.points[t.grain].x;
  row.gap = row.gap_from = t.gap;
  row.drift = t.n.dot(t.drift);
  const double r = grains.points[t.grain].radius;
  row.arm_a = r + 0.5 * std::min(0.0, t.gap);
  row.arm = row.from + row.arm_a * t.n - t.centre;
  Vec3 belt = body.pose.direction(material.surface_velocity);
  row.belt = belt - t.n.dot(belt) * t.n;
  double along = 0, across = 0, turning = 0;
  if (b.gives_way) {
    const Vec3 moment = row.arm.cross(t.n);
    along = b.inverse_mass + moment.dot(b.inverse_inertia * moment);
    // Upper bound of the tangential compliance: the trace of the rest.
    const Mat3 lever = skew(row.arm);
    const double trace = 3 * b.inverse_mass - (lever * b.inverse_inertia * lever).trace();
    across = trace - along;
    turning = b.inverse_inertia.trace();
  }
  row.normal_mass = 1 / (grain.inverse_mass + along);
  row.slip_mass = 1 / (grain.inverse_mass + grain.inverse_moment * r * r + across);
  row.friction = std::sqrt(p.friction * material.friction);
  row.rolling = r * p.grains->rolling_friction;
  row.twisting = r * p.grains->torsional_friction;
  if (row.rolling > 0 || row.twisting > 0) row.turn_mass = 1 / (grain.inverse_moment + turning);
  row.restitution = std::max(p.restitution, material.restitution);
  row.approach = t.n.dot(b.v + b.omega.cross(row.arm) - grain.v);
  row.slop = tolerances::grain_slop * r;
  if (b.gives_way) row.lift = tolerances::grain_lift;
  return row;
}

void GrainBodies::make_rows(const GrainTick& tick, const GrainField& grains,
                            const NearShapes& shapes, std::span<const NearShapes::Touch> touching,
                            GrainReport& report) {
  // One after the other: a grain may wake the body of those after it.
  places_.resize(touching.size());
  uint32_t walls = 0, held = 0;
  for (size_t k = 0; k < touching.size(); ++k) {
    const NearShapes::Touch& t = touching[k];
    const uint32_t body = touched_body(tick, grains, shapes.parts()[t.part], t, report);
    places_[k] = {body, bodies_[body].gives_way ? held++ : walls++};
  }
  walls_.resize(walls);
  held_.resize(held);
  for_chunks(tick.crew, touching.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const auto [body, index] = places_[k];
      std::vector<GrainBodyRow>& rows = bodies_[body].gives_way ? held_ : walls_;
      rows[index] = row(tick, grains, shapes, touching[k], body);
    }
  });
}

void GrainBodies::give(const GrainTick& tick, GrainTouches& touches, GrainReport& report) const {
  touches.loads().clear();
  for (const GrainBody& b : bodies_) {
    if (!b.gives_way) continue;
    RigidBody& body = tick.bodies.bodies[b.slot];
    if (std::ranges::find(report.bodies, b.slot, &GrainReport::Pushed::slot) == report.bodies.end())
      report.bodies.push_back({b.slot, body.v, body.omega});
    touches.loads().push_back(
        {b.slot, body.mass * (b.v - body.v), body.inertia_world() * (b.omega - body.omega)});
    body.v = b.v;
    body.omega = b.omega;
  }
  std::ranges::sort(touches.loads(), {}, &GrainLoad::slot);
  std::ranges::sort(report.bodies, {}, &GrainReport::Pushed::slot);
}

/// Sums of each chunk of rows, added up in the order of the chunks.
template <class Add>
void GrainBodies::sum_rows(Crew* crew, std::span<const GrainBodyRow> rows, GrainReport& report,
                           const Add& add) {
  std::array<GrainReport, chunk_count> sums;
  for_chunks(crew, rows.size(), [&](size_t chunk, size_t first, size_t last) {
    for (const GrainBodyRow& row : rows.subspan(first, last - first)) add(row, sums[chunk]);
  });
  for (const GrainReport& sum : sums) report.add_effects(sum);
}

void GrainBodies::count(Crew* crew, GrainReport& report) const {
  const auto add = [](const GrainBodyRow& row, GrainReport& sum) {
    sum.restitution.work += row.lost;
    sum.friction.work += row.rubbed;
    sum.deepest = std::max(sum.deepest, -row.gap);
  };
  sum_rows(crew, held_, report, [&](const GrainBodyRow& row, GrainReport& sum) {
    add(row, sum);
    sum.kinematic.work += row.rubbing.dot(row.belt);
  });
  sum_rows(crew, walls_, report, [&](const GrainBodyRow& row, GrainReport& sum) {
    add(row, sum);
    const GrainBody& b = bodies_[row.b];
    const Vec3 at = row.from + row.arm_a * row.n;
    sum.restitution.momentum += row.given;
    sum.restitution.angular_momentum += at.cross(row.given);
    sum.friction.momentum += row.rubbing;
    sum.friction.angular_momentum += at.cross(row.rubbing) + row.turning;
    const Vec3 v = b.v + b.omega.cross(row.arm) + row.belt;
    sum.kinematic.work += (row.given + row.rubbing).dot(v) + row.turning.dot(b.omega);
  });
}

}  // namespace tumble
