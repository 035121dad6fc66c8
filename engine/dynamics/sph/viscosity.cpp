#include "engine/core/stop.hpp"
#include "engine/dynamics/sph/fluid_state.hpp"

#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Viscous forces: viscosity times the Laplacian of velocity (Morris, Fox and Zhu, "Modeling low
/// Reynolds number incompressible flows using SPH", 1997), which keeps the momentum; a free surface
/// slows what spins. Between two fluids it is the harmonic mean of theirs, so that the shear stress
/// is the same on both sides (Cleary, "Modelling confined multi-material heat and mass flows using
/// SPH", 1998). Walls that hold fluid back (FluidDef::wall_friction) are the mirror image of
/// the particle, whose velocity goes on linearly beyond the surface.
class ViscousForces {
 public:
  explicit ViscousForces(FluidState& s)
      : s_(s), viscosity_(s.viscous_operands.viscosity), walls_(s.viscous_operands.walls) {
    viscosity_.resize(s.lists.places());
    viscosity_.back() = 0;
    walls_.clear();
    s.each([&](size_t p) { viscosity_[p] = s.def(p).viscosity; });
    several_ = s.defs.size() > 1;
    if (!s.any(&FluidDef::wall_friction)) return;
    const double clear = tolerances::wall_clearance * s.spacing;
    walls_.resize(s.touches.size());
    s.each([&](size_t p) {
      for (size_t k = s.first_touch[p]; k < s.first_touch[p + 1]; ++k)
        walls_[k] = s.def(p).wall_friction * s.walls[s.touches[k].wall].friction * viscosity_[p] *
                    s.touches[k].gradient.norm() / std::max(s.touches[k].distance, clear);
    });
  }

  /// f(p, force over its volume by velocities u among fluid that moves like them [N/m3]).
  template <class F>
  void among_fluid(const FluidVectors& u, const F& f) const {
    s_.each([&](size_t p) { s_.terms.put(p, differing(s_, p, u[p])); });
    s_.each_with_pairs(FluidFactor::slope, s_.terms, several_ ? viscosity_.data() : nullptr,
                       [&](size_t p, const FluidVector& sum) {
                         f(p, Vec3(2 * viscosity_[p] * difference(u[p], sum)));
                       });
  }
  /// Of one wall on a particle that moves by u relative to it [N/m3].
  Vec3 of_wall(size_t touch, const Vec3& u) const { return -walls_[touch] * u; }
  bool walls() const { return !walls_.empty(); }
  /// How much a particle's own velocity is held back among its own kind [kg/(m3 s)].
  double own(size_t p) const {
    double sum = -2 * viscosity_[p] * s_.slopes[p];
    if (walls())
      for (size_t k = s_.first_touch[p]; k < s_.first_touch[p + 1]; ++k) sum += walls_[k];
    return sum;
  }

 private:
  FluidState& s_;
  bool several_ = false;            ///< fluids
  std::vector<double>& viscosity_;  ///< [Pa s]
  std::vector<double>& walls_;      ///< by touch, force on the volume per speed [kg/(m3 s)]
};

/// Conjugate gradients for (density - h L) v = density v*, with L the viscous forces, scaled by the
/// diagonal; one right side of three components. What is left over of the right side goes into the
/// velocities as it is: then what they gained is h L v / density of the velocities found, and the
/// momentum is kept, however early iterations end.
class ViscousSolve {
 public:
  ViscousSolve(FluidState& s, const ViscousForces& forces)
      : s_(s),
        forces_(forces),
        residual_(s.viscous_operands.residual),
        direction_(s.viscous_operands.direction),
        image_(s.viscous_operands.image),
        scale_(s.viscous_operands.scale) {
    for (FluidVectors* a : {&residual_, &direction_, &image_}) a->resize(s.lists.places());
    scale_.resize(s.size());
    s.each([&](size_t p) { scale_[p] = 1 / (s.density[p] + s.h * forces_.own(p)); });
  }

  /// [kg/(m2 s)]
  Vec3 residual(size_t p) const { return residual_[p]; }
  void run() {
    FluidState& s = s_;
    // The right side holds what walls that move give; the start is v*.
    forces_.among_fluid(s.v, [&](size_t p, const Vec3& f) {
      Vec3 r = s.h * f;
      if (forces_.walls())
        for (size_t k = s.first_touch[p]; k < s.first_touch[p + 1]; ++k)
          r += s.h * forces_.of_wall(k, s.v[p] - s.bodies[s.touches[k].body].velocity_at(s.x(p)));
      residual_.set(p, r);
      direction_.set(p, scale_[p] * r);
    });
    double squared = scaled();
    const double enough =
        tolerances::viscous_residual * tolerances::viscous_residual *
        s.sum([&](size_t p) { return s.volume[p] * s.density[p] * s.v[p].squaredNorm(); });
    for (int n = 0;
         n < tolerances::most_viscous_iterations && squared > enough && !stop_requested(); ++n) {
      apply();
      const double curve =
          s.sum([&](size_t p) { return s.volume[p] * direction_[p].dot(image_[p]); });
      if (!(curve > 0)) return;
      const double step = squared / curve;
      s.each([&](size_t p) {
        s.v.set(p, s.v[p] + step * direction_[p]);
        residual_.set(p, residual_[p] - step * image_[p]);
      });
      const double next = scaled(), ratio = next / squared;
      squared = next;
      s.each(
          [&](size_t p) { direction_.set(p, scale_[p] * residual_[p] + ratio * direction_[p]); });
    }
  }

 private:
  double scaled() const {
    return s_.sum([&](size_t p) { return s_.volume[p] * scale_[p] * residual_[p].squaredNorm(); });
  }
  void apply() {
    FluidState& s = s_;
    forces_.among_fluid(direction_, [&](size_t p, Vec3 f) {
      if (forces_.walls())
        for (size_t k = s.first_touch[p]; k < s.first_touch[p + 1]; ++k)
          f += forces_.of_wall(k, direction_[p]);
      image_.set(p, s.density[p] * direction_[p] - s.h * f);
    });
  }
  FluidState& s_;
  const ViscousForces& forces_;
  FluidVectors &residual_, &direction_, &image_;
  std::vector<double>& scale_;
};

double kinetic_energy(const FluidState& s) {
  return s.sum([&](size_t p) { return 0.5 * s.density[p] * s.volume[p] * s.v[p].squaredNorm(); });
}

}  // namespace

void solve_viscosity(FluidState& s) {
  if (!s.any(&FluidDef::viscosity)) return;
  const ViscousForces forces(s);
  FluidVectors& found = s.viscous_operands.found;
  found = s.v;
  ViscousSolve solve(s, forces);
  solve.run();
  std::swap(s.v, found);
  s.each([&](size_t p) {
    const Vec3 gained = found[p] - s.v[p] + solve.residual(p) / s.density[p];
    s.acceleration.set(p, gained / s.h);
  });
  s.report.viscous_work += s.accelerate();
  if (!forces.walls()) return;
  std::vector<Wrench> impulses = s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
    for (size_t k = s.first_touch[p]; k < s.first_touch[p + 1]; ++k) {
      const uint32_t body = s.touches[k].body;
      const Vec3 u = found[p] - s.bodies[body].velocity_at(s.x(p));
      s.add_force(to, body, s.x(p), -s.h * s.volume[p] * forces.of_wall(k, u));
    }
  });
  s.push_bodies(impulses);
}

void smooth_velocities(FluidState& s) {
  if (!s.any(&FluidDef::xsph)) return;
  // What of a particle's mass takes the velocity of others [kg/m3].
  std::vector<double>& exchanged = s.viscous_operands.exchanged;
  if (s.defs.size() > 1) {
    exchanged.assign(s.lists.places(), 0);
    s.each([&](size_t p) { exchanged[p] = s.def(p).xsph * s.density[p]; });
  }
  const double before = kinetic_energy(s);
  s.each([&](size_t p) { s.terms.put(p, differing(s, p, s.v[p])); });
  s.each_with_pairs(FluidFactor::weight, s.terms, s.defs.size() > 1 ? exchanged.data() : nullptr,
                    [&](size_t p, const FluidVector& sum) {
                      s.acceleration.set(p, -s.def(p).xsph / s.h * difference(s.v[p], sum));
                    });
  s.accelerate();
  s.report.viscous_work += kinetic_energy(s) - before;
}

}  // namespace tumble
