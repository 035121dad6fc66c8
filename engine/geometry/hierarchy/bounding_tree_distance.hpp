#pragma once
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/obb_kind.hpp"
#include "engine/geometry/hierarchy/sphere_kind.hpp"

#include <limits>

// The distance of two meshes: nearest volumes first (Quinlan 1994), pruning those farther apart
// than the best pair of triangles.
namespace tumble {

/// Middle and half width of a volume's projection on unit vector n.
struct Shadow {
  float middle, half;
};
inline Shadow shadow(const AabbVolume& v, Float4 n) {
  const CentreBox box(v);
  return {dot3(box.centre, n), dot3(box.half, abs(n))};
}
inline Shadow shadow(const ObbVolume& v, Float4 n) {
  return {dot3(ObbKind::centre(v), n), dot3(ObbKind::half(v), abs(ObbKind::rows(v).combine(n)))};
}
inline Float4 centre_of(const AabbVolume& v) {
  return CentreBox(v).centre;
}
inline Float4 centre_of(const ObbVolume& v) {
  return ObbKind::centre(v).xyz();
}
inline Float4 centre_of(const SphereVolume& v) {
  return Float4::load(v.centre.data()).xyz();
}
inline Shadow shadow(const SphereVolume& v, Float4 n) {
  return {dot3(Float4::load(v.centre.data()), n), v.radius};
}

/// Lower bounds of the distance of two volumes by their projections: on the line of their centres,
/// which is tight for volumes that are small relative to their distance, and on the direction of
/// the best pair of triangles so far, which is the tightest near the result.
class GapDirection {
 public:
  template <class Tree>
  GapDirection(const Tree& a, const Tree& b, const RelativePose& at)
      : at_(at), offset_(at.point(b.origin()) - a.origin()) {
    slack_ = 2 * pair_slack(a, b, offset_, at);
    rows_ = to_rows(at.R);
    columns_ = rows_.transposed();
    offset_a_ = to_float4(offset_);
  }

  void set(const Vec3& unit) {
    on_a_ = to_float4(unit);
    on_b_ = to_float4(at_.R.transpose() * unit);
    apart_ = float(unit.dot(offset_) - slack_);
    known_ = true;
  }
  bool known() const { return known_; }
  /// Lower bound of the squared distance by the line of the centres.
  template <class Volume>
  float squared_gap(const Volume& a, const Volume& b) const {
    const Float4 d = columns_.combine(centre_of(b)) + offset_a_ - centre_of(a);
    const float length = std::sqrt(dot3(d, d));
    if (!(length > 0)) return 0;
    const Float4 n = d * Float4(1 / length);
    const float gap = length - shadow(a, n).half - shadow(b, rows_.combine(n)).half -
                      float(slack_) - 1e-6f * length;
    return gap > 0 ? gap * gap : 0;
  }
  /// Lower bound of the distance.
  template <class Volume>
  float gap(const Volume& a, const Volume& b) const {
    const Shadow sa = shadow(a, on_a_), sb = shadow(b, on_b_);
    return apart_ + (sb.middle - sb.half) - (sa.middle + sa.half);
  }

 private:
  RelativePose at_;
  Vec3 offset_;
  Rows3 rows_, columns_;
  Float4 on_a_, on_b_, offset_a_;
  double slack_;
  float apart_ = 0;
  bool known_ = false;
};

/// The nearest pair so far.
class NearestTriangles {
 public:
  explicit NearestTriangles(double max_distance) : limit_(max_distance * max_distance) {}

  double limit() const { return limit_; }
  /// Unit vector from A to B between the nearest points so far; zero before there are any, or when
  /// they coincide.
  const Vec3& direction() const { return direction_; }
  double distance() const { return distance_; }

  /// Returns true if the pair is the nearest so far.
  bool offer(TriangleIds ids, const TriangleCorners& a, const TriangleCorners& b) {
    if (further_along(a, b) || further_boxes(a, b)) return false;
    const TrianglePair near = closest_triangle_triangle(a, b);
    if (!(near.squared_distance <= limit_)) return false;
    if (found_ && near.squared_distance == limit_ && best_.triangles < ids) return false;
    best_ = {ids, near.on_a, near.on_b, near.squared_distance};
    found_ = true;
    limit_ = near.squared_distance;
    distance_ = std::sqrt(limit_);
    const Vec3 between = near.on_b - near.on_a;
    direction_ = distance_ > 0 ? Vec3(between / distance_) : Vec3(Vec3::Zero());
    return true;
  }

  std::optional<MeshDistance> best() const {
    if (!found_) return std::nullopt;
    return best_;
  }

 private:
  /// Whether projections on direction() are farther apart than the limit, beyond rounding.
  bool further_along(const TriangleCorners& a, const TriangleCorners& b) const {
    const double high =
        std::max({direction_.dot(a[0]), direction_.dot(a[1]), direction_.dot(a[2])});
    const double low = std::min({direction_.dot(b[0]), direction_.dot(b[1]), direction_.dot(b[2])});
    const double rounding = 1e-14 * (a[0].norm() + b[0].norm() + (low - high));
    return low - high > distance_ * (1 + 1e-12) + rounding;
  }

  /// Whether the triangles' boxes are farther apart than the limit, beyond rounding.
  bool further_boxes(const TriangleCorners& a, const TriangleCorners& b) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double low_a = std::min({a[0][k], a[1][k], a[2][k]});
      const double high_a = std::max({a[0][k], a[1][k], a[2][k]});
      const double low_b = std::min({b[0][k], b[1][k], b[2][k]});
      const double high_b = std::max({b[0][k], b[1][k], b[2][k]});
      const double gap = std::max({low_b - high_a, low_a - high_b, 0.0});
      square += gap * gap;
    }
    return square * (1 - 1e-12) > limit_;
  }

  double limit_;
  double distance_ = std::numeric_limits<double>::infinity();
  Vec3 direction_ = Vec3::Zero();
  bool found_ = false;
  MeshDistance best_;
};

template <class Kind>
std::optional<MeshDistance> BoundingTree<Kind>::distance(const Hierarchy& other,
                                                         const Pose& other_pose,
                                                         double max_distance,
                                                         HierarchyStatistics* cost) const {
  return with_same_kind(*this, other, [&](const BoundingTree& tb) -> std::optional<MeshDistance> {
    if (nodes_.empty() || tb.nodes_.empty()) return std::nullopt;
    const RelativePose at(other_pose);
    const typename Kind::template PairTest<false> test(*this, tb, at, 0, Vec3::Zero());
    PairCost counted(cost);
    LeafPair<BoundingTree> leaf(*this, tb, at);
    NearestTriangles nearest(max_distance);
    GapDirection direction(*this, tb, at);

    struct Entry {
      uint32_t a, b;
      float square;
    };
    const auto entry = [&](uint32_t a, uint32_t b) {
      ++counted.work.node_tests;
      const Node &na = nodes_[a], &nb = tb.nodes_[b];
      return Entry{a, b, std::max(test.squared_distance(na, nb), direction.squared_gap(na, nb))};
    };
    std::vector<Entry> stack{entry(0, 0)};
    while (!stack.empty()) {
      const Entry e = stack.back();
      stack.pop_back();
      if (double(e.square) > nearest.limit()) continue;
      const Node &a = nodes_[e.a], &b = tb.nodes_[e.b];
      if (direction.known() && double(direction.gap(a, b)) > nearest.distance()) continue;
      if (a.is_leaf() && b.is_leaf()) {
        leaf.each(
            a, b,
            [&](TriangleIds ids, const TriangleCorners& ta, const TriangleCorners& other_corners) {
              ++counted.work.triangle_tests;
              if (nearest.offer(ids, ta, other_corners) && nearest.distance() > 0) {
                direction.set(nearest.direction());
              }
              return true;
            });
        continue;
      }
      const bool split_a = b.is_leaf() || (!a.is_leaf() && size_of(a) >= size_of(b));
      Entry near = split_a ? entry(e.a + 1, e.b) : entry(e.a, e.b + 1);
      Entry far = split_a ? entry(a.start, e.b) : entry(e.a, b.start);
      if (far.square < near.square) std::swap(near, far);
      if (double(far.square) <= nearest.limit()) stack.push_back(far);
      if (double(near.square) <= nearest.limit()) stack.push_back(near);
    }
    return nearest.best();
  });
}

}  // namespace tumble
