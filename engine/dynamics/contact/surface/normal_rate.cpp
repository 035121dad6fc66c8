#include "engine/dynamics/contact/surface/normal_rate.hpp"

#include "engine/dynamics/contact/surface/tolerances.hpp"
#include "engine/math/rotation.hpp"
#include "engine/math/rotation_rates.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

Error no_normal(std::string message, std::string cure) {
  return {ErrorCode::numeric, std::move(message), "normal_rate", std::move(cure)};
}

/// Completes a contact of any kind, given its normal, points and their rates.
void complete(NormalRate& r, const FrameMotion& a, const FrameMotion& b) {
  r.relative_velocity = b.velocity_at(r.point_b) - a.velocity_at(r.point_a);
  r.gap_rate = r.normal.dot(r.relative_velocity);
  r.velocity_bias = b.omega.cross(r.point_rate_b - b.v) - a.omega.cross(r.point_rate_a - a.v);
  r.gap_bias = r.normal_rate.dot(r.relative_velocity) + r.normal.dot(r.velocity_bias);
}

/// The same contact with A and B exchanged.
Result<NormalRate> with_sides_exchanged(Result<NormalRate> found) {
  if (!found) return found;
  NormalRate& r = *found;
  r.normal = -r.normal;
  r.normal_rate = -r.normal_rate;
  std::swap(r.point_a, r.point_b);
  std::swap(r.point_rate_a, r.point_rate_b);
  r.relative_velocity = -r.relative_velocity;
  r.velocity_bias = -r.velocity_bias;
  return found;
}

/// The contact of two balls (or points) at p and q, whose centres move at known rates.
Result<NormalRate> between(const Vec3& p, const Vec3& p_rate, double radius_p, const Vec3& q,
                           const Vec3& q_rate, double radius_q, const FrameMotion& a,
                           const FrameMotion& b) {
  const Vec3 across = q - p;
  const double distance = across.norm();
  if (!(distance > 0)) {
    return no_normal("the centres coincide, every direction is normal to them",
                     "treat the contact by another feature");
  }
  NormalRate r;
  r.normal = across / distance;
  r.normal_rate = unit_vector_rate(across, q_rate - p_rate);
  r.gap = distance - radius_p - radius_q;
  r.point_a = p + radius_p * r.normal;
  r.point_b = q - radius_q * r.normal;
  r.point_rate_a = p_rate + radius_p * r.normal_rate;
  r.point_rate_b = q_rate - radius_q * r.normal_rate;
  complete(r, a, b);
  return r;
}

}  // namespace

Mat3 level_set_curvature(const Vec3& gradient, const Mat3& hessian) {
  const double slope = gradient.norm();
  const Vec3 n = gradient / slope;
  const Mat3 P = Mat3::Identity() - n * n.transpose();
  return P * hessian * P / slope;
}

Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const RoundPoint& on_b) {
  return between(on_a.x_world, a.velocity_at(on_a.x_world), on_a.radius, on_b.x_world,
                 b.velocity_at(on_b.x_world), on_b.radius, a, b);
}

Result<NormalRate> normal_rate(const FrameMotion& a, const FlatFace& on_a, const FrameMotion& b,
                               const RoundPoint& on_b) {
  NormalRate r;
  r.normal = on_a.normal;
  r.normal_rate = attached_rate(r.normal, a.omega);
  const Vec3& p = on_b.x_world;
  r.gap = r.normal.dot(p - on_a.x_world) - on_b.radius;
  r.point_b = p - on_b.radius * r.normal;
  r.point_rate_b = b.velocity_at(p) - on_b.radius * r.normal_rate;
  // The foot of the perpendicular: w_A = w_B - gap n.
  r.point_a = r.point_b - r.gap * r.normal;
  const double gap_rate = r.normal.dot(b.velocity_at(r.point_b) - a.velocity_at(r.point_a));
  r.point_rate_a = r.point_rate_b - gap_rate * r.normal - r.gap * r.normal_rate;
  complete(r, a, b);
  return r;
}

Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const FlatFace& on_b) {
  return with_sides_exchanged(normal_rate(b, on_b, a, on_a));
}

Result<NormalRate> normal_rate(const FrameMotion& a, const RoundLine& on_a, const FrameMotion& b,
                               const RoundPoint& on_b) {
  const Vec3& e = on_a.direction;
  const double square = e.squaredNorm();
  if (!(square > 0)) return no_normal("an edge has no direction", "give it a length > 0");
  const Vec3 arm = on_b.x_world - on_a.x_world;
  // Foot of the perpendicular: p + s e with s = arm.e / e^2, where |e| is constant.
  const double s = arm.dot(e) / square;
  const Vec3 line_rate = a.velocity_at(on_a.x_world), point_rate = b.velocity_at(on_b.x_world);
  const Vec3 e_rate = attached_rate(e, a.omega);
  const double s_rate = ((point_rate - line_rate).dot(e) + arm.dot(e_rate)) / square;
  return between(on_a.x_world + s * e, line_rate + s * e_rate + s_rate * e, on_a.radius,
                 on_b.x_world, point_rate, on_b.radius, a, b);
}

Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const RoundLine& on_b) {
  return with_sides_exchanged(normal_rate(b, on_b, a, on_a));
}

Result<NormalRate> normal_rate(const FrameMotion& a, const RoundLine& on_a, const FrameMotion& b,
                               const RoundLine& on_b, const Vec3& towards_b) {
  const Vec3 &e = on_a.direction, &f = on_b.direction;
  const Vec3 across = e.cross(f);
  const double area = across.norm();
  if (!(area > tolerances::parallel_edges * e.norm() * f.norm())) {
    return no_normal("the edges are parallel, no direction is normal to both alone",
                     "treat the contact as two of an edge's ends with the other edge");
  }
  const double side = across.dot(towards_b);
  if (!(side != 0)) {
    return no_normal("the direction towards B is at right angles to the normal of the edges",
                     "take it from the last time when they were apart");
  }
  const double sign = side > 0 ? 1 : -1;
  const Vec3 e_rate = attached_rate(e, a.omega), f_rate = attached_rate(f, b.omega);
  NormalRate r;
  r.normal = sign * across / area;
  r.normal_rate = sign * unit_vector_rate(across, e_rate.cross(f) + e.cross(f_rate));
  // Closest points p + s e and q + u f: q + u f - p - s e = d n.
  const Vec3 arm = on_b.x_world - on_a.x_world;
  const double c = sign * area, d = r.normal.dot(arm);
  const double s = arm.cross(f).dot(r.normal) / c, u = arm.cross(e).dot(r.normal) / c;
  const Vec3 p = on_a.x_world + s * e, q = on_b.x_world + u * f;
  // The same equation differentiated: u' f - s' e = d' n + d n' - (v_q - v_p).
  const Vec3 p_rate = a.velocity_at(p), q_rate = b.velocity_at(q);
  const Vec3 rest = d * r.normal_rate - (q_rate - p_rate);
  const double s_rate = -rest.cross(f).dot(r.normal) / c, u_rate = -rest.cross(e).dot(r.normal) / c;
  r.gap = d - on_a.radius - on_b.radius;
  r.point_a = p + on_a.radius * r.normal;
  r.point_b = q - on_b.radius * r.normal;
  r.point_rate_a = p_rate + s_rate * e + on_a.radius * r.normal_rate;
  r.point_rate_b = q_rate + u_rate * f - on_b.radius * r.normal_rate;
  complete(r, a, b);
  return r;
}

Result<NormalRate> normal_rate(const FrameMotion& a, const SmoothPoint& on_a, const FrameMotion& b,
                               const SmoothPoint& on_b, const Vec3& normal) {
  // With slips s_A, s_B of the closest points along their surfaces, S the curvatures, g the gap:
  //   n' = omega_A x n + S_A s_A = omega_B x n - S_B s_B        (both surfaces turn the normal)
  //   s_B = s_A + g n' - v_t                                     (w_B - w_A = g n, differentiated)
  // so that (S_A + S_B + g S_B S_A) s_A = (omega_B - omega_A) x n + S_B (v_t - g omega_A x n).
  NormalRate r;
  r.normal = normal;
  r.point_a = on_a.x_world;
  r.point_b = on_b.x_world;
  r.gap = normal.dot(r.point_b - r.point_a);
  const Vec3 ua = a.velocity_at(r.point_a), ub = b.velocity_at(r.point_b);
  const double gap_rate = normal.dot(ub - ua);
  const Vec3 slip = ub - ua - gap_rate * normal;
  const Mat3 &SA = on_a.curvature, &SB = on_b.curvature;
  const Vec3 turn_a = a.omega.cross(normal), turn_b = b.omega.cross(normal);
  const Mat3 M = SA + SB + r.gap * (SB * SA);
  const Vec3 rhs = turn_b - turn_a + SB * (slip - r.gap * turn_a);
  Vec3 t1, t2;
  tangent_frame(normal, t1, t2);
  const Vec3 m1 = M * t1, m2 = M * t2;
  const double m11 = t1.dot(m1), m12 = t1.dot(m2), m21 = t2.dot(m1), m22 = t2.dot(m2);
  const double determinant = m11 * m22 - m12 * m21;
  const double largest = std::max({std::abs(m11), std::abs(m12), std::abs(m21), std::abs(m22)});
  if (!(std::abs(determinant) > tolerances::singular * largest * largest)) {
    return no_normal("the surfaces meet along a line or an area, their closest points are many",
                     "treat the contact by the ends of the line or by the area's corners");
  }
  const double r1 = t1.dot(rhs), r2 = t2.dot(rhs);
  const Vec3 slip_a =
      (r1 * m22 - r2 * m12) / determinant * t1 + (m11 * r2 - m21 * r1) / determinant * t2;
  r.normal_rate = turn_a + SA * slip_a;
  r.point_rate_a = ua + slip_a;
  r.point_rate_b = ub + slip_a + r.gap * r.normal_rate - slip;
  complete(r, a, b);
  return r;
}

}  // namespace tumble
