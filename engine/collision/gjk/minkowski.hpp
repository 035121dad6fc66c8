#pragma once
#include "engine/collision/gjk/padded_pose.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// A core placed in the frame of a query: world axes, with an origin near the pair, so that
/// distances lose no accuracy far from the world's origin.
struct PlacedCore {
  const ConvexCore* core = nullptr;
  Mat3 R = Mat3::Identity();
  Vec3 x = Vec3::Zero();

  PlacedCore() = default;
  PlacedCore(const ConvexCore& c, const Quat& q, const Vec3& origin)
      : PlacedCore(c, q.toRotationMatrix(), origin) {}
  PlacedCore(const ConvexCore& c, const Mat3& rotation, const Vec3& origin)
      : core(&c), R(rotation), x(origin) {}

  Vec3 support(const Vec3& d) const { return x + R * core->support(R.transpose() * d); }
  Vec3 centre() const { return x + R * core->centre(); }
  /// The supporting face, mapped to the frame of the query.
  void supporting_face(const Vec3& d, SupportingFace& face) const {
    core->supporting_face(R.transpose() * d, face);
    for (int i = 0; i < face.count; ++i) {
      Vec3& p = face.points[size_t(i)];
      p = x + R * p;
    }
  }
};

/// A point of the Minkowski difference A - B, with the points of A and B that it is the difference
/// of, all in A's frame, and the indices of their vertices (no_core_vertex for curved cores).
struct DifferencePoint {
  Plain3 w, a, b;
  uint32_t vertex_a, vertex_b;
};

/// The difference of two cores in A's frame. Each vertex of B is rounded once when it is
/// transformed to it (4e-16 of `scale`); after that the points of the difference count as exact.
class Difference {
 public:
  template <class Scan = ScanByTwo>
  Difference(const PlacedCore& A, const PlacedCore& B, Scan = {});
  Difference(const Difference&) = delete;
  Difference& operator=(const Difference&) = delete;

  /// The support point along d (any length), up to the rounding of its height.
  DifferencePoint support(const Plain3& d) const { return support_against<ScanByTwo>(-d); }
  /// The support point along -n.
  template <class Scan>
  DifferencePoint support_against(const Plain3& n) const {
    Plain3 a, b;
    uint32_t vertex_a, vertex_b;
    if (both_few_) {
      Scan::opposite_few(a_.view.vertices, few_, n, vertex_a, vertex_b);
      a = a_.view.vertices[vertex_a];
      b = few_[vertex_b];
    } else {
      a = a_.support<Scan>(-n, vertex_a);
      if (few_.padded > 0)
        b = few_[vertex_b = Scan::few(few_, n)];
      else
        b = from_b(b_.support<Scan>(relative_.back(n), vertex_b));
    }
    return {a - b, a, b, vertex_a, vertex_b};
  }
  /// Whether both cores are convex hulls of points.
  bool always_polyhedral() const {
    return a_.view.kind != CoreView::Kind::general && b_.view.kind != CoreView::Kind::general;
  }
  /// The point made of two vertices of an earlier query; false if there are no such vertices.
  bool recall(uint32_t vertex_a, uint32_t vertex_b, DifferencePoint& p) const;

  /// From B's centre to A's.
  Plain3 centre() const { return Plain3::of(a_.view.centre) - from_b(Plain3::of(b_.view.centre)); }
  /// Upper bound of all coordinates: both reaches and the distance of the origins [m].
  double scale() const { return scale_; }
  /// Directions and points from the frame of the query to A's frame, and back.
  Vec3 direction_out(const Plain3& d) const { return A_.R * d.vec(); }
  Vec3 point_out(const Plain3& p) const { return A_.x + A_.R * p.vec(); }
  Plain3 direction_in(const Vec3& d) const { return Plain3::of(A_.R.transpose() * d); }

 private:
  struct Side {
    const ConvexCore* core;
    const CoreView& view;

    explicit Side(const ConvexCore& c) : core(&c), view(c.view()) {}
    template <class Scan>
    Plain3 support(const Plain3& d, uint32_t& vertex) const;
    bool vertex(uint32_t k, Plain3& p) const;
  };
  Plain3 from_b(const Plain3& p) const { return relative_ * p; }

  const PlacedCore& A_;
  Side a_, b_;
  PaddedPose relative_;
  double scale_;
  /// If B has at most eight vertices, they are transformed to A's frame once.
  static constexpr uint32_t most_few = 8;
  alignas(32) std::array<double, 3 * most_few> few_coordinates_;
  VertexCloudView few_;
  bool both_few_ = false;
};

/// Vertex index of points on curved cores.
constexpr uint32_t no_core_vertex = std::numeric_limits<uint32_t>::max();

template <class Scan>
Difference::Difference(const PlacedCore& A, const PlacedCore& B, Scan)
    : A_(A), a_(*A.core), b_(*B.core) {
  relative_.set<Scan>(A.R, B.R, {B.x.x() - A.x.x(), B.x.y() - A.x.y(), B.x.z() - A.x.z()});
  scale_ = a_.view.reach + b_.view.reach + std::sqrt(relative_.shift().squared());
  const VertexCloudView& v = b_.view.vertices;
  if (b_.view.kind != CoreView::Kind::vertices || v.padded > most_few) return;
  double* out = few_coordinates_.data();
  few_ = {out, out + most_few, out + 2 * most_few, v.padded, nullptr};
  both_few_ = a_.view.kind == CoreView::Kind::vertices && a_.view.vertices.padded <= few_vertices;
  Scan::turn(v, relative_.row(0), relative_.column[3][0], out);  // the same operations as from_b()
  Scan::turn(v, relative_.row(1), relative_.column[3][1], out + most_few);
  Scan::turn(v, relative_.row(2), relative_.column[3][2], out + 2 * most_few);
}

inline bool Difference::Side::vertex(uint32_t k, Plain3& p) const {
  if (view.kind == CoreView::Kind::box && k < 8) {
    const Vec3& h = view.half;
    p = {k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z()};
    return true;
  }
  if (view.kind != CoreView::Kind::vertices || k >= view.vertices.padded) return false;
  p = view.vertices[k];
  return true;
}

inline bool Difference::recall(uint32_t vertex_a, uint32_t vertex_b, DifferencePoint& p) const {
  Plain3 b;
  if (!a_.vertex(vertex_a, p.a) || !b_.vertex(vertex_b, b)) return false;
  p.b = from_b(b);
  p.w = p.a - p.b;
  p.vertex_a = vertex_a;
  p.vertex_b = vertex_b;
  return true;
}

template <class Scan>
Plain3 Difference::Side::support(const Plain3& d, uint32_t& vertex) const {
  if (view.kind == CoreView::Kind::vertices) {
    const VertexCloudView& v = view.vertices;
    vertex = v.padded <= few_vertices ? Scan::few(v, d)
             : v.table                ? v.table->furthest(d)
                                      : Scan::many(v, d);
    return v[vertex];
  }
  if (view.kind == CoreView::Kind::box) {
    const Vec3& h = view.half;
    vertex = uint32_t(d.x >= 0 && h.x() > 0) | uint32_t(d.y >= 0 && h.y() > 0) << 1 |
             uint32_t(d.z >= 0 && h.z() > 0) << 2;
    return {d.x >= 0 ? h.x() : -h.x(), d.y >= 0 ? h.y() : -h.y(), d.z >= 0 ? h.z() : -h.z()};
  }
  vertex = no_core_vertex;
  return Plain3::of(core->support(d.vec()));
}

}  // namespace tumble
