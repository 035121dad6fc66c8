#pragma once
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/math/triple.hpp"

namespace tumble {

/// A core placed in the frame of a query (world axes, any origin near the pair, so that distances
/// do not lose digits far from the world's origin).
struct PlacedCore {
  const ConvexCore* core = nullptr;
  Mat3 R = Mat3::Identity();
  Vec3 x = Vec3::Zero();

  PlacedCore() = default;
  PlacedCore(const ConvexCore& c, const Quat& q, const Vec3& origin)
      : core(&c), R(q.toRotationMatrix()), x(origin) {}

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

/// A point of the Minkowski difference A - B, with the points of A and B that make it, all in A's
/// own frame, and the numbers of their vertices (curved cores have none).
struct DifferencePoint {
  Plain3 w, a, b;
  uint32_t vertex_a, vertex_b;
};

/// The difference of two cores in A's own frame. Each vertex of B is rounded once on its way there
/// (4e-16 of `scale`); from then on points of the difference count as exact.
class Difference {
 public:
  Difference(const PlacedCore& A, const PlacedCore& B);
  Difference(const Difference&) = delete;
  Difference& operator=(const Difference&) = delete;

  /// The point furthest along d (any length), up to the rounding of its height.
  [[gnu::always_inline]] inline void support(const Plain3& d, DifferencePoint& p) {
    p.a = a_.support(d, p.vertex_a);
    if (few_.padded > 0)
      p.b = few_[p.vertex_b = scan_few_vertices(few_, -d)];
    else
      p.b = from_b(b_.support(-R_.back(d), p.vertex_b));
    p.w = p.a - p.b;
  }
  /// Whether both cores are hulls of points.
  bool always_polyhedral() const {
    return a_.view.kind != CoreView::Kind::general && b_.view.kind != CoreView::Kind::general;
  }
  /// The point made by two vertices of an earlier query; false when there are none such.
  bool recall(uint32_t vertex_a, uint32_t vertex_b, DifferencePoint& p) const;

  /// From B's centre to A's.
  Plain3 centre() const { return Plain3::of(a_.view.centre) - from_b(Plain3::of(b_.view.centre)); }
  /// A length that all coordinates stay below: both reaches and the distance of the origins [m].
  double scale() const { return scale_; }
  /// Directions and points from and to the frame of the query.
  Vec3 direction_out(const Plain3& d) const { return (A_.R * d.vec()).eval(); }
  Vec3 point_out(const Plain3& p) const { return A_.x + A_.R * p.vec(); }
  Plain3 direction_in(const Vec3& d) const { return Plain3::of(A_.R.transpose() * d); }

 private:
  struct Side {
    const ConvexCore* core;
    const CoreView& view;

    explicit Side(const ConvexCore& c) : core(&c), view(c.view()) {}
    [[gnu::always_inline]] inline Plain3 support(const Plain3& d, uint32_t& vertex) const;
    bool vertex(uint32_t k, Plain3& p) const;
  };
  void bring_few();
  Plain3 from_b(const Plain3& p) const { return R_ * p + t_; }

  const PlacedCore& A_;
  Side a_, b_;
  PlainRotation R_;
  Plain3 t_;
  double scale_;
  /// Up to eight vertices of B, brought to A's frame at once.
  static constexpr uint32_t most_few = 8;
  alignas(16) std::array<double, 3 * most_few> few_coordinates_;
  VertexCloudView few_;
};

/// Vertex number of points on curved cores.
constexpr uint32_t no_core_vertex = std::numeric_limits<uint32_t>::max();

[[gnu::always_inline]] inline Plain3 Difference::Side::support(const Plain3& d,
                                                               uint32_t& vertex) const {
  if (view.kind == CoreView::Kind::vertices) {
    vertex = furthest_vertex(view.vertices, d);
    return view.vertices[vertex];
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
