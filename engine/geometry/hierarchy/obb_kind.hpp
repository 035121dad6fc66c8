#pragma once
#include "engine/geometry/hierarchy/aabb_kind.hpp"

namespace tumble {

/// A box with its own axes about the tree's origin.
struct ObbVolume {
  std::array<float, 9> axes;  ///< a matrix by rows; its columns are the unit axes
  std::array<float, 3> centre;
  std::array<float, 3> half;  ///< extents along the axes
};

/// Boxes with their own axes, tightly fitted (fit_box.hpp).
struct ObbKind {
  using Volume = ObbVolume;
  static constexpr const char* name = "obb";

  size_t state_bytes() const { return 0; }
  void fit(const FitInput& in, std::vector<TreeNode<ObbVolume>>& nodes);

  template <class Tree>
  void bound(const Tree& tree, const ObbVolume& v, NodeBound& out) const {
    const float* row = v.axes.data();
    const Mat3 axes = Mat3f::from_rows(Vec3f(row), Vec3f(row + 3), Vec3f(row + 6)).cast<double>();
    const Vec3 half = Vec3f(v.half.data()).cast<double>();
    set_box(out, tree.origin() + Vec3f(v.centre.data()).cast<double>(), axes * half.asDiagonal());
  }

  static float size_of(const ObbVolume& v) { return v.half[0] + v.half[1] + v.half[2]; }
  /// Distance from p of the furthest point, rounded up.
  static double furthest(const ObbVolume& v, const Vec3& p) {
    const Vec3 centre = Vec3f(v.centre.data()).cast<double>();
    const Vec3 half = Vec3f(v.half.data()).cast<double>();
    return ((centre - p).norm() + half.norm()) * (1 + 1e-6);
  }

  /// Rows of the axes matrix; fourth lanes hold finite leftovers of what follows in memory.
  static Rows3 rows(const ObbVolume& v) {
    return {{Float4::load(v.axes.data()), Float4::load(v.axes.data() + 3),
             Float4::load(v.axes.data() + 6)}};
  }
  static Float4 centre(const ObbVolume& v) { return Float4::load(v.centre.data()); }
  static Float4 half(const ObbVolume& v) { return _mm_setr_ps(v.half[0], v.half[1], v.half[2], 0); }

  /// Against a box in the mesh's frame.
  class BoxTest {
   public:
    template <class Tree>
    BoxTest(const Tree& tree, const Aabb& box) {
      const Vec3 low = box.min - tree.origin(), high = box.max - tree.origin();
      centre_ = to_float4(0.5 * (low + high));
      half_ = to_float4(0.5 * (high - low));
      margin_ = Float4(float(2e-6 * (tree.size() + low.norm() + high.norm()) + 2 * tree.slack()));
    }
    bool apart(const ObbVolume& v) const {
      return boxes_apart<false>(BoxTurn::from_rows(rows(v)),
                                {centre(v) - centre_, half_, half(v), {}}, margin_);
    }

   private:
    Float4 centre_, half_, margin_;
  };

  class RayTest {
   public:
    template <class Tree>
    RayTest(const Tree& tree, const Ray& ray)
        : line_(ray, tree.origin(), tree.size(), tree.slack()) {}
    float entry(const ObbVolume& v) const {
      return line_.turned_entry(rows(v), centre(v), half(v));
    }
    void shorten(double t) { line_.shorten(t); }
    float limit() const { return line_.limit(); }

   private:
    RaySlabs line_;
  };

  class PointTest {
   public:
    template <class Tree>
    PointTest(const Tree& tree, const Vec3& p) {
      const Vec3 local = p - tree.origin();
      point_ = to_float4(local);
      slack_ = Float4(float(2e-6 * (local.norm() + tree.size()) + 1e-14 * p.norm() + tree.slack()));
    }
    float squared_distance(const ObbVolume& v) const {
      const Float4 on_axes = rows(v).combine(point_ - centre(v));
      const Float4 gap = tumble::max(abs(on_axes) - half(v) - slack_, Float4());
      const Float4 s = gap * gap;
      return s.first() + s.spread<1>().first() + s.spread<2>().first();
    }

   private:
    Float4 point_, slack_;
  };

  template <bool swept>
  class PairTest {
   public:
    template <class Tree>
    PairTest(const Tree& a, const Tree& b, const RelativePose& at, double margin, const Vec3& sweep)
        : turn_(to_rows(at.R)), turn_columns_(turn_.transposed()) {
      const Vec3 offset = at.point(b.origin()) - a.origin();
      const double slack = pair_slack(a, b, offset, at) + 1e-6 * (swept ? sweep.norm() : 0);
      offset_ = to_float4(offset + (swept ? 0.5 : 0) * sweep);
      slack_ = Float4(float(slack * 1.001));
      margin_ = float((slack + margin) * 1.001);
      half_sweep_ = to_float4(0.5 * sweep);
    }
    bool apart(const ObbVolume& a, const ObbVolume& b, double extra = 0) const {
      const Seen seen(*this, a, b);
      return boxes_apart<swept>(seen.turn, seen.boxes, Float4(margin_ + float(extra)));
    }
    float squared_distance(const ObbVolume& a, const ObbVolume& b) const {
      const Seen seen(*this, a, b);
      return box_squared_distance(seen.turn, seen.boxes, slack_);
    }

   private:
    /// Box b on the axes of box a.
    struct Seen {
      BoxTurn turn;
      BoxPair boxes;

      Seen(const PairTest& t, const ObbVolume& a, const ObbVolume& b) {
        const Rows3 axes_a = rows(a), axes_b = rows(b);
        // Row k: axis k of the first tree's frame on the axes of b.
        const Rows3 moved{{axes_b.combine(t.turn_.row[0]), axes_b.combine(t.turn_.row[1]),
                           axes_b.combine(t.turn_.row[2])}};
        const Rows3 columns_a = axes_a.transposed();
        turn =
            BoxTurn::from_rows({{moved.combine(columns_a.row[0]), moved.combine(columns_a.row[1]),
                                 moved.combine(columns_a.row[2])}});
        const Float4 offset = t.turn_columns_.combine(centre(b)) + t.offset_ - centre(a);
        boxes = {axes_a.combine(offset), half(a), half(b),
                 swept ? axes_a.combine(t.half_sweep_) : Float4()};
      }
    };

    Rows3 turn_, turn_columns_;
    Float4 offset_, slack_, half_sweep_;
    float margin_;
  };
};

}  // namespace tumble
