#pragma once
#include "engine/collision/shape.hpp"
#include "engine/core/crew.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// A rigid body as fluids see it for a tick.
struct FluidBody {
  Vec3 centre = Vec3::Zero();                ///< of mass, at the start of the tick [m]
  Vec3 velocity = Vec3::Zero();              ///< at the start of the tick [m/s]
  Vec3 angular_velocity = Vec3::Zero();      ///< likewise [rad/s]
  Vec3 acceleration = Vec3::Zero();          ///< by all but this fluid, over the tick [m/s2]
  Vec3 angular_acceleration = Vec3::Zero();  ///< likewise [rad/s2]
  double inverse_mass = 0;                   ///< 0: no push moves it [1/kg]
  Mat3 inverse_inertia = Mat3::Zero();       ///< world axes [1/(kg m2)]
};

/// A shape of such a body.
struct FluidWall {
  const Shape* shape = nullptr;
  Pose pose;            ///< of the shape, in the world, at the start of the tick
  uint32_t body = 0;    ///< index in FluidTick::bodies
  double friction = 1;  ///< share of FluidDef::wall_friction that it has [-]
};

/// What fluid does to a body in a tick, about its centre of mass.
struct FluidPush {
  Vec3 impulse = Vec3::Zero();          ///< [N s]
  Vec3 angular_impulse = Vec3::Zero();  ///< [N m s]
};

/// The particles of fluids, by index; the solver moves them.
struct FluidParticles {
  std::span<Vec3> x, v;          ///< [m], [m/s]
  std::span<double> pressure;    ///< of the last tick, a first guess; of this one after it [Pa]
  std::span<const double> mass;  ///< [kg]
  std::span<const Vec3> acceleration;  ///< by all else, gravity too, over the tick [m/s2]
  std::span<const uint8_t> fluid{};    ///< of which one each is; empty: all of the first
};

/// How the solver of `dfsph` came to its pressures in the last sub-step, for whoever asks for it.
struct FluidTrace {
  struct Iteration {
    /// Mean of `wrong` [-], which ends the iterations where it is small enough.
    double error = 0;
    /// By the caller's index: how far a particle's density would be off, of that at rest [-].
    std::vector<float> wrong;
    int number = 0;
  };
  struct Solve {
    double enough = 0;                  ///< the error at which it ends [-]
    std::vector<Iteration> iterations;  ///< the first is where it began
  };
  /// Of a solve that takes more, the first ones and the last are kept: each holds a number for
  /// every particle, and nobody looks at hundreds of them.
  static constexpr size_t most_kept = 200;
  int sub_step = 0;  ///< which one, from 1 on
  double h = 0;      ///< its length [s]
  Solve pressure;    ///< for velocities that keep the density
  Solve shift;       ///< for displacements that mend what of it is still wrong
};

struct FluidTick {
  double h = 0;  ///< [s]
  std::span<const FluidBody> bodies;
  std::span<const FluidWall> walls;
  FluidTrace* trace = nullptr;  ///< null: nobody looks
};

struct FluidReport {
  int sub_steps = 0;
  int pressure_iterations = 0, shift_iterations = 0;  ///< over all sub-steps
  double density_error = 0;  ///< mean excess over the density at rest, of the last sub-step [-]
  size_t pairs = 0;          ///< neighbours that particles have, of the last sub-step
  // Work done on particles over the tick [J]: what they gained by each, exact for the velocities.
  double pressure_work = 0, viscous_work = 0, tension_work = 0, outer_work = 0;
};

/// Whether particles of both can be neighbours of each other in one solve.
bool can_be_solved_together(const FluidDef& a, const FluidDef& b);

/// Moves the particles of fluids that see each other for one tick, in sub-steps by the Courant
/// condition. Walls are solid: their share of a particle's surroundings is the integral of the
/// kernel over them (sph/wall_integrals), fluid beyond a wall would move as its mirror image, and
/// bodies move with the sum of the impulses on them while pressures are sought, so that what is
/// lighter than the fluid is no less stable than what is heavier. Keeps its memory; knows nothing
/// from earlier ticks.
class FluidSolver {
 public:
  FluidSolver();
  ~FluidSolver();
  FluidSolver(FluidSolver&&) noexcept;
  FluidSolver& operator=(FluidSolver&&) noexcept;

  /// Fails where positions are not finite, or a tick needs too many sub-steps: then particles are
  /// anywhere, and the caller puts them back.
  Result<FluidReport> step(std::span<const FluidDef* const> defs, const FluidParticles& particles,
                           const FluidTick& tick, Crew* crew);
  /// By body of the last step.
  std::span<const FluidPush> pushes() const;
  /// By particle: density over that at rest, at the start of the last sub-step [-].
  std::span<const double> densities() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Which of the points are in one of the walls, or nearer to its surface than `clearance` [m]:
/// those that a fluid cannot begin with.
std::vector<uint8_t> inside_walls(std::span<const Vec3> points, std::span<const FluidWall> walls,
                                  double clearance);

}  // namespace tumble
