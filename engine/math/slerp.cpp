#include "engine/math/slerp.hpp"

#include "engine/math/det/det.hpp"

namespace tumble {

Quat slerp(const Quat& a, const Quat& b, double s) {
  const Vec4 from = a.coeffs(), to = a.dot(b) < 0 ? -b.coeffs() : b.coeffs();
  // From the half angles' tangent: exact at all angles, where the arc cosine loses half the digits
  // at small ones.
  const double angle = 2 * det::atan2((to - from).norm(), (to + from).norm());
  const double sine = det::sin(angle);
  Vec4 out;
  if (sine > 0) {
    out = from * (det::sin((1 - s) * angle) / sine) + to * (det::sin(s * angle) / sine);
  } else {
    out = from + s * (to - from);
  }
  return Quat(Vec4(out / out.norm()));
}

Pose slerp(const Pose& a, const Pose& b, double s) {
  return {a.x + s * (b.x - a.x), slerp(a.q, b.q, s)};
}

}  // namespace tumble
