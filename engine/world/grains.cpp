#include "engine/world/grains.hpp"

#include "engine/core/chunks.hpp"

#include <array>

namespace tumble {
namespace {

/// Energy and momenta of grains and of the bodies that they push.
struct Sums {
  double energy = 0;
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();

  void add(const ParticleSystem& p, size_t i, const Vec3& gravity, double sign) {
    const Vec3 mv = p.mass[i] * p.v[i], turning = p.moment(i) * p.spin[i];
    energy += sign * (0.5 * (p.v[i].dot(mv) + p.spin[i].dot(turning)) -
                      p.gravity_scale * p.mass[i] * gravity.dot(p.x[i]));
    momentum += sign * mv;
    angular_momentum += sign * (p.x[i].cross(mv) + turning);
  }
  void add(const Sums& other) {
    energy += other.energy;
    momentum += other.momentum;
    angular_momentum += other.angular_momentum;
  }
  void add(const RigidBody& b, const Vec3& v, const Vec3& omega, double sign) {
    const Vec3 mv = b.mass * v, turning = b.inertia_world() * omega;
    energy += 0.5 * sign * (v.dot(mv) + omega.dot(turning));
    momentum += sign * mv;
    angular_momentum += sign * (b.pose.x.cross(mv) + turning);
  }
};

bool alive_grains(const WorldState& s, uint32_t k) {
  return s.particle_ids.alive(k) && s.particles[k].grains.has_value();
}

/// Entry of a constant force on a grain along its displacement; none for a sleeping grain.
LedgerEntry push_on(const ParticleSystem& from, const ParticleSystem& to, size_t i,
                    const Vec3& force, double h) {
  if (from.rest[i].asleep() && to.rest[i].asleep()) return {};
  const Vec3 impulse = h * force;
  return {force.dot(to.x[i] - from.x[i]), 0, impulse, (0.5 * (from.x[i] + to.x[i])).cross(impulse)};
}

class GrainBooks {
 public:
  GrainBooks(WorldState& s, const TickBackup& start) : s_(s), start_(start) {}

  void book() {
    grains();
    pushed_bodies();
    carried();
    forces();
    const GrainReport& r = s_.workspace.grain_report;
    line(LedgerLine::restitution, r.restitution);
    line(LedgerLine::friction, r.friction);
    line(LedgerLine::kinematic, r.kinematic);
    line(LedgerLine::sleeping, r.sleeping);
    s_.ledger.book(LedgerLine::projection,
                   {0, rest_.energy, rest_.momentum, rest_.angular_momentum});
  }

 private:
  /// What changed of grains, and what gravity has done. Sums of each chunk are added up in the
  /// order of the chunks.
  void grains() {
    struct Part {
      Sums change;
      LedgerEntry weight;
    };
    const Vec3& gravity = s_.settings.gravity.now();
    LedgerEntry weight;
    for (uint32_t k = 0; k < s_.particles.size(); ++k) {
      if (!alive_grains(s_, k)) continue;
      const ParticleSystem &from = start_.particles()[k], &to = s_.particles[k];
      std::array<Part, chunk_count> parts;
      for_chunks(s_.crew.get(), to.size(), [&](size_t chunk, size_t first, size_t last) {
        Part sum;
        for (size_t i = first; i < last; ++i) {
          sum.change.add(to, i, gravity, 1);
          sum.change.add(from, i, gravity, -1);
          sum.weight.add(push_on(from, to, i, to.mass[i] * to.gravity_scale * gravity, h_));
        }
        parts[chunk] = sum;
      });
      for (const Part& part : parts) {
        rest_.add(part.change);
        weight.add(part.weight);
      }
    }
    s_.ledger.book(LedgerLine::gravity, weight);
    explained(weight, 0);
  }
  void pushed_bodies() {
    for (const GrainReport::Pushed& p : s_.workspace.grain_report.bodies) {
      const RigidBody& b = s_.bodies.bodies[p.slot];
      rest_.add(b, b.v, b.omega, 1);
      rest_.add(b, p.v, p.omega, -1);
    }
  }
  /// Books the support that bodies received before their tick, which was taken back afterwards.
  void carried() {
    LedgerEntry sum;
    for (const GrainLoad& load : s_.workspace.grains.carried()) {
      const Pose &from = start_.pose(uint32_t(load.slot)), &to = s_.bodies.bodies[load.slot].pose;
      const Vec3 turn = Motion::between(from, to, 0, 1).omega;
      const double work = (load.impulse.dot(to.x - from.x) + load.moment.dot(turn)) / h_;
      const Vec3 middle = 0.5 * (from.x + to.x);
      sum.add({0, work, load.impulse, middle.cross(load.impulse) + load.moment});
    }
    s_.ledger.book(LedgerLine::projection, sum);
  }
  void explained(const LedgerEntry& e, double energy) {
    rest_.energy -= energy;
    rest_.momentum -= e.momentum;
    rest_.angular_momentum -= e.angular_momentum;
  }
  void line(LedgerLine name, const GrainEffect& e) {
    const LedgerEntry entry{e.work, e.work, e.momentum, e.angular_momentum};
    s_.ledger.book(name, entry);
    explained(entry, e.work);
  }
  void forces() {
    const std::vector<ForceShare>& shares = s_.workspace.books.shares;
    for (uint32_t slot = 0; slot < shares.size(); ++slot) {
      LedgerEntry sum;
      bool any = false;
      for (const ForceShare::OnParticle& on : shares[slot].particles) {
        if (!alive_grains(s_, on.system)) continue;
        const ParticleSystem &from = start_.particles()[on.system], &to = s_.particles[on.system];
        LedgerEntry e = push_on(from, to, on.index, on.force, h_);
        e.balance = push_on(from, to, on.index, on.force - on.held, h_).work;
        sum.add(e);
        any = true;
      }
      if (!any) continue;
      book_share(s_.ledger, s_.forces[slot], slot, sum);
      explained(sum, sum.work);
    }
  }

  WorldState& s_;
  const TickBackup& start_;
  double h_ = s_.settings.tick.tick();
  Sums rest_;  ///< the change that no line explains yet
};

}  // namespace

void carry_on_grains(WorldState& s) {
  s.workspace.grains.carry(s.grain_touches, s.bodies, s.settings.gravity.now(),
                           s.settings.tick.tick());
}

Status step_grains(WorldState& s, const TickBackup& start) {
  if (!GrainStage::asked_for(s.particle_ids, s.particles) && s.grain_touches.loads().empty())
    return {};
  const ScopedStage stage(s.profiler, "grains");
  const std::vector<Pose> poses = start.poses();
  GrainReport& report = s.workspace.grain_report;
  const GrainTick tick{s.particles,
                       s.particle_ids,
                       s.bodies,
                       poses,
                       s.settings.gravity.now(),
                       s.settings.tick.tick(),
                       s.settings.realtime,
                       s.crew.get()};
  if (Status done = s.workspace.grains.step(tick, s.grain_touches, report); !done) return done;
  // Each has one point; contacts of sleeping grains are counted too.
  s.stats.contacts += s.grain_touches.all().size();
  s.stats.contact_points += s.grain_touches.all().size();
  if (!report.moved) return {};
  if (report.woke_bodies) s.roster.forget();
  GrainBooks(s, start).book();
  return check_finite(s);
}

}  // namespace tumble
