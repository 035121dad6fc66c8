#pragma once
#include "engine/geometry/hierarchy/box_pair_test.hpp"
#include "engine/geometry/hierarchy/node_bound.hpp"
#include "engine/geometry/hierarchy/ray_slabs.hpp"
#include "engine/geometry/hierarchy/tree_layout.hpp"
#include "engine/geometry/hierarchy/triangle_decisions.hpp"
#include "engine/geometry/hierarchy/wide_tree.hpp"

namespace tumble {

/// What a kind needs to fit its volumes; nodes are already linked.
struct FitInput {
  const TriangleMesh& mesh;
  const Vec3& origin;
  const std::vector<uint32_t>& order;
};

/// Rounding allowance [m] for volumes in single precision about two trees' origins, one `offset`
/// from the other.
template <class Tree>
double pair_slack(const Tree& a, const Tree& b, const Vec3& offset, const RelativePose& b_in_a) {
  return 1.5e-6 * (a.size() + b.size() + offset.norm()) + 1e-13 * b_in_a.x.norm() + a.slack() +
         b.slack();
}

/// In single precision, no more than x (not negative).
inline float lower_bound(double x) {
  return x < 1e-37 ? 0 : float(std::min(x * (1 - 1e-6), 1e38));
}

inline Float4 to_float4(const Vec3& v) {
  return Float4::round(v.x(), v.y(), v.z());
}

inline Rows3 to_rows(const Mat3& m) {
  const auto row = [&](int i) { return Float4(float(m(i, 0)), float(m(i, 1)), float(m(i, 2)), 0); };
  return {{row(0), row(1), row(2)}};
}

/// Centre and half extents of a node's box, fourth lanes 0.
struct CentreBox {
  Float4 centre, half;

  explicit CentreBox(const AabbVolume& box) {
    const Float4 min = Float4::load(box.min.data()).xyz();
    const Float4 max = Float4(_mm_setr_ps(box.max[0], box.max[1], box.max[2], 0));
    centre = (min + max) * Float4(0.5f);
    half = (max - min) * Float4(0.5f);
  }
};

/// Axis-aligned boxes about the tree's origin.
struct AabbKind {
  using Volume = AabbVolume;
  static constexpr const char* name = "aabb";

  /// With the wide tree, which the first ray asks for.
  size_t state_bytes() const { return wide_.bytes(); }
  void fit(const FitInput& in, std::vector<TreeNode<AabbVolume>>& nodes);

  /// For rays.
  const WideTree& wide(const FitInput& in, const std::vector<TreeNode<AabbVolume>>& nodes) const {
    return wide_.over(nodes, in.mesh, in.order);
  }

  template <class Tree>
  void bound(const Tree& tree, const AabbVolume& v, NodeBound& out) const {
    const Vec3 low = Vec3f(v.min.data()).cast<double>();
    const Vec3 high = Vec3f(v.max.data()).cast<double>();
    set_box(out, tree.origin() + 0.5 * (low + high), (0.5 * (high - low)).asDiagonal());
  }

  static float size_of(const AabbVolume& v) {
    return (v.max[0] - v.min[0]) + (v.max[1] - v.min[1]) + (v.max[2] - v.min[2]);
  }
  /// Distance from p of the furthest point, rounded up.
  static double furthest(const AabbVolume& v, const Vec3& p) {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::max(std::fabs(double(v.min[size_t(k)]) - p[k]),
                                std::fabs(double(v.max[size_t(k)]) - p[k]));
      square += d * d;
    }
    return std::sqrt(square) * (1 + 1e-12);
  }

  /// Against a box in the mesh's frame.
  class BoxTest {
   public:
    template <class Tree>
    BoxTest(const Tree& tree, const Aabb& box) {
      const double slack = tree.slack() + 1e-15 * (box.min.norm() + box.max.norm());
      low_ = box.min.array() - tree.origin().array() - slack;
      high_ = box.max.array() - tree.origin().array() + slack;
    }
    bool apart(const AabbVolume& v) const {
      bool out = false;
      for (int k = 0; k < 3; ++k) {
        out = out || double(v.min[size_t(k)]) > high_[k] || double(v.max[size_t(k)]) < low_[k];
      }
      return out;
    }

   private:
    Vec3 low_, high_;
  };

  class RayTest {
   public:
    template <class Tree>
    RayTest(const Tree& tree, const Ray& ray)
        : slabs_(ray, tree.origin(), tree.size(), tree.slack()) {}
    float entry(const AabbVolume& v) const {
      return slabs_.entry(Float4::load(v.min.data()), Float4::load(v.max.data()));
    }
    void shorten(double t) { slabs_.shorten(t); }
    float limit() const { return slabs_.limit(); }
    const RaySlabs& slabs() const { return slabs_; }

   private:
    RaySlabs slabs_;
  };

  class PointTest {
   public:
    template <class Tree>
    PointTest(const Tree& tree, const Vec3& p) {
      const Vec3 local = p - tree.origin();
      point_ = to_float4(local);
      slack_ = Float4(float(1e-6 * (local.norm() + tree.size()) + 1e-14 * p.norm() + tree.slack()));
    }
    float squared_distance(const AabbVolume& v) const {
      const Float4 low = Float4::load(v.min.data()) - point_;
      const Float4 high = point_ - Float4::load(v.max.data());
      const Float4 gap = tumble::max(tumble::max(low, high) - slack_, Float4()).xyz();
      const Float4 s = gap * gap;
      return s.first() + s.spread<1>().first() + s.spread<2>().first();
    }

   private:
    Float4 point_, slack_;
  };

  /// The boxes of the other tree are oriented boxes in this tree's axes.
  template <bool swept>
  class PairTest {
   public:
    template <class Tree>
    PairTest(const Tree& a, const Tree& b, const RelativePose& at, double margin, const Vec3& sweep)
        : turn_(BoxTurn::from_rows(to_rows(at.R))) {
      const Vec3 offset = at.point(b.origin()) - a.origin();
      const double slack = pair_slack(a, b, offset, at) + 1e-6 * (swept ? sweep.norm() : 0);
      offset_ = to_float4(offset + (swept ? 0.5 : 0) * sweep);
      slack_ = Float4(float(slack * 1.001));
      margin_ = float((slack + margin) * 1.001);
      half_sweep_ = to_float4(0.5 * sweep);
    }
    bool apart(const AabbVolume& a, const AabbVolume& b, double extra = 0) const {
      return boxes_apart<swept>(turn_, between(a, b), Float4(margin_ + float(extra)));
    }
    /// Along the boxes' own axes only: then the boxes of their triangles are apart as well.
    bool faces_apart(const AabbVolume& a, const AabbVolume& b) const {
      return box_faces_apart<swept>(turn_, between(a, b), Float4(margin_));
    }
    float squared_distance(const AabbVolume& a, const AabbVolume& b) const {
      return box_squared_distance(turn_, between(a, b), slack_);
    }

   private:
    BoxPair between(const AabbVolume& a, const AabbVolume& b) const {
      const CentreBox ca(a), cb(b);
      return {turn_.columns.combine(cb.centre) + offset_ - ca.centre, ca.half, cb.half,
              half_sweep_};
    }

    BoxTurn turn_;
    Float4 offset_, slack_, half_sweep_;
    float margin_;
  };

 private:
  LazyWideTree wide_;
};

}  // namespace tumble
