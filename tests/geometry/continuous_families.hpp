#pragma once
#include "engine/geometry/continuous_tests/edge_edge.hpp"
#include "engine/geometry/continuous_tests/vertex_face.hpp"
#include "tests/geometry/draws.hpp"

#include <array>
#include <cmath>
#include <string>

/// Queries of the continuous tests, by family; shared with the benchmark.
namespace tumble::continuous {

/// Vertex 0 and face 1 2 3, or edges 0 1 and 2 3.
struct Query {
  bool edges = false;
  std::array<MovingPoint, 4> p;

  MovingEdge first() const { return {p[0], p[1]}; }
  MovingEdge second() const { return {p[2], p[3]}; }
  MovingTriangle face() const { return {p[1], p[2], p[3]}; }
  std::optional<MovingContact> answer(double separation = 0) const {
    return edges ? edge_edge_contact(first(), second(), separation).value()
                 : vertex_face_contact(p[0], face(), separation).value();
  }
};

/// Weights of the four points in the difference of a point of B from one of A; they sum to 0.
inline Vec4 place(bool edges, double s, double t) {
  return edges ? Vec4(s - 1, -s, 1 - t, t) : Vec4(-1, 1 - s - t, s, t);
}

/// Points and displacements in (-1, 1)^3.
inline Query random_query(Random& r, bool edges) {
  Query q;
  q.edges = edges;
  for (MovingPoint& p : q.p) {
    p.start = draws::in_box(r, 1);
    p.end = p.start + draws::in_box(r, 1);
  }
  return q;
}

/// Features that meet at t = .5 +- .05 at a place drawn by `weight`, displacements up to `reach`.
/// With `graze` they meet without crossing: the cubic has a double root there. Then B is shifted by
/// `miss` along the normal.
inline Query meeting_query(Random& r, bool edges, double reach, bool graze, double miss, double s,
                           double t) {
  Query q;
  q.edges = edges;
  const double when = 0.5 + r.uniform(-0.05, 0.05);
  std::array<Vec3, 4> at, way;
  for (size_t i = 0; i < 4; ++i) at[i] = draws::in_box(r, 1), way[i] = draws::in_box(r, reach);
  const Vec4 w = place(edges, s, t);
  const auto difference = [&](const std::array<Vec3, 4>& x) {
    Vec3 out = Vec3::Zero();
    for (size_t i = 0; i < 4; ++i) out += w[int(i)] * x[i];
    return out;
  };
  const size_t moved = edges ? 2 : 1;  // B from this point on
  const Vec3 gap = difference(at);
  for (size_t i = moved; i < 4; ++i) at[i] -= gap;
  const Vec3 n = (edges ? Vec3((at[1] - at[0]).cross(at[3] - at[2]))
                        : Vec3((at[2] - at[1]).cross(at[3] - at[1])))
                     .normalized();
  if (graze) {
    const double speed = difference(way).dot(n);
    for (size_t i = moved; i < 4; ++i) way[i] -= speed * n;
  }
  for (size_t i = 0; i < 4; ++i) {
    if (i >= moved) at[i] += miss * n;
    q.p[i] = {at[i] - when * way[i], at[i] + (1 - when) * way[i]};
  }
  return q;
}

inline Query near_query(Random& r, bool edges) {
  double s = r.uniform(), t = r.uniform();
  if (!edges && s + t > 1) s = 1 - s, t = 1 - t;
  return meeting_query(r, edges, 0.05, false, 0, s, t);
}

/// 10^-1 ... 10^-17, either sign, or nothing.
inline double tiny(Random& r) {
  const double x = r.below(8) ? std::pow(10.0, -1 - double(r.below(17))) : 0;
  return r.below(2) ? x : -x;
}

constexpr int hostile_families = 12;
inline const char* hostile_name(int family) {
  static const char* names[hostile_families] = {"lattice",
                                                "lattice in a plane",
                                                "grazing",
                                                "grazing, slow",
                                                "at a border",
                                                "grazing a border",
                                                "thin",
                                                "in a plane",
                                                "shared corners",
                                                "at rest",
                                                "starts or ends in contact",
                                                "mixed magnitudes"};
  return names[family];
}

inline Query hostile_query(Random& r, int family, bool edges) {
  const auto lattice = [&](int half) {
    const auto c = [&] { return double(int(r.below(uint32_t(2 * half + 1))) - half); };
    const double x = c(), y = c(), z = c();
    return Vec3(x, y, z);
  };
  const auto inside = [&](double& s, double& t) {
    s = r.uniform(), t = r.uniform();
    if (!edges && s + t > 1) s = 1 - s, t = 1 - t;
  };
  const auto border = [&](double& s, double& t) {
    inside(s, t);
    const uint32_t k = r.below(4);
    if (k == 0) s = 0;
    if (k == 1) t = 0;
    if (k == 2) s = edges ? 1 : 1 - t;
    if (k == 3) s = 0, t = r.below(2) ? 0 : 1;
  };
  double s, t;
  Query q;
  q.edges = edges;
  switch (family) {
    case 0:
    case 1: {
      const int half = 1 + int(r.below(3));
      for (MovingPoint& p : q.p) p = {lattice(half), lattice(half)};
      if (family == 1) {
        for (MovingPoint& p : q.p) p.start.z() = p.end.z() = 0;
      }
      break;
    }
    case 2:
      inside(s, t);
      return meeting_query(r, edges, 1, true, tiny(r), s, t);
    case 3:
      inside(s, t);
      return meeting_query(r, edges, 1e-3, true, tiny(r), s, t);
    case 4: {
      border(s, t);
      q = meeting_query(r, edges, 0.5, false, 0, s, t);
      const Vec3 off = tiny(r) * draws::direction(r);
      q.p[0].start += off, q.p[0].end += off;
      return q;
    }
    case 5:
      border(s, t);
      return meeting_query(r, edges, 0.5, true, tiny(r), s, t);
    case 6: {  // needles
      inside(s, t);
      q = meeting_query(r, edges, 0.3, r.below(2) != 0, r.below(2) ? tiny(r) : 0, s, t);
      const double width = std::fabs(tiny(r));
      for (const size_t from : {size_t(1), size_t(2)}) {
        const MovingPoint& base = q.p[from];
        MovingPoint& p = q.p[3];
        const double along = r.uniform(-1, 1);
        if (r.below(2)) {
          p.start =
              base.start + along * (q.p[2].start - q.p[1].start) + width * draws::in_box(r, 1);
          p.end = base.end + along * (q.p[2].end - q.p[1].end) + width * draws::in_box(r, 1);
        }
      }
      break;
    }
    case 7:
      q = random_query(r, edges);
      for (MovingPoint& p : q.p) p.start.z() = p.end.z() = 0.25;
      break;
    case 8: {
      q = random_query(r, edges);
      const size_t other = edges ? 2 + r.below(2) : 1 + r.below(3);
      const size_t mine = edges ? r.below(2) : 0;
      if (r.below(2)) q.p[mine].start = q.p[other].start;
      if (r.below(2)) q.p[mine].end = q.p[other].end;
      if (r.below(4) == 0) q.p[3] = q.p[2];
      break;
    }
    case 9:
      q = random_query(r, edges);
      for (MovingPoint& p : q.p) p.end = p.start;
      if (r.below(2)) q.p[0] = near_query(r, edges).p[0];
      break;
    case 10: {
      inside(s, t);
      q = meeting_query(r, edges, 0.5, r.below(2) != 0, tiny(r) * 1e-6, s, t);
      for (MovingPoint& p : q.p) {
        const Vec3 middle = p.at(0.5);
        (r.below(2) ? p.start : p.end) = middle;
        if (r.below(2)) (p.start == middle ? p.end : p.start) = middle + 0.5 * draws::in_box(r, 1);
      }
      break;
    }
    default: {
      q = r.below(2) ? near_query(r, edges) : random_query(r, edges);
      for (MovingPoint& p : q.p) {
        for (int k = 0; k < 3; ++k) {
          p.start[k] *= std::pow(10.0, -double(r.below(18)));
          p.end[k] *= std::pow(10.0, -double(r.below(18)));
        }
      }
    }
  }
  return q;
}

/// Any magnitude from 1e-12 to 1e12, at the origin or far from it. The corners are rounded; what
/// the query then means is for the reference to say.
inline void rescale(Random& r, Query& q) {
  const uint32_t kind = r.below(4);
  if (kind == 0) return;
  const double factor = std::pow(10.0, double(int(r.below(25)) - 12));
  const Vec3 away =
      kind == 1 ? std::pow(10.0, double(r.below(8))) * factor * draws::in_box(r, 1) : Vec3::Zero();
  for (MovingPoint& p : q.p) p = {factor * p.start + away, factor * p.end + away};
}

/// Greatest distance of two points at either end.
inline double size_of(const Query& q) {
  double out = 0;
  for (const MovingPoint& a : q.p) {
    for (const MovingPoint& b : q.p) {
      out = std::max({out, (a.start - b.start).norm(), (a.end - b.end).norm()});
    }
  }
  return out;
}

}  // namespace tumble::continuous
