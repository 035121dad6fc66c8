#include "engine/world/fluids.hpp"

#include "engine/dynamics/islands/waking.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/math/det/det.hpp"
#include "engine/world/tick_watch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Pushes that would give a sleeping body this share of the speed that it falls to in a tick wake
/// it [-].
constexpr double waking_push = 0.1;

class FluidStage {
 public:
  explicit FluidStage(World::State& s)
      : s_(s), work_(s.workspace.fluids), h_(s.settings.tick.tick()) {}

  Status run() {
    find_pressed();
    work_.on_bodies.clear();
    work_.solvers.resize(s_.particles.size());
    work_.reports.assign(s_.particles.size(), {});
    s_.workspace.books.shares.resize(s_.forces.size() + 1);
    share().clear();
    for (uint32_t k = 0; k < s_.particles.size(); ++k)
      if (is_live_fluid(s_, k))
        if (Status moved = move(k); !moved) return moved;
    push_bodies();
    return {};
  }

 private:
  ForceShare& share() { return s_.workspace.books.shares[s_.forces.size()]; }

  /// What contacts hold in place is not predicted to fall.
  void find_pressed() {
    work_.pressed.assign(s_.bodies.bodies.size(), 0);
    s_.contacts.for_each([this](const Contact& c) {
      if (c.pressed()) work_.pressed[c.key.body_a] = work_.pressed[c.key.body_b] = 1;
    });
  }

  Status move(uint32_t k) {
    ParticleSystem& p = s_.particles[k];
    const Vec3 g = p.gravity_scale * s_.settings.gravity;
    work_.acceleration.resize(p.size());
    for (size_t i = 0; i < p.size(); ++i) work_.acceleration[i] = g + p.force[i] / p.mass[i];
    work_.x = p.x;
    work_.v = p.v;
    find_bodies(p);
    const FluidParticles particles{p.x, p.v, p.pressure, p.mass, work_.acceleration};
    const bool watched = s_.watch && s_.watch->fluid == s_.particle_ids.at(k);
    FluidTrace* trace = watched ? &s_.watch->pressures : nullptr;
    auto done = work_.solvers[k].step(*p.fluid, particles, {h_, work_.bodies, work_.walls, trace},
                                      s_.crew.get());
    if (!done) {
      Error error = done.error();
      error.place = fmt::format("tick {}, fluid '{}'", s_.tick + 1, p.name);
      return error;
    }
    work_.reports[k] = *done;
    p.density.assign(work_.solvers[k].densities().begin(), work_.solvers[k].densities().end());
    for (double& density : p.density) density *= p.fluid->density;
    book(k);
    take_pushes(work_.solvers[k].pushes());
    for (size_t i = 0; i < p.size(); ++i) {
      p.age[i] += h_;
      p.force[i].setZero();
    }
    return {};
  }

  /// Where the fluid may come to in the tick, for a start; it is a few kernels wider than needed.
  Aabb reach_of(const ParticleSystem& p) const {
    Aabb box;
    double fastest = 0, volume = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      box.include(p.x[i]);
      fastest = std::max(fastest, p.v[i].norm() + h_ * work_.acceleration[i].norm());
      volume = std::max(volume, p.mass[i] / p.fluid->density);
    }
    const double kernel = p.fluid->smoothing * det::pow(volume, 1.0 / 3);
    return box.inflated(2 * kernel + 2 * h_ * fastest);
  }

  void find_bodies(const ParticleSystem& p) {
    work_.slots.clear();
    work_.bodies.clear();
    work_.walls.clear();
    const Aabb reach = reach_of(p);
    for (uint32_t slot = 0; slot < s_.bodies.ids.capacity(); ++slot) {
      if (!s_.bodies.ids.alive(slot)) continue;
      const RigidBody& b = s_.bodies.bodies[slot];
      // A half-space reaches without end, and does not turn.
      const double turn = b.omega.isZero(0) ? 0 : b.omega.norm() * b.bounding_radius;
      const double way = 2 * h_ * (b.v.norm() + turn);
      bool near = false;
      for (const BodyShape& shape : b.shapes)
        near = near || shape.shape->bounds(b.pose * shape.pose).inflated(way).overlaps(reach);
      if (near) add_body(slot, b);
    }
  }

  void add_body(uint32_t slot, const RigidBody& b) {
    FluidBody body;
    body.centre = b.pose.x;
    if (b.awake()) {
      body.velocity = b.v;
      body.angular_velocity = b.omega;
    }
    if (b.dynamic() && b.awake()) {
      body.inverse_mass = b.inverse_mass;
      body.inverse_inertia = b.inverse_inertia_world();
      if (!work_.pressed[slot]) {
        body.acceleration = b.gravity_scale * s_.settings.gravity + b.inverse_mass * b.force;
        body.angular_acceleration = body.inverse_inertia * b.torque;
      }
    }
    for (const BodyShape& shape : b.shapes)
      work_.walls.push_back({shape.shape.get(), b.pose * shape.pose, uint32_t(work_.bodies.size()),
                             b.fluid_friction});
    work_.slots.push_back(slot);
    work_.bodies.push_back(body);
  }

  void take_pushes(std::span<const FluidPush> pushes) {
    for (size_t k = 0; k < pushes.size(); ++k)
      if (!pushes[k].impulse.isZero(0) || !pushes[k].angular_impulse.isZero(0))
        work_.on_bodies.push_back(
            {work_.slots[k], pushes[k].impulse / h_, pushes[k].angular_impulse / h_});
  }

  /// The sums of several fluids; what sleeps and is pushed hardly does not feel it.
  void push_bodies() {
    std::ranges::stable_sort(work_.on_bodies, {}, &FluidWorkspace::OnBody::slot);
    const std::vector<FluidWorkspace::OnBody> given = work_.on_bodies;
    size_t kept = 0;
    for (const FluidWorkspace::OnBody& on : given) {
      if (kept > 0 && work_.on_bodies[kept - 1].slot == on.slot) {
        work_.on_bodies[kept - 1].force += on.force;
        work_.on_bodies[kept - 1].torque += on.torque;
      } else {
        work_.on_bodies[kept++] = on;
      }
    }
    work_.on_bodies.resize(kept);
    const double weight = waking_push * s_.settings.gravity.norm();
    for (const FluidWorkspace::OnBody& on : work_.on_bodies) {
      RigidBody& b = s_.bodies.bodies[on.slot];
      if (!b.dynamic()) continue;
      if (b.asleep) {
        if (!(on.force.norm() * b.inverse_mass > weight)) continue;
        s_.roster.forget();
        wake(b);
      }
      share().bodies.push_back({on.slot, on.force, on.torque});
      b.force += on.force;
      b.torque += on.torque;
    }
  }

  /// Impulses of a force that is constant over the tick, and its work along the particle's way.
  LedgerEntry entry(const ParticleSystem& p, size_t i, const Vec3& force) const {
    const Vec3 impulse = h_ * force, way = p.x[i] - work_.x[i];
    return {force.dot(way), 0, impulse, (work_.x[i] + 0.5 * way).cross(impulse)};
  }

  /// Forces do the work that the ways say, which their potentials lose. What velocities gained by
  /// them beyond it is a correction: particles move by the velocities of the ends of sub-steps, and
  /// shifts of positions have no velocity. Pressure has the momentum that is left over.
  void book(uint32_t k) {
    const ParticleSystem& p = s_.particles[k];
    const FluidReport& report = work_.reports[k];
    LedgerEntry all, weight;
    for (size_t i = 0; i < p.size(); ++i) {
      weight.add(entry(p, i, p.mass[i] * p.gravity_scale * s_.settings.gravity));
      all.momentum += p.mass[i] * (p.v[i] - work_.v[i]);
      all.angular_momentum += p.mass[i] * (p.x[i].cross(p.v[i]) - work_.x[i].cross(work_.v[i]));
    }
    s_.ledger.book(LedgerLine::gravity, weight);
    LedgerEntry outer = weight;
    outer.add(book_forces(k));
    LedgerEntry pressure{report.pressure_work, report.pressure_work, all.momentum - outer.momentum,
                         all.angular_momentum - outer.angular_momentum};
    s_.ledger.book(LedgerLine::sph_pressure, pressure);
    const auto energy_only = [](double work) {
      LedgerEntry e;
      e.work = e.balance = work;
      return e;
    };
    s_.ledger.book(LedgerLine::sph_viscosity, energy_only(report.viscous_work));
    s_.ledger.book(LedgerLine::sph_tension, energy_only(report.tension_work));
    s_.ledger.book(LedgerLine::projection, energy_only(report.outer_work - outer.work));
  }

  LedgerEntry book_forces(uint32_t system) {
    const ParticleSystem& p = s_.particles[system];
    LedgerEntry all;
    for (uint32_t slot = 0; slot < s_.forces.size(); ++slot) {
      LedgerEntry sum;
      bool any = false;
      for (const ForceShare::OnParticle& on : s_.workspace.books.shares[slot].particles) {
        if (on.system != system) continue;
        LedgerEntry e = entry(p, on.index, on.force);
        e.balance = (on.force - on.held).dot(p.x[on.index] - work_.x[on.index]);
        sum.add(e);
        any = true;
      }
      if (!any) continue;
      if (std::holds_alternative<MouseSpringDef>(*s_.forces[slot]))
        s_.ledger.book(LedgerLine::user, sum);
      else
        s_.ledger.book_force(slot, sum);
      all.add(sum);
    }
    return all;
  }

  World::State& s_;
  FluidWorkspace& work_;
  const double h_;
};

}  // namespace

bool is_live_fluid(const World::State& s, size_t system) {
  const ParticleSystem& p = s.particles[system];
  return s.particle_ids.alive(uint32_t(system)) && p.fluid && p.size() > 0;
}

Status move_fluids(World::State& s) {
  size_t fluids = 0;
  for (size_t k = 0; k < s.particles.size(); ++k) fluids += is_live_fluid(s, k) ? 1 : 0;
  s.workspace.fluids.on_bodies.clear();
  if (fluids == 0) return {};
  const ScopedStage stage(s.profiler, "fluids");
  if (fluids > 1 && !s.told.two_fluids) {
    s.told.two_fluids = true;
    s.warn("fluids of different particle systems do not see each other (this is said once)");
  }
  return FluidStage(s).run();
}

}  // namespace tumble
