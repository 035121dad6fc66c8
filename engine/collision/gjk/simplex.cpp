#include "engine/collision/gjk/simplex.hpp"

#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Which corners carry the nearest point, and with what weights.
struct Side {
  std::array<int, 3> corner{};
  std::array<double, 3> weight{};
  int count = 0;
  double squared = std::numeric_limits<double>::infinity();
};

using Corners = std::array<DifferencePoint, 4>;

void finish(Side& s, const Corners& c) {
  Vec3 v = s.weight[0] * c[size_t(s.corner[0])].w;
  for (size_t i = 1; i < size_t(s.count); ++i) v += s.weight[i] * c[size_t(s.corner[i])].w;
  s.squared = v.squaredNorm();
}

Side nearest_on_segment(const Corners& c, int i, int j) {
  const Vec3 &a = c[size_t(i)].w, &b = c[size_t(j)].w;
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm(), from_a = -a.dot(d), from_b = b.dot(d);
  Side s;
  if (!(length2 > 0) || from_a <= 0) {
    s.corner[0] = i, s.weight[0] = 1, s.count = 1;
  } else if (from_b <= 0) {
    s.corner[0] = j, s.weight[0] = 1, s.count = 1;
  } else {
    const double t = from_a / length2;
    s.corner = {i, j, 0}, s.weight = {1 - t, t, 0}, s.count = 2;
  }
  finish(s, c);
  return s;
}

void keep_nearer(Side& best, const Side& other) {
  if (other.squared < best.squared) best = other;
}

Side nearest_on_triangle(const Corners& c, int i, int j, int k) {
  const Vec3 &p = c[size_t(i)].w, &q = c[size_t(j)].w, &r = c[size_t(k)].w;
  // the normal from the two shorter sides loses the fewest digits
  const Vec3 pq = q - p, qr = r - q, rp = p - r;
  const double lpq = pq.squaredNorm(), lqr = qr.squaredNorm(), lrp = rp.squaredNorm();
  Vec3 n;
  if (lpq >= lqr && lpq >= lrp)
    n = qr.cross(rp);
  else if (lqr >= lrp)
    n = rp.cross(pq);
  else
    n = pq.cross(qr);
  const double n2 = n.squaredNorm();
  std::array<double, 3> area{-1, -1, -1};
  if (n2 > 0) {
    const Vec3 o = n * (p.dot(n) / n2);  // the origin projected on the plane
    int axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double sign = n[axis] > 0 ? 1 : -1;
    const auto cross = [&](const Vec3& a, const Vec3& b) {
      return sign * ((a[u] - o[u]) * (b[v] - o[v]) - (a[v] - o[v]) * (b[u] - o[u]));
    };
    area = {cross(q, r), cross(r, p), cross(p, q)};
  }
  if (area[0] > 0 && area[1] > 0 && area[2] > 0) {
    const double sum = area[0] + area[1] + area[2];
    Side s;
    s.corner = {i, j, k}, s.count = 3;
    s.weight = {area[0] / sum, area[1] / sum, area[2] / sum};
    finish(s, c);
    return s;
  }
  Side best;
  if (area[0] <= 0) keep_nearer(best, nearest_on_segment(c, j, k));
  if (area[1] <= 0) keep_nearer(best, nearest_on_segment(c, k, i));
  if (area[2] <= 0) keep_nearer(best, nearest_on_segment(c, i, j));
  return best;
}

double det(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

/// True with weights when the origin is inside; otherwise the nearest side.
bool nearest_on_tetrahedron(const Corners& c, std::array<double, 4>& weight, Side& best) {
  const Vec3 &p = c[0].w, &q = c[1].w, &r = c[2].w, &s = c[3].w;
  const double volume = det(q - p, r - p, s - p);
  const double size = std::max({(q - p).norm(), (r - p).norm(), (s - p).norm()});
  const std::array<double, 4> part{det(q, r, s), -det(p, r, s), det(p, q, s), -det(p, q, r)};
  const double doubt = 1e-15 * size * size * size;
  static constexpr int opposite[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  bool inside = std::abs(volume) > doubt;
  for (double x : part) inside = inside && x != 0 && (x > 0) == (volume > 0);
  if (inside) {
    for (size_t i = 0; i < 4; ++i) weight[i] = part[i] / volume;
    return true;
  }
  for (size_t i = 0; i < 4; ++i) {
    const bool same = (part[i] > 0) == (volume > 0) && std::abs(part[i]) > doubt;
    if (same && std::abs(volume) > doubt) continue;
    keep_nearer(best, nearest_on_triangle(c, opposite[i][0], opposite[i][1], opposite[i][2]));
  }
  return false;
}

void keep(Simplex& simplex, const Side& side) {
  const Corners old = simplex.points;
  for (size_t i = 0; i < size_t(side.count); ++i) {
    simplex.points[i] = old[size_t(side.corner[i])];
    simplex.weights[i] = side.weight[i];
  }
  simplex.count = side.count;
}

}  // namespace

bool reduce(Simplex& simplex) {
  switch (simplex.count) {
    case 1:
      simplex.weights[0] = 1;
      return false;
    case 2:
      keep(simplex, nearest_on_segment(simplex.points, 0, 1));
      return false;
    case 3:
      keep(simplex, nearest_on_triangle(simplex.points, 0, 1, 2));
      return false;
    default:
      break;
  }
  Side side;
  if (nearest_on_tetrahedron(simplex.points, simplex.weights, side)) return true;
  keep(simplex, side);
  return false;
}

}  // namespace tumble
