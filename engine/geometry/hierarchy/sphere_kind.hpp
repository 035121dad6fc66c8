#pragma once
#include "engine/geometry/hierarchy/aabb_kind.hpp"

namespace tumble {

/// A sphere about the tree's origin, its radius rounded up.
struct SphereVolume {
  std::array<float, 3> centre;
  float radius;
};

/// Minimal spheres (minimal_sphere.hpp).
struct SphereKind {
  using Volume = SphereVolume;
  static constexpr const char* name = "sphere";

  size_t state_bytes() const { return 0; }
  void fit(const FitInput& in, std::vector<TreeNode<SphereVolume>>& nodes);

  template <class Tree>
  void bound(const Tree& tree, const SphereVolume& v, NodeBound& out) const {
    out.form = BoundForm::sphere;
    out.points.assign(1, tree.origin() + centre(v));
    out.radius = double(v.radius);
  }

  static float size_of(const SphereVolume& v) { return v.radius; }
  static double furthest(const SphereVolume& v, const Vec3& p) {
    return ((centre(v) - p).norm() + double(v.radius)) * (1 + 1e-12);
  }
  static Vec3 centre(const SphereVolume& v) {
    return {double(v.centre[0]), double(v.centre[1]), double(v.centre[2])};
  }

  class BoxTest {
   public:
    template <class Tree>
    BoxTest(const Tree& tree, const Aabb& box)
        : low_(box.min - tree.origin()),
          high_(box.max - tree.origin()),
          slack_(tree.slack() + 1e-14 * (box.min.norm() + box.max.norm())) {}
    bool apart(const SphereVolume& v) const {
      const Vec3 c = centre(v);
      const double square = (low_ - c).cwiseMax(c - high_).cwiseMax(0.0).squaredNorm();
      const double reach = double(v.radius) + slack_;
      return square > reach * reach * (1 + 1e-12);
    }

   private:
    Vec3 low_, high_;
    double slack_;
  };

  class RayTest {
   public:
    template <class Tree>
    RayTest(const Tree& tree, const Ray& ray)
        : start_(ray.origin - tree.origin()),
          direction_(ray.direction),
          square_(ray.direction.squaredNorm()),
          slack_(tree.slack() + 1e-13 * start_.norm()) {}
    float entry(const SphereVolume& v) const {
      const Vec3 m = start_ - centre(v);
      const double reach = double(v.radius) + slack_;
      // From the foot of the perpendicular, accurate for distant origins.
      const double at = -m.dot(direction_) / square_;
      const double rest = reach * reach * (1 + 1e-12) - (m + at * direction_).squaredNorm();
      if (!(rest >= 0)) return no_entry;
      const double half = std::sqrt(rest / square_);
      const double in = at - half, out = at + half;
      if (out < 0 || in > limit_) return no_entry;
      return in > 0 ? float(std::min(in * (1 - 1e-6), 1e38)) : 0;
    }
    void shorten(double t) { limit_ = t * (1 + 1e-12) + slack_ / std::sqrt(square_); }
    float limit() const { return float(std::min(limit_, 1e38)) * 1.000001f; }

   private:
    Vec3 start_, direction_;
    double square_, slack_, limit_ = std::numeric_limits<double>::infinity();
  };

  class PointTest {
   public:
    template <class Tree>
    PointTest(const Tree& tree, const Vec3& p)
        : point_(p - tree.origin()), slack_(tree.slack() + 1e-14 * p.norm()) {}
    float squared_distance(const SphereVolume& v) const {
      const double d = (point_ - centre(v)).norm() - double(v.radius) - slack_;
      return d > 0 ? lower_bound(d * d) : 0;
    }

   private:
    Vec3 point_;
    double slack_;
  };

  template <bool swept>
  class PairTest {
   public:
    template <class Tree>
    PairTest(const Tree& a, const Tree& b, const RelativePose& at, double margin, const Vec3& sweep)
        : turn_(at.R), offset_(at.point(b.origin()) - a.origin()), sweep_(sweep) {
      slack_ = pair_slack(a, b, offset_, at);
      margin_ = margin + slack_;
      square_ = sweep.squaredNorm();
    }
    bool apart(const SphereVolume& a, const SphereVolume& b, double extra = 0) const {
      const double reach = double(a.radius) + double(b.radius) + margin_ + extra;
      return between(a, b).squaredNorm() > reach * reach;
    }
    float squared_distance(const SphereVolume& a, const SphereVolume& b) const {
      const double d = between(a, b).norm() - double(a.radius) - double(b.radius) - slack_;
      return d > 0 ? lower_bound(d * d) : 0;
    }

   private:
    /// From a's centre to the nearest point that b's centre passes.
    Vec3 between(const SphereVolume& a, const SphereVolume& b) const {
      const Vec3 d = turn_ * centre(b) + offset_ - centre(a);
      if constexpr (!swept) return d;
      if (!(square_ > 0)) return d;
      return d + std::clamp(-d.dot(sweep_) / square_, 0.0, 1.0) * sweep_;
    }

    Mat3 turn_;
    Vec3 offset_, sweep_;
    double slack_, margin_, square_;
  };
};

}  // namespace tumble
