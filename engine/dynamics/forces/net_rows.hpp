#pragma once
#include "engine/dynamics/forces/spring_net.hpp"

#include <vector>

namespace tumble {

/// A spring made ready for the solution of a SpringNet.
struct NetRow {
  Vec3 n;                         ///< from a to b, unit; zero where it has no direction
  Vec3 pull;                      ///< on a, before the velocities change [N]
  double along = 0, across = 0;   ///< E = along n n^T + across (1 - n n^T) [kg]
  double turn_a = 0, turn_b = 0;  ///< what the arm's turning changes of the moment [N m]

  Vec3 times_E(const Vec3& x) const { return across * x + ((along - across) * n.dot(x)) * n; }
};

/// The same of a stencil: -weight times `pull` acts on its ends; E = e 1 + along n n^T.
struct NetBow {
  Vec3 pull;                ///< [N]
  Vec3 n;                   ///< along q, unit or zero
  double e = 0, along = 0;  ///< [kg]

  Vec3 times_E(const Vec3& x) const { return e * x + (along * n.dot(x)) * n; }
};

/// The rows of the ties. `stiffness` is memory: by node the stiffness of all that hangs on it, over
/// its mass [1/s2].
void prepare_rows(const SpringNet& net, std::vector<NetRow>& rows, std::vector<double>& stiffness);
/// Those of the stencils, after prepare_rows().
void prepare_bows(const SpringNet& net, const std::vector<double>& stiffness,
                  std::vector<NetBow>& bows);

/// The part of a turn that moves the end of an arm.
inline Vec3 across_arm(const Vec3& arm, const Vec3& turn) {
  const double r2 = arm.squaredNorm();
  return r2 > 0 ? Vec3(turn - arm * (arm.dot(turn) / r2)) : Vec3(Vec3::Zero());
}

}  // namespace tumble
