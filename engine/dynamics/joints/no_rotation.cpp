#include "engine/dynamics/joints/joint_part.hpp"

namespace tumble {

// q = q_a* q_b turns by omega' = A^T (omega_b - omega_a): q' = (0, omega') q / 2. So the vector
// part v of q has 2 v' = w omega' + omega' x v with the scalar part w, and row k of the Jacobian is
// A m with m = w e_k + v x e_k.
JointRow* no_rotation(const JointSides& s, JointRow* out) {
  Quat q = s.a.q.conjugate() * s.b.q;
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Vec3 relative = s.b.omega - s.a.omega;
  const Vec3 turning = s.a.axes.transpose() * relative;
  const Vec3 v = q.vec();
  const double w_rate = -0.5 * v.dot(turning);
  const Vec3 v_rate = 0.5 * (q.w() * turning + turning.cross(v));
  for (int k = 0; k < 3; ++k, ++out) {
    const Vec3 e = Vec3::Unit(k);
    const Vec3 turn = s.a.axes * (q.w() * e + v.cross(e));
    const Vec3 turn_rate = s.a.omega.cross(turn) + s.a.axes * (w_rate * e + v_rate.cross(e));
    out->row.a = {s.a.block, Vec3::Zero(), -turn};
    out->row.b = {s.b.block, Vec3::Zero(), turn};
    out->error = 2 * v[k];
    out->bias = turn_rate.dot(relative);
  }
  return out;
}

}  // namespace tumble
