#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// Particles and bodies that springs tie together, for one step of `h` seconds that takes all of
/// the springs at once. What a step resolves of a spring (an oscillation of six steps and more) is
/// leapfrog: the pull half a step ahead along the present velocities, second order, no drift of
/// energy. What is stiffer than that, and all damping, is backward Euler, linearised once: Baraff
/// and Witkin, "Large steps in cloth simulation" (1998). With the velocities' changes d of the
/// nodes, J their part in how the ends of spring i move apart, M masses and inertias,
///   (M + sum_i J_i^T E_i J_i) d = h sum_i J_i^T F_i + M d_free,
///   F_i = (k (l - l0) + c dl/dt) n + (h - lead) K_i dv,   E_i = h c n n^T + h^2 K_i,
///   K_i = k_u (n n^T + max(0, 1 - l0/l) (1 - n n^T)).
/// k_u is the stiffness that the step does not resolve: k (1 - 1/z) where z > 1, z being h^2 times
/// the sum of k/m of all springs at both ends; by Gershgorin's theorem the other springs' part then
/// stays below half of the leapfrog's limit. The matrix is symmetric and positive definite whatever
/// the springs do. Every spring pulls its two ends with opposite forces: momentum stays exactly.
struct SpringNet {
  static constexpr uint32_t fixed = ~uint32_t{0};

  /// What has a velocity of its own.
  struct Node {
    double mass = 0;                  ///< > 0 [kg]
    Mat3 inertia = Mat3::Zero();      ///< about the centre, world axes [kg m2]
    bool turns = false;               ///< it has an inertia
    Vec3 omega = Vec3::Zero();        ///< [rad/s]
    Vec3 dv_free = Vec3::Zero();      ///< what other forces change in the step [m/s]
    Vec3 domega_free = Vec3::Zero();  ///< [rad/s]
    // Of nets with meshes:
    bool meshed = false;    ///< it is a node of a mesh
    Vec3 x = Vec3::Zero();  ///< where it is, ahead by the lead [m]
  };
  struct End {
    uint32_t node = fixed;    ///< or something that no spring moves
    Vec3 arm = Vec3::Zero();  ///< from the node's centre, of those that turn [m]
    double mobility = 0;      ///< along the spring [1/kg]
  };
  struct Tie {
    End a, b;
    Vec3 d;                                              ///< from a to b, ahead by the lead [m]
    Vec3 dv;                                             ///< velocity of b relative to a [m/s]
    double stiffness = 0, damping = 0, rest_length = 0;  ///< [N/m], [N s/m], [m]
  };
  /// Resistance to bending: SpringMesh::Bend, its q ahead by the lead.
  struct Stencil {
    std::array<End, 4> end;
    std::array<double, 4> weight{};
    uint32_t count = 0;
    Vec3 q = Vec3::Zero(), dq = Vec3::Zero();  ///< [m], [m/s]
    double stiffness = 0, damping = 0;         ///< [N/m], [N s/m]
  };
  /// What a spring does over the step, as a mean.
  struct Pull {
    Vec3 force = Vec3::Zero();    ///< on a; on b its negative [N]
    Vec3 elastic = Vec3::Zero();  ///< the part of it that the potential explains [N]
    /// What turning in the step changes of the moment of the force [N m].
    Vec3 turn_a = Vec3::Zero(), turn_b = Vec3::Zero();
  };
  struct Report {
    int iterations = 0;
    /// How far the velocities that the pulls give are from those that were solved for, relative to
    /// their change, in the norm of kinetic energy [-].
    double residual = 0;
  };

  /// What a stencil does: -weight times `force` on each of its ends, as a mean.
  struct Bow {
    Vec3 force = Vec3::Zero();    ///< [N]
    Vec3 elastic = Vec3::Zero();  ///< the part of it that the potential explains [N]
  };
  /// What a net with meshes does.
  struct Answer {
    std::vector<Pull> ties;
    std::vector<Bow> stencils;
    /// By node: force and torque on nodes of meshes that the velocities which were solved for need
    /// besides. With them, springs have no sum and no moment where nothing holds the net [N], [N
    /// m].
    std::vector<Vec3> rest_force, rest_torque;
    Report report;
  };

  double h = 0;     ///< [s]
  double lead = 0;  ///< how far ahead springs look [s]
  std::vector<Node> nodes;
  std::vector<Tie> ties;
  // Of nets with meshes:
  std::vector<Stencil> stencils;
  /// So much damping, in steps, has the stiffness that a step does not resolve [-]. Without any a
  /// stiff spring that is stretched by s at the start of a step gets the velocity -s/h, which at
  /// the end of a step of x += h (v- + v+)/2 leaves s/2: it swings on, falling by 0.71 in a step,
  /// and what turns in between feeds that. With 6 - sqrt(32) = 1/(1 + ease) of the velocity it
  /// creeps back as fast as it can without swinging, by 0.41 in a step.
  double ease = 0;

  /// The pull of each tie. Ties of length zero do not pull: their direction is undefined.
  Report solve(std::vector<Pull>& out) const;
  /// The same for nets with meshes, which are large: by a matrix that is put together, in mixed
  /// precision (NetSystem).
  void solve_meshed(Answer& out) const;
};

}  // namespace tumble
