#include "engine/dynamics/sph/fluid_solver.hpp"

#include "engine/collision/shape_near.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/sph/fluid_state.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

struct FluidExtremes {
  double speed = 0, acceleration = 0;
  double pressure = 0;  ///< over density [m2/s2]
  Aabb box;
};

size_t fluid_of(const FluidParticles& particles, size_t i) {
  return particles.fluid.empty() ? 0 : particles.fluid[i];
}

FluidExtremes extremes(std::span<const FluidDef* const> defs, const FluidParticles& particles) {
  FluidExtremes e;
  for (size_t i = 0; i < particles.x.size(); ++i) {
    e.speed = std::max(e.speed, particles.v[i].norm());
    e.acceleration = std::max(e.acceleration, particles.acceleration[i].norm());
    e.pressure =
        std::max(e.pressure, particles.pressure[i] / defs[fluid_of(particles, i)]->density);
    e.box.include(particles.x[i]);
  }
  return e;
}

/// Ten times the fastest speed that the fluid has or falls to over its own height, so that
/// densities stay within a hundredth (Monaghan 1994).
double sound_speed_of(const FluidDef& def, const FluidExtremes& e) {
  if (def.sound_speed > 0) return def.sound_speed;
  const double fall = std::sqrt(2 * e.acceleration * e.box.extent().maxCoeff());
  return tolerances::sound_over_flow * std::max(e.speed, fall);
}

class FluidTickRun {
 public:
  FluidTickRun(FluidState& s, const FluidParticles& particles, const FluidTick& tick)
      : s_(s), particles_(particles), tick_(tick) {}

  Status run() {
    double left = tick_.h;
    for (int n = 0; left > 0; ++n) {
      if (stop_requested()) return stopped_error();
      if (n == tolerances::most_sub_steps)
        return Error{ErrorCode::numeric,
                     fmt::format("a tick of {} s needs more than {} sub-steps", tick_.h, n),
                     "fluid", "raise tick_hz, or look for what makes the fluid that fast"};
      const FluidExtremes now = extremes(s_.defs, particles_);
      if (!std::isfinite(now.speed))
        return Error{ErrorCode::numeric, "a particle's speed is not finite", "fluid",
                     "raise tick_hz or most_iterations"};
      const double pieces = std::ceil(left / longest_step(now, left));
      s_.h = pieces > 1 ? left / pieces : left;
      left = pieces > 1 ? left - s_.h : 0;
      way_ = s_.h * (now.speed + s_.h * now.acceleration);
      if (Status stepped = sub_step(left == 0); !stepped) return stepped;
    }
    return {};
  }

 private:
  double longest_step(const FluidExtremes& now, double left) {
    const FluidDef& def = s_.common;
    // A pressure bends as particles move under it: too long steps go to and fro about its walls.
    sound_ =
        def.solver == FluidSolverKind::wcsph ? sound_speed_of(def, now) : std::sqrt(now.pressure);
    // With what gravity adds; bodies stir no faster than they are.
    double speed = now.speed + now.acceleration * std::min(left, tick_.h);
    for (const FluidBodyState& b : s_.bodies) speed = std::max(speed, b.velocity.norm());
    double step = left;
    const double way = def.cfl * s_.spacing, all = speed + sound_;
    if (all * step > way) step = way / all;
    const double cube = s_.spacing * s_.spacing * s_.spacing;
    for (const FluidDef* d : s_.defs)
      if (d->surface_tension > 0)
        step = std::min(
            step, tolerances::capillary_share *
                      std::sqrt(d->density * cube / (2 * std::numbers::pi * d->surface_tension)));
    return step;
  }

  Status sub_step(bool last) {
    FluidState& s = s_;
    const bool implicit = s.common.solver == FluidSolverKind::dfsph;
    // A skin makes lists longer: only where the next sub-step can have them too, and where sums
    // over them are few.
    const double skin = tolerances::list_skin * s.kernel.reach();
    const bool lasts = !implicit && !last && 2 * way_ < skin;
    if (Status found = find_neighbours(s, particles_.x, lasts ? skin : 0); !found) return found;
    if (stop_requested()) return stopped_error();
    take();
    find_surroundings(s);
    if (stop_requested()) return stopped_error();
    if (s.corrects()) find_corrections(s);
    if (s.trace) *s.trace = {s.report.sub_steps + 1, s.h, {}, {}};
    s.each([&](size_t p) { s.acceleration.set(p, particles_.acceleration[s.lists.order()[p]]); });
    s.report.outer_work += s.accelerate();
    for (size_t b = 0; b < s.bodies.size(); ++b) {
      s.bodies[b].velocity += s.h * s.body_defs[b].acceleration;
      s.bodies[b].angular_velocity += s.h * s.body_defs[b].angular_acceleration;
    }
    pull_surfaces(s);
    solve_viscosity(s);
    smooth_velocities(s);
    if (stop_requested()) return stopped_error();
    if (implicit)
      solve_pressure(s);
    else
      press_by_state(s, sound_);
    if (stop_requested()) return stopped_error();
    keep_clear_of_walls(s);
    if (implicit)
      shift_particles(s);
    else
      s.shift.fill_zero(s.lists.places());
    give();
    move_bodies(s);
    ++s.report.sub_steps;
    return {};
  }

  void take() {
    FluidState& s = s_;
    const size_t places = s.lists.places();
    for (FluidVectors* a : {&s.at, &s.v, &s.acceleration, &s.shift, &s.terms}) a->resize(places);
    // The place that fills lists is far from all.
    const size_t last = places - 1;
    for (std::vector<double>* a : {&s.volume, &s.density, &s.pressure, &s.shift_pressure})
      a->resize(places);
    s.volume[last] = s.pressure[last] = s.shift_pressure[last] = 0;
    s.density[last] = 1;
    s.fluid.assign(places, 0);
    s.origin = {s.lists.x()[0], s.lists.y()[0], s.lists.z()[0]};
    s.at.set(last, {s.lists.x()[last], s.lists.y()[last], s.lists.z()[last]});
    s.each([&](size_t p) {
      const uint32_t i = s.lists.order()[p];
      s.v.set(p, particles_.v[i]);
      s.pressure[p] = particles_.pressure[i];
      s.shift_pressure[p] = s.last_shift[i];
      s.fluid[p] = uint8_t(fluid_of(particles_, i));
      s.density[p] = s.def(p).density;
      s.volume[p] = particles_.mass[i] / s.density[p];
      s.at.set(p, {s.lists.x()[p], s.lists.y()[p], s.lists.z()[p]}, s.volume[p]);
    });
  }
  void give() {
    FluidState& s = s_;
    s.each([&](size_t p) {
      const uint32_t i = s.lists.order()[p];
      particles_.v[i] = s.v[p];
      particles_.x[i] += s.h * (s.v[p] + s.shift[p]);
      particles_.pressure[i] = s.pressure[p];
      s.last_shift[i] = s.shift_pressure[p];
    });
  }

  FluidState& s_;
  const FluidParticles& particles_;
  const FluidTick& tick_;
  double way_ = 0;    ///< of the fastest particle in the sub-step, about [m]
  double sound_ = 0;  ///< of what shakes under pressure [m/s]
};

double mean_volume(std::span<const FluidDef* const> defs, const FluidParticles& particles) {
  std::vector<double> masses(defs.size(), 0);
  for (size_t i = 0; i < particles.mass.size(); ++i)
    masses[fluid_of(particles, i)] += particles.mass[i];
  double mean = 0;
  for (size_t k = 0; k < defs.size(); ++k)
    mean += masses[k] / (defs[k]->density * double(particles.mass.size()));
  return mean;
}

FluidDef in_common(std::span<const FluidDef* const> defs) {
  FluidDef all = *defs[0];
  for (const FluidDef* d : defs) {
    all.density_error = std::min(all.density_error, d->density_error);
    all.most_iterations = std::max(all.most_iterations, d->most_iterations);
    all.sound_speed = std::max(all.sound_speed, d->sound_speed);
    all.cfl = std::min(all.cfl, d->cfl);
  }
  return all;
}

}  // namespace

struct FluidSolver::Parts {
  FluidState state;
  std::vector<double> densities;
};

FluidSolver::FluidSolver() : parts_(std::make_unique<Parts>()) {}
FluidSolver::~FluidSolver() = default;
FluidSolver::FluidSolver(FluidSolver&&) noexcept = default;
FluidSolver& FluidSolver::operator=(FluidSolver&&) noexcept = default;

bool can_be_solved_together(const FluidDef& a, const FluidDef& b) {
  return a.solver == b.solver && a.kernel == b.kernel && a.smoothing == b.smoothing;
}

Result<FluidReport> FluidSolver::step(std::span<const FluidDef* const> defs,
                                      const FluidParticles& particles, const FluidTick& tick,
                                      Crew* crew) {
  FluidState& s = parts_->state;
  s.defs = defs;
  s.common = in_common(defs);
  s.crew = crew;
  s.body_defs = tick.bodies;
  s.walls = tick.walls;
  s.trace = tick.trace;
  s.report = {};
  s.last_shift.assign(particles.x.size(), 0);
  s.bodies.clear();
  for (const FluidBody& b : tick.bodies)
    s.bodies.push_back({b.centre, b.velocity, b.angular_velocity, Quat::Identity(), 0});
  s.pushes.assign(tick.bodies.size(), {});
  // Lists are made where the tick begins, so that the tick is a function of the particles alone.
  s.lists.forget();
  if (particles.x.empty()) return s.report;
  s.spacing = det::pow(mean_volume(defs, particles), 1.0 / 3);
  s.kernel = SmoothingKernel(s.common.kernel, s.common.smoothing * s.spacing);
  s.stiffest = stiffest_wave(s.kernel, s.spacing);
  if (Status done = FluidTickRun(s, particles, tick).run(); !done) return done.error();
  parts_->densities.resize(particles.x.size());
  for (size_t p = 0; p < s.size(); ++p) parts_->densities[s.lists.order()[p]] = s.share[p];
  return s.report;
}

std::span<const FluidPush> FluidSolver::pushes() const {
  return parts_->state.pushes;
}
std::span<const double> FluidSolver::densities() const {
  return parts_->densities;
}

std::vector<uint8_t> inside_walls(std::span<const Vec3> points, std::span<const FluidWall> walls,
                                  double clearance) {
  std::vector<Aabb> bounds;
  for (const FluidWall& w : walls) bounds.push_back(w.shape->bounds(w.pose).inflated(clearance));
  std::vector<uint8_t> inside(points.size(), 0);
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t w = 0; w < walls.size() && inside[i] == 0; ++w) {
      if (!bounds[w].contains(points[i])) continue;
      const auto near = near_to_touch(*walls[w].shape, walls[w].pose, points[i], clearance);
      inside[i] = near && near->distance < clearance ? 1 : 0;
    }
  return inside;
}

}  // namespace tumble
