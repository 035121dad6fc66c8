#include "engine/world/fluids.hpp"

#include "engine/dynamics/islands/waking.hpp"
#include "engine/math/det/det.hpp"
#include "engine/world/fluid_sets.hpp"
#include "engine/world/tick_watch.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

class FluidStage {
 public:
  explicit FluidStage(WorldState& s)
      : s_(s), work_(s.workspace.fluids), h_(s.settings.tick.tick()) {}

  Status run(std::span<const std::vector<uint32_t>> sets) {
    find_pressed();
    work_.on_bodies.clear();
    work_.solvers.resize(sets.size());
    s_.workspace.books.shares.resize(s_.forces.size() + 1);
    share().clear();
    for (size_t k = 0; k < sets.size(); ++k)
      if (Status moved = move(sets[k], work_.solvers[k]); !moved) return moved;
    push_bodies();
    return {};
  }

 private:
  ForceShare& share() { return s_.workspace.books.shares[s_.forces.size()]; }

  /// Marks the bodies that contacts hold, whose fall the fluid solver must not predict.
  void find_pressed() {
    work_.pressed.assign(s_.bodies.bodies.size(), 0);
    s_.contacts.for_each([this](const Contact& c) {
      if (c.pressed()) work_.pressed[c.key.body_a] = work_.pressed[c.key.body_b] = 1;
    });
  }

  Status move(std::span<const uint32_t> set, FluidSolver& solver) {
    FluidWorkspace::Together& all = work_.together;
    gather_fluids(s_, set, all);
    find_bodies();
    const FluidParticles particles{all.x,    all.v, all.pressure, all.mass, all.acceleration,
                                   all.fluid};
    const auto done = solver.step(all.defs, particles,
                                  {h_, work_.bodies, work_.walls, trace_of(set)}, s_.crew.get());
    if (!done) {
      Error error = done.error();
      error.place = fmt::format("tick {}, fluid {}", s_.tick + 1, names_of(set));
      return error;
    }
    keep_trace_of(set);
    scatter_fluids(s_, set, solver.densities(), all);
    book(set, *done);
    take_pushes(solver.pushes());
    for (const uint32_t k : set) {
      ParticleSystem& p = s_.particles[k];
      for (size_t i = 0; i < p.size(); ++i) {
        p.age[i] += h_;
        p.force[i].setZero();
      }
    }
    return {};
  }

  std::string names_of(std::span<const uint32_t> set) const {
    std::string names;
    for (const uint32_t k : set)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", s_.particles[k].name);
    return names;
  }

  bool watched(uint32_t k) const { return s_.watch && s_.watch->fluid == s_.particle_ids.at(k); }
  FluidTrace* trace_of(std::span<const uint32_t> set) const {
    const bool any = std::ranges::any_of(set, [this](uint32_t k) { return watched(k); });
    return any ? &s_.watch->pressures : nullptr;
  }
  /// Keeps the part of the trace that belongs to the watched fluid.
  void keep_trace_of(std::span<const uint32_t> set) const {
    for (size_t n = 0; n < set.size(); ++n) {
      if (!watched(set[n])) continue;
      const auto first = ptrdiff_t(work_.together.first[n]);
      const auto last = first + ptrdiff_t(s_.particles[set[n]].size());
      for (FluidTrace::Solve* solve : {&s_.watch->pressures.pressure, &s_.watch->pressures.shift})
        for (FluidTrace::Iteration& now : solve->iterations)
          now.wrong = std::vector<float>(now.wrong.begin() + first, now.wrong.begin() + last);
    }
  }

  /// Bounds of where the fluids may move in the tick, for a first selection; a few kernel radii
  /// wider than needed.
  Aabb reach() const {
    const FluidWorkspace::Together& all = work_.together;
    Aabb box;
    double fastest = 0, volume = 0;
    for (size_t i = 0; i < all.x.size(); ++i) {
      box.include(all.x[i]);
      fastest = std::max(fastest, all.v[i].norm() + h_ * all.acceleration[i].norm());
      volume = std::max(volume, all.mass[i] / all.defs[all.fluid[i]]->density);
    }
    const double kernel = all.defs[0]->smoothing * det::pow(volume, 1.0 / 3);
    return box.inflated(2 * kernel + 2 * h_ * fastest);
  }

  void find_bodies() {
    work_.slots.clear();
    work_.bodies.clear();
    work_.walls.clear();
    const Aabb reach = this->reach();
    for (uint32_t slot = 0; slot < s_.bodies.ids.capacity(); ++slot) {
      if (!s_.bodies.ids.alive(slot)) continue;
      const RigidBody& b = s_.bodies.bodies[slot];
      // A half-space is unbounded, and does not rotate.
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
        body.acceleration = b.gravity_scale * s_.settings.gravity.now() + b.inverse_mass * b.force;
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

  /// Sums the forces of several fluids on a body; a sleeping body that is pushed too little to wake
  /// does not receive them.
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
    const double weight = tolerances::waking_push * s_.settings.gravity.now().norm();
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

  /// Impulse of a force that is constant over the tick, and its work along the particle's
  /// displacement.
  LedgerEntry entry(size_t i, const Vec3& force) const {
    const FluidWorkspace::Together& all = work_.together;
    const Vec3 impulse = h_ * force, way = all.x[i] - all.x_before[i];
    return {force.dot(way), 0, impulse, (all.x_before[i] + 0.5 * way).cross(impulse)};
  }

  /// The work of forces is that along the displacements, which is what their potentials lose. Work
  /// on the velocities beyond this is a correction: particles move by the velocities at the ends of
  /// sub-steps, and position shifts have no velocity. The momentum that is left over belongs to
  /// pressure.
  void book(std::span<const uint32_t> set, const FluidReport& report) {
    const FluidWorkspace::Together& all = work_.together;
    LedgerEntry gained, weight;
    for (size_t n = 0; n < set.size(); ++n) {
      const ParticleSystem& p = s_.particles[set[n]];
      for (size_t k = 0; k < p.size(); ++k) {
        const size_t i = all.first[n] + k;
        weight.add(entry(i, p.mass[k] * p.gravity_scale * s_.settings.gravity.now()));
        gained.momentum += p.mass[k] * (p.v[k] - all.v_before[i]);
        gained.angular_momentum +=
            p.mass[k] * (p.x[k].cross(p.v[k]) - all.x_before[i].cross(all.v_before[i]));
      }
    }
    s_.ledger.book(LedgerLine::gravity, weight);
    LedgerEntry outer = weight;
    for (size_t n = 0; n < set.size(); ++n) outer.add(book_forces(set[n], all.first[n]));
    LedgerEntry pressure{report.pressure_work, report.pressure_work,
                         gained.momentum - outer.momentum,
                         gained.angular_momentum - outer.angular_momentum};
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

  LedgerEntry book_forces(uint32_t system, size_t first) {
    LedgerEntry all;
    for (uint32_t slot = 0; slot < s_.forces.size(); ++slot) {
      LedgerEntry sum;
      bool any = false;
      for (const ForceShare::OnParticle& on : s_.workspace.books.shares[slot].particles) {
        if (on.system != system) continue;
        const size_t i = first + on.index;
        LedgerEntry e = entry(i, on.force);
        e.balance = (on.force - on.held).dot(work_.together.x[i] - work_.together.x_before[i]);
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

  WorldState& s_;
  FluidWorkspace& work_;
  const double h_;
};

}  // namespace

bool is_live_fluid(const WorldState& s, size_t system) {
  const ParticleSystem& p = s.particles[system];
  return s.particle_ids.alive(uint32_t(system)) && p.fluid && p.size() > 0;
}

Status move_fluids(WorldState& s) {
  s.workspace.fluids.on_bodies.clear();
  const std::vector<std::vector<uint32_t>> sets = fluid_sets(s);
  if (sets.empty()) return {};
  const ScopedStage stage(s.profiler, "fluids");
  if (sets.size() > 1 && !s.told.two_fluids) {
    s.told.two_fluids = true;
    s.warn(fmt::format(
        "fluids '{}' and '{}' do not see each other: solver, kernel, smoothing and, but for a "
        "quarter, the spacing of particles have to be the same (this is said once)",
        s.particles[sets[0][0]].name, s.particles[sets[1][0]].name));
  }
  return FluidStage(s).run(sets);
}

}  // namespace tumble
