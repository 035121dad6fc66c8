#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

/// A damped spring, or a resistance to bending, that is solved together with contacts and joints.
/// Its length is that of q = sum_i w_i x_i over its ends, of weights that add up to nothing; end i
/// gets the impulse -w_i P. A spring has the weights -1 and 1, bending a rest length of 0.
struct SolvedSpring {
  static constexpr uint32_t most_ends = 4;
  struct End {
    uint32_t slot = no_body;     ///< of a body; `no_body`: the world
    Vec3 point = Vec3::Zero();   ///< from its centre of mass, body axes; of the world, its axes [m]
    double weight = 0;           ///< [-]
    Vec3 moment = Vec3::Zero();  ///< that it got over the step, about the centre of mass [N m s]
  };
  std::array<End, most_ends> end;
  uint32_t count = 0;                                  ///< of the ends
  double stiffness = 0, damping = 0, rest_length = 0;  ///< [N/m], [N s/m], [m]
  // Over the step.
  Vec3 impulse = Vec3::Zero();  ///< P [N s]
  Vec3 elastic = Vec3::Zero();  ///< the part of it that the potential explains [N s]

  void add(uint32_t slot, const Vec3& point, double weight) {
    end[count++] = {slot, point, weight, Vec3::Zero()};
  }
};

/// How the ends of a spring lie, move and give way.
struct SpringMotion {
  Vec3 q = Vec3::Zero();     ///< [m]
  Vec3 rate = Vec3::Zero();  ///< of q [m/s]
  double mobility = 0;       ///< change of the rate by an impulse but for what arms turn [1/kg]
};
SpringMotion spring_motion(const SolvedSpring& spring, std::span<const RigidBody> bodies);

/// One of them in the inner loops. Over a sub-step of h seconds it is backward Euler, linearised at
/// its start (Baraff and Witkin, "Large steps in cloth simulation", 1998): with l the length of q
/// and n its direction then, and u its rate at the end of the sub-step,
///   P = h k (l - l0) n + E u,   E = (h^2 k + h c) n n^T + h^2 k_u (1 - n n^T).
/// k_u is the part of the stiffness across the line of a stretched spring, k (1 - l0/l), that a
/// sub-step does not resolve: its share 1 - 1/z where z > 1, z being h^2 times the sum of such
/// stiffness over mass of all springs at its ends (as in SpringNet). What is resolved goes along
/// the line alone, which leaves angular momentum as it is. An impulse changes the rate by -W P, W
/// being what the ends yield: the one that fulfils this is
///   P = (1 + E W)^-1 (h k (l - l0) n + E (u + W P_before)).
struct SpringRow {
  static constexpr uint32_t none = ~uint32_t{0};
  std::array<uint32_t, SolvedSpring::most_ends> body{};  ///< solver bodies
  std::array<double, SolvedSpring::most_ends> weight{};
  uint32_t count = 0;
  uint32_t source = 0;                                 ///< SolverContext::springs
  uint32_t turns = none;                               ///< SpringTurn of one that turns a body
  double stiffness = 0, damping = 0, rest_length = 0;  ///< SolvedSpring
  Vec3 start = Vec3::Zero();  ///< q at the start of the step but for arms that turn [m]
  Vec3 q = Vec3::Zero();      ///< now [m]
  Vec3 n = Vec3::UnitX();     ///< along q at the start of the sub-step
  Vec3 aim = Vec3::Zero();    ///< (1 + E W)^-1 h k (l - l0) n [N s]
  /// (1 + E W)^-1 E along n and across it, and W, of one that turns none [kg], [1/kg].
  double along = 0, across = 0, mobility = 0;
  Vec3 impulse = Vec3::Zero();                      ///< P of the sub-step [N s]
  Vec3 change = Vec3::Zero();                       ///< of P by the last sweep [N s]
  Vec3 step = Vec3::Zero();                         ///< direction of accelerate_springs [N s]
  Vec3 sum = Vec3::Zero(), elastic = Vec3::Zero();  ///< of the sub-steps so far: SolvedSpring
};

/// What a spring needs besides that turns a body.
struct SpringTurn {
  std::array<Vec3, SolvedSpring::most_ends> arm;  ///< of its ends, world axes [m]
  Mat3 follows = Mat3::Zero();                    ///< (1 + E W)^-1 E [kg]
  Mat3 yields = Mat3::Zero();                     ///< W [1/kg]
};

struct SolverContext;
struct SolverIsland;

/// Fills the rows, which come with bodies, weights, count, source and turns set.
void prepare_springs(const SolverContext& context, const SolverIsland& island);
/// Makes ready for a sub-step of `hs` seconds, and starts from a share of the impulses of the one
/// before; in the first from those that the lengths ask for.
void start_springs(const SolverContext& context, const SolverIsland& island, double hs, bool first);
/// One sweep over the springs of an island, there or back. Gives by how much impulses changed, as
/// the sum of their squares in the norm of kinetic energy [J].
double sweep_springs(const SolverIsland& island, bool back);
/// After a sweep that changed impulses by `share` of what the one before did (sweep_springs): goes
/// on in the conjugate direction, as nonlinear conjugate gradients do with a sweep as
/// preconditioned gradient (M. Silcowitz-Hansen, S. Niebe and K. Erleben, "A nonsmooth nonlinear
/// conjugate gradient method for interactive contact force problems", 2010), or starts anew where
/// it has grown.
void accelerate_springs(const SolverIsland& island, double share);
/// When positions have moved: adds the impulses of the sub-step to those of the step.
void sum_springs(const SolverContext& context, const SolverIsland& island, double hs);
/// Writes these back.
void store_springs(const SolverContext& context, const SolverIsland& island);

}  // namespace tumble
