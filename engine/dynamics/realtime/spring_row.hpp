#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

/// A damped spring, or a resistance to bending, that is solved together with contacts and joints.
/// Its length is that of q = sum_i w_i x_i over its ends, with weights whose sum is zero; end i
/// gets the impulse -w_i P. A spring has the weights -1 and 1; bending has a rest length of 0.
struct SolvedSpring {
  static constexpr uint32_t most_ends = 4;
  struct End {
    uint32_t slot = no_body;  ///< slot of a body; `no_body`: fixed in the world
    /// Relative to the centre of mass, body axes; or in the world's axes [m]
    Vec3 point = Vec3::Zero();
    double weight = 0;           ///< [-]
    Vec3 moment = Vec3::Zero();  ///< angular impulse over the step about the centre of mass [N m s]
  };
  std::array<End, most_ends> end;
  uint32_t count = 0;                                  ///< number of ends
  double stiffness = 0, damping = 0, rest_length = 0;  ///< [N/m], [N s/m], [m]
  // Results over the step.
  Vec3 impulse = Vec3::Zero();  ///< P [N s]
  Vec3 elastic = Vec3::Zero();  ///< the part of P that comes from the elastic potential [N s]

  void add(uint32_t slot, const Vec3& point, double weight) {
    end[count++] = {slot, point, weight, Vec3::Zero()};
  }
};

/// Extent, motion and mobility of a spring's ends.
struct SpringMotion {
  Vec3 q = Vec3::Zero();     ///< [m]
  Vec3 rate = Vec3::Zero();  ///< of q [m/s]
  double mobility = 0;  ///< change of the rate per impulse, without rotation of the bodies [1/kg]
};
SpringMotion spring_motion(const SolvedSpring& spring, std::span<const RigidBody> bodies);

/// One spring in the inner loops. Over a sub-step of h seconds it is backward Euler, linearised at
/// its start (Baraff and Witkin, "Large steps in cloth simulation", 1998): with l the length of q
/// and n its direction at the start, and u the rate of q at the end of the sub-step,
///   P = h k (l - l0) n + E u,   E = (h^2 k + h c) n n^T + h^2 k_u (1 - n n^T).
/// k_u is the part of the transverse stiffness of a stretched spring, k (1 - l0/l), that a sub-step
/// does not resolve: its share 1 - 1/z if z > 1, where z is h^2 times the sum of transverse
/// stiffness over mass of all springs at its ends (as in SpringNet). The resolved part acts along
/// the line of the spring only, which conserves angular momentum. An impulse changes the rate by
/// -W P, with W the mobility of the ends, so that the solution is
///   P = (1 + E W)^-1 (h k (l - l0) n + E (u + W P_before)).
struct SpringRow {
  static constexpr uint32_t none = ~uint32_t{0};
  std::array<uint32_t, SolvedSpring::most_ends> body{};  ///< solver bodies
  std::array<double, SolvedSpring::most_ends> weight{};
  uint32_t count = 0;
  uint32_t source = 0;    ///< index in SolverContext::springs
  uint32_t turns = none;  ///< index of its SpringTurn, if it turns a body
  double stiffness = 0, damping = 0, rest_length = 0;  ///< SolvedSpring
  /// Constant part of q at the start of the step, without arms that turn [m]
  Vec3 start = Vec3::Zero();
  Vec3 q = Vec3::Zero();    ///< at present [m]
  Vec3 n = Vec3::UnitX();   ///< direction of q at the start of the sub-step
  Vec3 aim = Vec3::Zero();  ///< (1 + E W)^-1 h k (l - l0) n [N s]
  /// If it turns no body: (1 + E W)^-1 E along n and across it [kg], and W [1/kg].
  double along = 0, across = 0, mobility = 0;
  Vec3 impulse = Vec3::Zero();  ///< P of the sub-step [N s]
  Vec3 change = Vec3::Zero();   ///< change of P in the last sweep [N s]
  Vec3 step = Vec3::Zero();     ///< search direction of accelerate_springs [N s]
  /// Over the sub-steps so far, as in SolvedSpring.
  Vec3 sum = Vec3::Zero(), elastic = Vec3::Zero();
};

/// What a spring that turns a body needs besides.
struct SpringTurn {
  std::array<Vec3, SolvedSpring::most_ends> arm;  ///< lever arms of its ends, world axes [m]
  Mat3 follows = Mat3::Zero();                    ///< (1 + E W)^-1 E [kg]
  Mat3 yields = Mat3::Zero();                     ///< W [1/kg]
};

struct SolverContext;
struct SolverIsland;

/// Fills in the rows, which come with body, weight, count, source and turns set.
void prepare_springs(const SolverContext& context, const SolverIsland& island);
/// Prepares a sub-step of `hs` seconds, and applies a share of the impulses of the previous one; in
/// the first sub-step of those that the present lengths give.
void start_springs(const SolverContext& context, const SolverIsland& island, double hs, bool first);
/// One sweep over the springs of an island, forwards or backwards. Returns the change of impulses
/// as the sum of their squares in the norm of kinetic energy [J].
double sweep_springs(const SolverIsland& island, bool back);
/// To be called after a sweep whose change was `share` of that of the sweep before (sweep_springs).
/// Adds a step along the conjugate direction, by the nonlinear conjugate gradient method with a
/// sweep as preconditioned gradient (M. Silcowitz-Hansen, S. Niebe and K. Erleben, "A nonsmooth
/// nonlinear conjugate gradient method for interactive contact force problems", 2010), or restarts
/// it where the change has grown.
void accelerate_springs(const SolverIsland& island, double share);
/// After positions moved: adds the impulses of the sub-step to those of the step.
void sum_springs(const SolverContext& context, const SolverIsland& island, double hs);
/// Writes the sums back.
void store_springs(const SolverContext& context, const SolverIsland& island);

}  // namespace tumble
