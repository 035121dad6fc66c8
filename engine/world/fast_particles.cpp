#include "engine/world/fast_particles.hpp"

#include "engine/dynamics/event/cause_effects.hpp"
#include "engine/dynamics/event/impulses/energetic_impact.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

constexpr int most_bounces = 3;

bool exchanges(const WorldState& s, size_t system) {
  const ParticleSystem& p = s.particles[system];
  return s.particle_ids.alive(uint32_t(system)) && p.fast && p.collide && p.size() > 0;
}

class FastExchange {
 public:
  FastExchange(WorldState& state, const TickBackup& start)
      : s_(state), h_(state.settings.tick.tick()), start_poses_(start.poses()) {
    finder_.use_threads(s_.crew.get());
    resting_ = 2 * s_.settings.gravity.now().norm() * h_;
    for (uint32_t k = 0; k < s_.particles.size(); ++k) {
      if (!exchanges(s_, k)) continue;
      const ParticleSystem& p = s_.particles[k];
      for (uint32_t i = 0; i < p.size(); ++i) {
        owners_.push_back({k, i});
        from_.push_back(start.particles()[k].x[i]);
        to_.push_back(p.x[i]);
        radius_.push_back(p.radius[i]);
      }
    }
    const std::vector<RigidBody>& bodies = s_.bodies.bodies;
    for (uint32_t b = 0; b < bodies.size(); ++b) {
      if (!s_.bodies.ids.alive(b)) continue;
      for (uint32_t k = 0; k < bodies[b].shapes.size(); ++k) parts_.push_back({b, k});
    }
  }

  Status run() {
    for (int n = 0; n < most_bounces && !from_.empty(); ++n)
      if (Status done = bounce(n == 0, n + 1 == most_bounces); !done) return done;
    return push_out();
  }
  const ContactEffects& effects() const { return effects_; }

 private:
  struct Owner {
    uint32_t system, index;
  };
  struct Part {
    uint32_t body, shape;
  };

  ParticleSystem& system_of(size_t i) { return s_.particles[owners_[i].system]; }
  Vec3& velocity(size_t i) { return system_of(i).v[owners_[i].index]; }
  RigidBody& body_of(uint32_t part) { return s_.bodies.bodies[parts_[part].body]; }

  /// The body's motion over the tick, or its rest at the end of the tick.
  Motion motion_of(const Part& part, bool whole) const {
    const RigidBody& b = s_.bodies.bodies[part.body];
    Motion m = whole ? Motion::between(start_poses_[part.body], b.pose, 0, h_)
                     : Motion::at_rest(b.pose, 0, h_);
    m.offset = b.shapes[part.shape].pose;
    return m;
  }

  /// Moves the particles on from their present positions; those that collide bounce, or on the
  /// `last` pass stay at the contact.
  Status bounce(bool whole_tick, bool last) {
    std::vector<Vec3> v;
    for (size_t i = 0; i < from_.size(); ++i) v.push_back((to_[i] - from_[i]) / h_);
    std::vector<MovingShape> shapes;
    for (const Part& part : parts_)
      shapes.push_back({s_.bodies.bodies[part.body].shapes[part.shape].shape.get(),
                        motion_of(part, whole_tick)});
    std::vector<ParticleShapeMeeting> meetings;
    if (Status found = finder_.meeting_shapes({{from_, radius_}, v, h_}, shapes,
                                              tolerances::meeting_distance, meetings);
        !found)
      return found;
    std::stable_sort(meetings.begin(), meetings.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.particle, a.time) < std::tuple(b.particle, b.time);
    });
    size_t bounced = from_.size();  // the particle that has received its impulse
    for (const ParticleShapeMeeting& m : meetings) {
      if (m.particle == bounced || m.status == TimeOfContactStatus::max_iterations) continue;
      const size_t i = m.particle;
      const Motion motion = motion_of(parts_[m.shape], whole_tick);
      const RigidBody& b = body_of(m.shape);
      // The contact point, carried along to the pose of the body at the end of the tick.
      const Vec3 met = from_[i] + m.time * v[i];
      const Pose carried = b.pose * motion.carrier(m.time).inverse();
      if (!collide(i, m.shape, carried.point(met), carried.direction(-m.normal))) continue;
      bounced = i;
      from_[i] = to_[i] = carried.point(met);
      if (!last) to_[i] += (h_ - m.time) * (velocity(i) - b.velocity_at(from_[i]));
    }
    return {};
  }

  /// Stops particles that are inside a body at the end, and moves them to its surface.
  Status push_out() {
    std::vector<StillShape> shapes;
    for (const Part& part : parts_) {
      const RigidBody& b = s_.bodies.bodies[part.body];
      shapes.push_back({b.shapes[part.shape].shape.get(), b.pose * b.shapes[part.shape].pose});
    }
    std::vector<ParticleShapeContact> touching;
    if (Status found = finder_.touching_shapes({to_, radius_}, shapes, 0, touching); !found)
      return found;
    for (const ParticleShapeContact& c : touching) {
      collide(c.particle, c.shape, to_[c.particle], -c.normal);
      to_[c.particle] += std::min(0.0, c.gap) * c.normal;
    }
    for (size_t i = 0; i < to_.size(); ++i) system_of(i).x[owners_[i].index] = to_[i];
    return {};
  }

  /// One impulse between particle i at x and a body with outward normal `n` (unit); returns false
  /// if they do not approach.
  bool collide(size_t i, uint32_t part, const Vec3& x, const Vec3& n) {
    const ParticleSystem& system = system_of(i);
    const double mass = system.mass[owners_[i].index];
    RigidBody& b = body_of(part);
    const Material& of_body = b.shapes[parts_[part].shape].material;
    Material of_particle;
    of_particle.friction = system.friction;
    of_particle.restitution = system.restitution;
    const CombinedMaterial material = combine(of_body, of_particle);
    Vec3 belt = b.pose.direction(of_body.surface_velocity);
    belt -= n.dot(belt) * n;
    const Vec3 slip = velocity(i) - b.velocity_at(x) - belt;
    const double speed = -n.dot(slip);
    if (!(speed > tolerances::approaching_speed)) return false;
    const bool gives_way = b.dynamic() && (b.awake() || mass * slip.norm() * b.inverse_mass >
                                                            s_.settings.realtime.sleep_speed);
    if (gives_way && b.asleep) wake(b);
    PointImpact impact;
    Vec3 t1, t2;
    tangent_frame(n, t1, t2);
    const Mat3 frame = Mat3::from_columns(n, t1, t2);
    impact.mobility = frame.transpose() * mobility(b, x, mass, gives_way) * frame;
    impact.velocity = frame.transpose() * slip;
    impact.friction = material.friction;
    impact.restitution = speed > resting_ ? material.restitution : 0;
    const PointImpactResult result = energetic_impact(impact);
    if (result.status != PointImpactStatus::solved) return false;
    if (speed > resting_)
      s_.workspace.fast_collisions.push_back({owners_[i].system, owners_[i].index, x});
    apply(i, b, gives_way, x, n, belt, frame * result.impulse);
    return true;
  }

  static Mat3 mobility(const RigidBody& b, const Vec3& x, double mass, bool gives_way) {
    Mat3 K = Mat3::Identity() / mass;
    if (!gives_way) return K;
    const Mat3 arm = skew(x - b.pose.x);
    return K + Mat3::Identity() * b.inverse_mass - Mat3(arm * b.inverse_inertia_world() * arm);
  }

  void apply(size_t i, RigidBody& b, bool gives_way, const Vec3& x, const Vec3& n, const Vec3& belt,
             const Vec3& impulse) {
    const BodyVelocity before{b.v, b.omega};
    Vec3& v = velocity(i);
    const Vec3 v_before = v;
    v += impulse / system_of(i).mass[owners_[i].index];
    RigidBody particle, wall;
    particle.pose.x = x;
    wall.type = BodyType::fixed;
    wall.pose = b.pose;
    if (gives_way) {
      b.v -= b.inverse_mass * impulse;
      b.omega -= b.inverse_inertia_world() * (x - b.pose.x).cross(impulse);
    }
    add_push(gives_way ? b : wall, {0.5 * (before.v + b.v), 0.5 * (before.omega + b.omega)},
             particle, {0.5 * (v_before + v), Vec3::Zero()}, x, n, impulse, belt, effects_);
  }

  WorldState& s_;
  double h_;
  double resting_;  ///< no restitution below this approach speed [m/s]
  std::vector<Pose> start_poses_;
  ParticleContactFinder finder_;
  std::vector<Owner> owners_;  ///< of the particles below
  std::vector<Vec3> from_, to_;
  std::vector<double> radius_;
  std::vector<Part> parts_;
  ContactEffects effects_;
};

/// Books impulses by their cause; the effect of changed positions is a correction.
void book_exchange(WorldState& s, const LedgerState& before, const ContactEffects& effects) {
  measure(s);
  const LedgerState after = measured(s);
  LedgerEntry rest{0, after.energy - before.energy, after.momentum - before.momentum,
                   after.angular_momentum - before.angular_momentum};
  const auto book = [&](LedgerLine line, ContactCause cause) {
    const CauseEffect& e = effects[size_t(cause)];
    s.ledger.book(line, {e.work, e.lost, e.momentum, e.angular_momentum});
    rest.balance -= e.lost;
    rest.momentum -= e.momentum;
    rest.angular_momentum -= e.angular_momentum;
  };
  book(LedgerLine::restitution, ContactCause::normal);
  book(LedgerLine::friction, ContactCause::friction);
  book(LedgerLine::kinematic, ContactCause::kinematic);
  s.ledger.book(LedgerLine::projection, rest);
}

}  // namespace

Status exchange_fast_impulses(WorldState& s, const TickBackup& start) {
  s.workspace.fast_collisions.clear();
  bool any = false;
  for (size_t k = 0; k < s.particles.size(); ++k) any |= exchanges(s, k);
  if (!any) return {};
  const ScopedStage stage(s.profiler, "fast particles");
  s.roster.forget();  // any body may be hit
  measure(s);
  const LedgerState before = measured(s);
  FastExchange exchange(s, start);
  if (Status done = exchange.run(); !done) return done;
  book_exchange(s, before, exchange.effects());
  return check_finite(s);
}

}  // namespace tumble
