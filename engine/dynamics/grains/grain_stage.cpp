#include "engine/dynamics/grains/grain_stage.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/grains/tolerances.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

bool GrainStage::asked_for(const HandlePool<ParticleSystemTag>& ids,
                           std::span<const ParticleSystem> systems) {
  for (uint32_t k = 0; k < systems.size(); ++k)
    if (ids.alive(k) && systems[k].grains && systems[k].size() > 0) return true;
  return false;
}

/// Bounds on how fast any two grains approach each other.
double GrainStage::closing_speed() const {
  Aabb v;
  for (const GrainMover& m : grains_.movers) v.include(m.v);
  return v.extent().norm();
}

/// Grains have gone since the last tick: those that leaned on them wake.
void GrainStage::wake_lost(const GrainTick& tick, const GrainTouches& touches) {
  if (touches.grains() == grains_.size() || grains_.sleepers == 0) return;
  for (const GrainTouch& t : touches.all()) {
    const size_t a = grains_.find(tick.systems, t.a);
    if (t.on_body()) continue;
    const size_t b = grains_.find(tick.systems, t.b);
    for (const auto& [gone, left] : {std::pair{a, b}, {b, a}}) {
      if (gone < grains_.size() || left == grains_.size() || !grains_.asleep[left]) continue;
      grains_.wake(tick, left);
      --grains_.sleepers;
    }
  }
}

void GrainStage::carry(GrainTouches& touches, BodySet& bodies, const Vec3& gravity, double h) {
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

void GrainStage::take_back(const GrainTick& tick, GrainReport& report) {
  for (const GrainLoad& load : carried_) {
    RigidBody& body = tick.bodies.bodies[load.slot];
    report.bodies.push_back({uint32_t(load.slot), body.v, body.omega});
    body.v -= body.inverse_mass * load.impulse;
    body.omega -= body.inverse_inertia_world() * load.moment;
  }
}

void GrainStage::give_to_bodies(const GrainTick& tick, GrainTouches& touches,
                                GrainReport& report) const {
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

Status GrainStage::step(const GrainTick& tick, GrainTouches& touches, GrainReport& report) {
  report = {};
  take_back(tick, report);
  grains_.gather(tick);
  if (grains_.size() == 0) {
    touches.loads().clear();
    return {};
  }
  for (size_t i = 0; i < grains_.size(); ++i)
    if (!grains_.x[i].allFinite())
      return Error{ErrorCode::numeric, "the state of a particle is not finite", {}, {}};
  wake_lost(tick, touches);
  shapes_.collect(tick, grains_);
  shapes_.rouse(tick, grains_);
  if (grains_.sleepers == grains_.size() && carried_.empty()) {
    age(tick);
    return {};
  }
  report.moved = true;
  bodies_.clear();
  body_index_.assign(tick.bodies.bodies.size(), ~uint32_t{0});
  start_ = grains_.x;
  const double fastest = closing_speed() + tick.gravity.norm() * tick.h;
  const double parts_wanted =
      std::ceil(fastest * tick.h / (tolerances::grain_part * grains_.least_radius));
  const int parts = int(std::clamp(parts_wanted, 1.0, double(tolerances::most_grain_parts)));
  const int substeps = (tick.settings.substeps + parts - 1) / parts;
  for (int k = 0; k < parts && !stop_requested(); ++k)
    if (Status done =
            part(tick, touches, tick.h * k / parts, tick.h * (k + 1) / parts, substeps, report);
        !done)
      return done;
  grains_.give_back(tick);
  age(tick);
  rest(tick, touches, report);
  report.awake = grains_.size() - grains_.sleepers;
  give_to_bodies(tick, touches, report);
  return {};
}

Status GrainStage::part(const GrainTick& tick, GrainTouches& touches, double t0, double t1,
                        int substeps, GrainReport& report) {
  const double h = t1 - t0, hs = h / substeps;
  const double speed = closing_speed() + tick.gravity.norm() * h;
  if (Status found = finder_.find(tick, grains_, h, speed, found_); !found) return found;
  shapes_.touch(tick, grains_, t0, t1, touching_);
  make_pairs(tick);
  make_walls(tick, report);
  remember(tick, touches, hs);
  paint();
  touched_.assign(grains_.size(), 0);
  for (const GrainRow& row : rows_) touched_[row.a] = touched_[row.b] = 1;
  for (const auto* rows : {&walls_, &held_})
    for (const GrainBodyRow& row : *rows) touched_[row.a] = 1;
  from_ = grains_.x;
  solve_grains({grains_.x, grains_.movers, grains_.acceleration, touched_, grains_.radius, bodies_,
                pairs_, colours_, walls_, held_, tick.settings.restitution_threshold},
               substeps, hs, tick.crew);
  auto held = shapes_.hold_back(tick, grains_, from_, t0, t1);
  if (!held) return held.error();
  report.held += *held;
  count(report);
  store(touches, hs);
  for (const uint32_t i : lost_) {
    if (!grains_.asleep[i]) continue;
    grains_.wake(tick, i);
    --grains_.sleepers;
  }
  return {};
}

void GrainStage::make_pairs(const GrainTick& tick) {
  rows_.resize(found_.size());
  for_chunks(tick.crew, found_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      GrainRow& row = rows_[k] = {};
      row.a = found_[k].first;
      row.b = found_[k].second;
      const GrainMover &a = grains_.movers[row.a], &b = grains_.movers[row.b];
      const double ra = grains_.radius[row.a], rb = grains_.radius[row.b];
      const ParticleSystem& pa = tick.systems[grains_.owner[row.a].system];
      const ParticleSystem& pb = tick.systems[grains_.owner[row.b].system];
      const Vec3 way = grains_.x[row.b] - grains_.x[row.a];
      const double distance = way.norm();
      if (distance > 0) row.n = way / distance;
      const double masses = a.inverse_mass + b.inverse_mass;
      const double moments = a.inverse_moment + b.inverse_moment;
      row.gap = distance - (ra + rb);
      row.arm_a = ra + 0.5 * row.gap;
      row.arm_b = rb + 0.5 * row.gap;
      row.normal_mass = 1 / masses;
      row.slip_mass = 1 / (masses + a.inverse_moment * ra * ra + b.inverse_moment * rb * rb);
      const double lever = 2 * ra * rb / (ra + rb);
      const bool same = &pa == &pb;
      const auto mean = [same](double u, double v) { return same ? u : std::sqrt(u * v); };
      row.friction = mean(pa.friction, pb.friction);
      row.rolling = lever * mean(pa.grains->rolling_friction, pb.grains->rolling_friction);
      row.twisting = lever * mean(pa.grains->torsional_friction, pb.grains->torsional_friction);
      if (row.rolling > 0 || row.twisting > 0) row.turn_mass = 1 / moments;
      row.restitution = std::max(pa.restitution, pb.restitution);
      row.approach = row.n.dot(b.v - a.v);
      const double least = std::min(ra, rb);
      row.slop = tolerances::grain_slop * least;
    }
  });
}

uint32_t GrainStage::body_of(const GrainTick& tick, uint32_t slot) {
  if (body_index_[slot] != ~uint32_t{0}) return body_index_[slot];
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
  body_index_[slot] = uint32_t(bodies_.size());
  bodies_.push_back(b);
  return body_index_[slot];
}

GrainBodyRow GrainStage::wall_row(const GrainTick& tick, const NearShapes::Touch& t,
                                  GrainReport& report) {
  const NearShapes::Part& part = shapes_.parts()[t.part];
  RigidBody& body = tick.bodies.bodies[part.body];
  const Material& material = body.shapes[part.shape].material;
  const GrainMover& grain = grains_.movers[t.grain];
  const ParticleSystem& p = tick.systems[grains_.owner[t.grain].system];
  // What a grain would move faster than bodies sleep wakes.
  if (body.dynamic() && body.asleep && t.gap <= 0 &&
      t.n.dot(grain.v) * body.inverse_mass > tick.settings.sleep_speed * grain.inverse_mass) {
    wake(body);
    report.woke_bodies = true;
    body_index_[part.body] = ~uint32_t{0};
  }
  GrainBodyRow row;
  row.a = t.grain;
  row.b = body_of(tick, part.body);
  const GrainBody& b = bodies_[row.b];
  row.key = shape_key(part.body, part.shape);
  row.n = t.n;
  row.from = grains_.x[t.grain];
  row.gap = row.gap_from = t.gap;
  row.drift = t.n.dot(t.drift);
  const double r = grains_.radius[t.grain];
  row.arm_a = r + 0.5 * std::min(0.0, t.gap);
  row.arm = row.from + row.arm_a * t.n - t.centre;
  Vec3 belt = body.pose.direction(material.surface_velocity);
  row.belt = belt - t.n.dot(belt) * t.n;
  double along = 0, across = 0, turning = 0;
  if (b.gives_way) {
    const Vec3 moment = row.arm.cross(t.n);
    along = b.inverse_mass + moment.dot(b.inverse_inertia * moment);
    // No direction is softer than the trace of what is left says.
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

void GrainStage::make_walls(const GrainTick& tick, GrainReport& report) {
  walls_.clear();
  held_.clear();
  for (const NearShapes::Touch& t : touching_) {
    const GrainBodyRow row = wall_row(tick, t, report);
    (bodies_[row.b].gives_way ? held_ : walls_).push_back(row);
  }
}

/// A contact of the last tick that is no row now.
void GrainStage::keep_or_wake(const GrainTick& tick, const GrainTouch& t) {
  const size_t none = grains_.size(), a = grains_.find(tick.systems, t.a);
  if (t.on_body()) {
    if (a == none || !grains_.asleep[a]) return;
    const bool there =
        t.body() < tick.bodies.bodies.size() && !tick.bodies.bodies[t.body()].shapes.empty();
    if (there)
      kept_.push_back(t);
    else
      lost_.push_back(uint32_t(a));
    return;
  }
  const size_t b = grains_.find(tick.systems, t.b);
  const bool sleeps_a = a != none && grains_.asleep[a], sleeps_b = b != none && grains_.asleep[b];
  if (sleeps_a && sleeps_b) return kept_.push_back(t);
  if (sleeps_a) lost_.push_back(uint32_t(a));
  if (sleeps_b) lost_.push_back(uint32_t(b));
}

/// Rows begin with the forces of the last tick.
void GrainStage::remember(const GrainTick& tick, const GrainTouches& touches, double hs) {
  kept_.clear();
  lost_.clear();
  size_t pair = 0, wall = 0, held = 0;
  const auto take = [hs](GrainRow& row, const GrainTouch& t) {
    row.push = t.push * hs;
    row.rub = t.rub * hs;
    if (row.turn_mass > 0) row.turn = t.turn * hs;
  };
  const auto seek = [](auto& rows, size_t& at, const auto& before) {
    while (at < rows.size() && before(rows[at])) ++at;
  };
  for (const GrainTouch& t : touches.all()) {
    if (!t.on_body()) {
      seek(rows_, pair, [&](const GrainRow& r) {
        const uint64_t a = grains_.key[r.a];
        return a != t.a ? a < t.a : grains_.key[r.b] < t.b;
      });
      if (pair < rows_.size() && grains_.key[rows_[pair].a] == t.a &&
          grains_.key[rows_[pair].b] == t.b)
        take(rows_[pair], t);
      else
        keep_or_wake(tick, t);
      continue;
    }
    const auto before = [&](const GrainBodyRow& r) {
      const uint64_t a = grains_.key[r.a];
      return a != t.a ? a < t.a : r.key < t.b;
    };
    const auto same = [&](const GrainBodyRow& r) {
      return grains_.key[r.a] == t.a && r.key == t.b;
    };
    seek(walls_, wall, before);
    seek(held_, held, before);
    if (wall < walls_.size() && same(walls_[wall]))
      take(walls_[wall], t);
    else if (held < held_.size() && same(held_[held]))
      take(held_[held], t);
    else
      keep_or_wake(tick, t);
  }
}

void GrainStage::paint() {
  colour_pairs(rows_, grains_.movers, order_, colours_, order_scratch_, used_);
  pairs_.resize(rows_.size());
  for (size_t k = 0; k < order_.size(); ++k) pairs_[k] = rows_[order_[k]];
}

/// The contacts that press, in the order of their keys.
void GrainStage::store(GrainTouches& touches, double hs) {
  for (size_t k = 0; k < order_.size(); ++k) rows_[order_[k]] = pairs_[k];
  next_.clear();
  const auto touch = [&](const GrainRow& r, uint64_t b) {
    return GrainTouch{grains_.key[r.a], b, r.push / hs, r.rub / hs, r.turn / hs};
  };
  size_t pair = 0, wall = 0, held = 0, kept = 0;
  const auto pressing = [](auto& rows, size_t& at) {
    while (at < rows.size() && !(rows[at].push > 0)) ++at;
    return at < rows.size();
  };
  for (;;) {
    GrainTouch least{~uint64_t{0}, ~uint64_t{0}, 0, Vec3::Zero(), Vec3::Zero()};
    size_t* from = nullptr;
    const auto offer = [&](const GrainTouch& t, size_t& at) {
      if (!t.before(least)) return;
      least = t;
      from = &at;
    };
    if (pressing(rows_, pair)) offer(touch(rows_[pair], grains_.key[rows_[pair].b]), pair);
    if (pressing(walls_, wall)) offer(touch(walls_[wall], walls_[wall].key), wall);
    if (pressing(held_, held)) offer(touch(held_[held], held_[held].key), held);
    if (kept < kept_.size()) offer(kept_[kept], kept);
    if (!from) break;
    next_.push_back(least);
    ++*from;
  }
  touches.replace(next_, grains_.size());
}

void GrainStage::count(GrainReport& report) const {
  report.contacts = rows_.size() + walls_.size() + held_.size();
  const auto add = [&report](const GrainRow& row) {
    report.restitution.work += row.lost;
    report.friction.work += row.rubbed;
    report.deepest = std::max(report.deepest, -row.gap);
  };
  for (const GrainRow& row : pairs_) add(row);
  for (const GrainBodyRow& row : held_) {
    add(row);
    report.kinematic.work += row.rubbing.dot(row.belt);
  }
  for (const GrainBodyRow& row : walls_) {
    add(row);
    const GrainBody& b = bodies_[row.b];
    const Vec3 at = row.from + row.arm_a * row.n;
    report.restitution.momentum += row.given;
    report.restitution.angular_momentum += at.cross(row.given);
    report.friction.momentum += row.rubbing;
    report.friction.angular_momentum += at.cross(row.rubbing) + row.turning;
    const Vec3 v = b.v + b.omega.cross(row.arm) + row.belt;
    report.kinematic.work += (row.given + row.rubbing).dot(v) + row.turning.dot(b.omega);
  }
}

/// Grow older; forces have had their say.
void GrainStage::age(const GrainTick& tick) const {
  for_chunks(tick.crew, grains_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      ParticleSystem& p = tick.systems[grains_.owner[i].system];
      p.age[grains_.owner[i].index] += tick.h;
      p.force[grains_.owner[i].index].setZero();
    }
  });
}

/// For how long the awake have been slow.
void GrainStage::watch(const GrainTick& tick) {
  const double share = tick.h / (tick.h + tolerances::grain_watch);
  for_chunks(tick.crew, grains_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (grains_.asleep[i]) continue;
      GrainRest& r = rest_of(tick, i);
      if (r.asleep()) r = {};
      r.drift += share * ((grains_.x[i] - start_[i]) / tick.h - r.drift);
      const double slow = GrainField::rest_speed(tick, grains_.radius[i]);
      const double now =
          grains_.movers[i].v.norm() + grains_.radius[i] * grains_.movers[i].spin.norm();
      const bool rests = r.drift.norm() < slow && now < tolerances::grain_wakes * slow;
      r.time = rests ? r.time + tick.h : 0;
    }
  });
}

/// What has been slow for a while may sleep, unless it touches what has not.
void GrainStage::find_held(const GrainTick& tick, const GrainTouches& touches) {
  hold_.assign(grains_.size(), Hold::none);
  const auto grasp = [this](size_t i, bool restless) {
    hold_[i] = std::max(hold_[i], restless ? Hold::restless : Hold::firm);
  };
  for (const GrainTouch& t : touches.all()) {
    const size_t a = grains_.find(tick.systems, t.a);
    if (a == grains_.size()) continue;
    if (t.on_body()) {
      const RigidBody& body = tick.bodies.bodies[t.body()];
      grasp(a, body.awake() && (body.dynamic() || !body.v.isZero(0) || !body.omega.isZero(0)));
      continue;
    }
    const size_t b = grains_.find(tick.systems, t.b);
    if (b == grains_.size()) continue;
    const double enough = 0.5 * tick.settings.sleep_time;
    grasp(a, rest_of(tick, b).time < enough);
    grasp(b, rest_of(tick, a).time < enough);
  }
}

void GrainStage::rest(const GrainTick& tick, const GrainTouches& touches, GrainReport& report) {
  watch(tick);
  if (!tick.settings.sleeping) return;
  find_held(tick, touches);
  for (size_t i = 0; i < grains_.size(); ++i) {
    if (grains_.asleep[i] || hold_[i] != Hold::firm) continue;
    GrainRest& r = rest_of(tick, i);
    if (r.time < tick.settings.sleep_time) continue;
    ParticleSystem& p = tick.systems[grains_.owner[i].system];
    const uint32_t k = grains_.owner[i].index;
    const Vec3 momentum = p.mass[k] * p.v[k], turning = p.moment(k) * p.spin[k];
    report.sleeping.work -= 0.5 * (p.v[k].dot(momentum) + p.spin[k].dot(turning));
    report.sleeping.momentum -= momentum;
    report.sleeping.angular_momentum -= p.x[k].cross(momentum) + turning;
    p.v[k].setZero();
    p.spin[k].setZero();
    r = {Vec3::Zero(), std::numeric_limits<double>::infinity()};
    ++grains_.sleepers;
  }
}

}  // namespace tumble
