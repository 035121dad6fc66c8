#pragma once
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "tests/collision/support.hpp"

#include <limits>
#include <optional>

namespace tumble::test {

inline std::vector<Manifold> run(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb,
                                 double margin) {
  std::vector<Manifold> out;
  collide(a, pa, b, pb, margin, out);
  return out;
}

/// How far apart a pair is said to be at least (ContactQuery::apart) where it has no contact.
inline std::optional<double> said_apart(NarrowPhase narrow_phase, const Shape& a, const Pose& pa,
                                        const Shape& b, const Pose& pb, double margin) {
  std::vector<Manifold> found;
  double said = -1;
  ContactQuery query(margin);
  query.apart = &said;
  narrow_phase(a, pa, b, pb, query, found);
  if (!found.empty()) return std::nullopt;
  return said;
}

/// Least gap of all points; infinite without contact.
inline double least_gap(const std::vector<Manifold>& list) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Manifold& m : list)
    for (int i = 0; i < m.count; ++i) gap = std::min(gap, m.points[size_t(i)].gap);
  return gap;
}

/// How far shape s at pose p reaches along unit n.
inline double reach(const ConvexShape& s, const Pose& p, const Vec3& n) {
  const Vec3 d = p.inverse_direction(n);
  return n.dot(p.x) + d.dot(s.support(d)) + s.rounding();
}

}  // namespace tumble::test
