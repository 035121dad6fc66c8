#include "engine/collision/v_clip/clip_edge.hpp"

#include <algorithm>

namespace tumble::vclip {

SegmentsNearest nearest_of_segments(const Vec3& a, const Vec3& u, double length_a, const Vec3& b,
                                    const Vec3& v, double length_b) {
  SegmentsNearest best;
  double least = std::numeric_limits<double>::infinity();
  const Vec3 w = b - a;
  const auto offer = [&](double s, double t) {
    const Vec3 gap = w + t * v - s * u;
    const double squared = gap.squaredNorm();
    if (!(squared < least)) return;
    least = squared;
    best = {s, t, gap};
  };
  const auto on_a = [&](double t) { return std::clamp(u.dot(w + t * v), 0.0, length_a); };
  const auto on_b = [&](double s) { return std::clamp(v.dot(s * u - w), 0.0, length_b); };
  offer(0, on_b(0));
  offer(length_a, on_b(length_a));
  offer(on_a(0), 0);
  offer(on_a(length_b), length_b);
  // The cross product keeps the digits that 1 - (u.v)^2 loses for lines almost parallel. Projecting
  // the point once to and fro removes what is left of its error.
  const Vec3 n = u.cross(v);
  const double nn = n.squaredNorm();
  if (nn > 0) {
    const double s = std::clamp(w.cross(v).dot(n) / nn, 0.0, length_a);
    const double t = on_b(s);
    offer(on_a(t), t);
  }
  return best;
}

}  // namespace tumble::vclip
