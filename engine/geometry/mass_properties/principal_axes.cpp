#include "engine/geometry/mass_properties/principal_axes.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Jacobi rotation: rotates rows and columns p, q of `a` so that a(p, q) becomes zero, and `v`
/// likewise.
void rotate(Mat3& a, Mat3& v, int p, int q) {
  if (a(p, q) == 0) return;
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  double t = 0;  // tangent of the smaller rotation angle
  if (std::fabs(theta) < 1e150) {
    t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
  } else {
    t = 0.5 / theta;
  }
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double app = a(p, p) - t * a(p, q), aqq = a(q, q) + t * a(p, q);
  const double arp = c * a(r, p) - s * a(r, q), arq = s * a(r, p) + c * a(r, q);
  a(p, p) = app;
  a(q, q) = aqq;
  a(p, q) = a(q, p) = 0;
  a(r, p) = a(p, r) = arp;
  a(r, q) = a(q, r) = arq;
  const Vec3 vp = v.col(p), vq = v.col(q);
  v.col(p) = c * vp - s * vq;
  v.col(q) = s * vp + c * vq;
}

Vec3 with_positive_largest(const Vec3& axis) {
  int k = 0;
  axis.cwiseAbs().maxCoeff(&k);
  return axis[k] < 0 ? Vec3(-axis) : axis;
}

}  // namespace

PrincipalAxes principal_axes(const Mat3& inertia) {
  Mat3 a = inertia, v = Mat3::Identity();
  a(0, 1) = a(1, 0);
  a(0, 2) = a(2, 0);
  a(1, 2) = a(2, 1);
  // Convergence is quadratic; 16 sweeps are far more than needed.
  for (int sweep = 0; sweep < 16; ++sweep) {
    const double off = std::fabs(a(1, 0)) + std::fabs(a(2, 0)) + std::fabs(a(2, 1));
    if (!(off > 0)) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return a(i, i) < a(j, j); });

  PrincipalAxes out;
  for (int k = 0; k < 3; ++k) out.moments[k] = a(order[size_t(k)], order[size_t(k)]);
  out.axes.col(0) = with_positive_largest(v.col(order[0]).normalized());
  Vec3 second = v.col(order[1]);
  second -= out.axes.col(0).dot(second) * out.axes.col(0);
  out.axes.col(1) = with_positive_largest(second.normalized());
  out.axes.col(2) = out.axes.col(0).cross(out.axes.col(1)).normalized();
  out.rotation = Quat(out.axes).normalized();
  if (out.rotation.w() < 0) out.rotation.coeffs() *= -1;
  return out;
}

}  // namespace tumble
