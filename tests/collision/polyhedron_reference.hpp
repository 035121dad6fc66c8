#pragma once
#include "engine/collision/v_clip/v_clip.hpp"

#include <algorithm>
#include <cmath>

/// Distance of two polyhedra in extended precision, by brute force over all pairs of features.
namespace tumble::test {

using Real = long double;
using Real3 = Vector3<Real>;

struct ReferenceDistance {
  Real distance = 0;  ///< of the surfaces; 0 when they cross or the solids overlap
  Real overlap = 0;  ///< least width across a face normal or a pair of edges; > 0 when they overlap
};

inline Real3 wide(const Vec3& v) {
  return v.cast<Real>();
}

/// Squared distance of two segments: the ends against the other segment, and the lines where their
/// nearest points are inside both.
inline Real squared_distance(const Real3& a, const Real3& b, const Real3& c, const Real3& d) {
  const auto to_segment = [](const Real3& p, const Real3& s, const Real3& e) {
    const Real3 u = e - s;
    const Real t = std::clamp(u.dot(p - s) / u.squaredNorm(), Real(0), Real(1));
    return (p - s - t * u).squaredNorm();
  };
  Real best = std::min(
      {to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Real3 u = b - a, v = d - c, w = c - a, n = u.cross(v);
  const Real nn = n.squaredNorm();
  if (nn > 0) {
    const Real s = std::clamp(w.cross(v).dot(n) / nn, Real(0), Real(1));
    best = std::min(best, to_segment(Real3(a + s * u), c, d));
    const Real t = std::clamp(v.dot(s * u - w) / v.squaredNorm(), Real(0), Real(1));
    best = std::min(best, to_segment(Real3(c + t * v), a, b));
  }
  return best;
}

class ReferencePair {
 public:
  ReferencePair(const VoronoiPolyhedron& A, const Pose& pa, const VoronoiPolyhedron& B,
                const Pose& pb) {
    place(0, A, pa, pa.x);
    place(1, B, pb, pa.x);
    planes(0);
    planes(1);
  }

  ReferenceDistance distance() const {
    ReferenceDistance out;
    out.overlap = least_width();
    if (out.overlap >= 0) return out;
    Real best = std::numeric_limits<Real>::infinity();
    for (const VoronoiEdge& e : model_[0]->edges)
      for (const VoronoiEdge& f : model_[1]->edges) best = std::min(best, squared_edges(e, f));
    best = std::sqrt(best);
    for (size_t k = 0; k < 2; ++k)
      for (const Real3& p : vertices_[k])
        for (size_t f = 0; f < normals_[1 - k].size(); ++f)
          best = std::min(best, over(p, 1 - k, f));
    out.distance = best;
    return out;
  }

  /// Distance of two features, any kinds but two faces.
  Real between(const ClosestFeatures& x) const {
    const auto edge = [&](size_t k) { return model_[k]->edges[x[k].index]; };
    for (size_t k = 0; k < 2; ++k) {
      if (x[k].kind == FeatureKind::face)
        return from_face(vertices_[1 - k][x[1 - k].index], k, x[k].index);
    }
    std::array<std::array<Real3, 2>, 2> ends;
    for (size_t k = 0; k < 2; ++k) {
      const bool vertex = x[k].kind == FeatureKind::vertex;
      for (size_t i = 0; i < 2; ++i)
        ends[k][i] = vertices_[k][vertex ? x[k].index : edge(k).vertices[i]];
    }
    const bool v0 = x[0].kind == FeatureKind::vertex, v1 = x[1].kind == FeatureKind::vertex;
    if (v0 && v1) return (ends[0][0] - ends[1][0]).norm();
    const auto to_segment = [](const Real3& p, const std::array<Real3, 2>& s) {
      const Real3 u = s[1] - s[0];
      const Real t = std::clamp(u.dot(p - s[0]) / u.squaredNorm(), Real(0), Real(1));
      return (p - s[0] - t * u).norm();
    };
    if (v0) return to_segment(ends[0][0], ends[1]);
    if (v1) return to_segment(ends[1][0], ends[0]);
    return std::sqrt(squared_distance(ends[0][0], ends[0][1], ends[1][0], ends[1][1]));
  }

  /// Distance of a point (relative to A's origin) from a feature of side k.
  Real from_feature(const Vec3& point, size_t k, const PolyhedronFeature& x) const {
    const Real3 p = wide(point);
    if (x.kind == FeatureKind::vertex) return (p - vertices_[k][x.index]).norm();
    if (x.kind == FeatureKind::edge) {
      const VoronoiEdge& e = model_[k]->edges[x.index];
      const Real3 a = vertices_[k][e.vertices[0]], u = vertices_[k][e.vertices[1]] - a;
      const Real t = std::clamp(u.dot(p - a) / u.squaredNorm(), Real(0), Real(1));
      return (p - a - t * u).norm();
    }
    Real outside = std::abs(normals_[k][x.index].dot(p) - offsets_[k][x.index]);
    for (const auto& [inward, offset] : sides_[k][x.index])
      outside = std::max(outside, offset - inward.dot(p));
    return outside;
  }

 private:
  using HalfPlane = std::pair<Real3, Real>;

  void place(size_t k, const VoronoiPolyhedron& m, const Pose& pose, const Vec3& origin) {
    model_[k] = &m;
    const Matrix3<Real> R = pose.q.cast<Real>().normalized().toRotationMatrix();
    const Real3 x = wide(pose.x) - wide(origin);
    for (const Vec3& v : m.vertices) vertices_[k].push_back(x + R * wide(v));
    for (const Vec3& v : {m.centre}) centre_[k] = x + R * wide(v);
  }

  void planes(size_t k) {
    for (const VoronoiFace& f : model_[k]->faces) {
      Real3 n = Real3::Zero();
      std::vector<Real3> loop;
      for (const VoronoiSide& s : model_[k]->sides_of(f)) {
        const VoronoiEdge& e = model_[k]->edges[s.edge];
        const bool forward = &f - model_[k]->faces.data() == std::ptrdiff_t(e.faces[0]);
        loop.push_back(vertices_[k][e.vertices[forward ? 0 : 1]]);
      }
      for (size_t i = 1; i + 1 < loop.size(); ++i)
        n += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
      n.normalize();
      Real offset = n.dot(loop[0]);
      for (const Real3& p : loop) offset = std::max(offset, n.dot(p));
      normals_[k].push_back(n);
      offsets_[k].push_back(offset);
      auto& sides = sides_[k].emplace_back();
      for (size_t i = 0; i < loop.size(); ++i) {
        const Real3 inward = n.cross(loop[(i + 1) % loop.size()] - loop[i]).normalized();
        sides.push_back({inward, inward.dot(loop[i])});
      }
    }
  }

  Real squared_edges(const VoronoiEdge& e, const VoronoiEdge& f) const {
    return squared_distance(vertices_[0][e.vertices[0]], vertices_[0][e.vertices[1]],
                            vertices_[1][f.vertices[0]], vertices_[1][f.vertices[1]]);
  }

  /// Height of p over face f of side k; infinite when p is not over it.
  Real over(const Real3& p, size_t k, size_t f) const {
    for (const auto& [inward, offset] : sides_[k][f])
      if (inward.dot(p) < offset - 1e-15L) return std::numeric_limits<Real>::infinity();
    return std::abs(normals_[k][f].dot(p) - offsets_[k][f]);
  }

  Real from_face(const Real3& p, size_t k, size_t f) const {
    Real best = over(p, k, f);
    for (const VoronoiSide& s : model_[k]->sides_of(model_[k]->faces[f])) {
      const auto& ends = model_[k]->edges[s.edge].vertices;
      const Real3 a = vertices_[k][ends[0]], u = vertices_[k][ends[1]] - a;
      const Real t = std::clamp(u.dot(p - a) / u.squaredNorm(), Real(0), Real(1));
      best = std::min(best, (p - a - t * u).norm());
    }
    return best;
  }

  Real width(const Real3& n) const {
    Real a = -std::numeric_limits<Real>::infinity(), b = -a;
    for (const Real3& p : vertices_[0]) a = std::max(a, n.dot(p));
    for (const Real3& p : vertices_[1]) b = std::min(b, n.dot(p));
    return a - b;
  }

  /// Negative when some plane parts them: then the distance is at least minus that.
  Real least_width() const {
    Real least = std::numeric_limits<Real>::infinity();
    const auto offer = [&](const Real3& n) { least = std::min(least, width(n)); };
    for (const Real3& n : normals_[0]) offer(n);
    for (const Real3& n : normals_[1]) offer(-n);
    for (const VoronoiEdge& e : model_[0]->edges) {
      if (least < 0) break;
      const Real3 u = vertices_[0][e.vertices[1]] - vertices_[0][e.vertices[0]];
      for (const VoronoiEdge& f : model_[1]->edges) {
        const Real3 v = vertices_[1][f.vertices[1]] - vertices_[1][f.vertices[0]];
        const Real3 n = u.cross(v);
        const Real length = n.norm();
        if (length <= 1e-17L * u.norm() * v.norm()) continue;
        offer(n / length);
        offer(-n / length);
      }
    }
    return least;
  }

  std::array<const VoronoiPolyhedron*, 2> model_;
  std::array<std::vector<Real3>, 2> vertices_;
  std::array<Real3, 2> centre_;
  std::array<std::vector<Real3>, 2> normals_;
  std::array<std::vector<Real>, 2> offsets_;
  std::array<std::vector<std::vector<HalfPlane>>, 2> sides_;
};

}  // namespace tumble::test
