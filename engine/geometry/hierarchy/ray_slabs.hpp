#pragma once
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/math/float4.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tumble {

/// Result of a ray's test of a volume that it misses.
constexpr float no_entry = std::numeric_limits<float>::infinity();

/// A ray in single precision whose tests are conservative: it starts near the mesh, so that a
/// distant origin costs no accuracy, and boxes are enlarged by bounds of the rounding errors. Times
/// are in units of the direction's largest component, from that start.
class RaySlabs {
 public:
  /// The mesh lies within `size` of `origin`, about which boxes are given; `slack` is to be added
  /// to their rounding [m].
  RaySlabs(const Ray& ray, const Vec3& origin, double size, double slack) {
    // Cheap upper bounds of lengths suffice for allowances.
    const auto length = [](const Vec3& v) {
      return std::fabs(v.x()) + std::fabs(v.y()) + std::fabs(v.z());
    };
    const Vec3& whole = ray.direction;
    const double largest =
        std::max({std::fabs(whole.x()), std::fabs(whole.y()), std::fabs(whole.z())});
    const Vec3 d = whole / largest, o = ray.origin - origin;
    scale_ = largest;
    // |d| is from 1 to 1.8: at least a size before where the line is nearest.
    advance_ = std::max(0.0, -o.dot(d) / d.squaredNorm() - size);
    const Vec3 start = o + advance_ * d;
    const double reach = size + length(start);
    // Rounding of start and of points along the ray, relative to how far they may be.
    pad_ = float(1.01 * slack + 1e-6 * reach + 1e-14 * length(o));
    direction_ = Float4::round(d.x(), d.y(), d.z());
    // A direction in single precision deviates by 1e-7 of the distance travelled, which within the
    // mesh is a few sizes.
    turned_pad_ = pad_ + float(4e-6 * reach);
    start_ = Float4::round(start.x(), start.y(), start.z());
    // For a ray parallel to a side, the crossing is far outside or never.
    const __m128 sign = _mm_and_ps(direction_.v, _mm_set1_ps(-0.0f));
    const Float4 steep = tumble::max(abs(direction_), Float4(1e-18f));
    inverse_ = _mm_or_ps(_mm_div_ps(_mm_set1_ps(1), steep.v), sign);
    low_ = start_ + Float4(pad_);
    high_ = start_ - Float4(pad_);
  }

  /// Time of entry into the box, or no_entry. Fourth lanes are ignored.
  float entry(Float4 min, Float4 max) const {
    return entry((min - low_) * inverse_, (max - high_) * inverse_, limit_);
  }

  /// Entry into a box with its own axes: `rows` of the matrix whose columns they are.
  float turned_entry(const Rows3& rows, Float4 centre, Float4 half) const {
    const Float4 start = rows.combine(start_ - centre), direction = rows.combine(direction_);
    // Nearly parallel to a face: moved by less than the allowance, away from zero.
    const Float4 sign = _mm_and_ps(direction.v, _mm_set1_ps(-0.0f));
    const Float4 away = _mm_or_ps(tumble::max(abs(direction), Float4(1e-9f)).v, sign.v);
    const Float4 inverse = _mm_div_ps(_mm_set1_ps(1), away.v);
    const Float4 reach = half + Float4(turned_pad_);
    return entry((Float4() - reach - start) * inverse, (reach - start) * inverse, limit_);
  }

  /// Four boxes at a time, with the same arithmetic.
  class Four {
   public:
    explicit Four(const RaySlabs& ray) {
      // Without branches, which would be mispredicted for random rays.
      const Float4 inverse = ray.inverse_;
      const __m128 backward = _mm_cmplt_ps(inverse.v, _mm_setzero_ps());
      const Float4 entering = chosen(backward, ray.high_, ray.low_);
      const Float4 leaving = chosen(backward, ray.low_, ray.high_);
      inverse_ = {inverse.spread<0>(), inverse.spread<1>(), inverse.spread<2>()};
      entering_ = {entering.spread<0>(), entering.spread<1>(), entering.spread<2>()};
      leaving_ = {leaving.spread<0>(), leaving.spread<1>(), leaving.spread<2>()};
      const auto signs = unsigned(_mm_movemask_ps(backward));
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned other = 3 * (signs >> k & 1);
        near_[k] = k + other;
        far_[k] = k + 3 - other;
      }
    }

    /// Entries into the boxes with these bounds (lowest x, y, z, then highest), or no_entry.
    Float4 entries(const std::array<std::array<float, 4>, 6>& bounds, float limit) const {
      Float4 in, out = Float4(limit);
      for (size_t k = 0; k < 3; ++k) {
        in = tumble::max(in, (Float4::load(bounds[near_[k]].data()) - entering_[k]) * inverse_[k]);
        out = tumble::min(out, (Float4::load(bounds[far_[k]].data()) - leaving_[k]) * inverse_[k]);
      }
      const Float4 met = _mm_cmple_ps(in.v, (out * Float4(rounding)).v);
      const Float4 entry = in * Float4(2 - rounding);
      return _mm_or_ps(_mm_and_ps(met.v, entry.v), _mm_andnot_ps(met.v, _mm_set1_ps(no_entry)));
    }

   private:
    /// a where the mask is set, else b.
    static Float4 chosen(__m128 mask, Float4 a, Float4 b) {
      return _mm_or_ps(_mm_and_ps(mask, a.v), _mm_andnot_ps(mask, b.v));
    }

    std::array<Float4, 3> inverse_, entering_, leaving_;
    std::array<size_t, 3> near_, far_;  ///< places of the bounds that the ray enters and leaves
  };

  /// Volumes entered after time t of the ray are ignored from now on.
  void shorten(double t) {
    const double local = t * scale_ - advance_;
    limit_ =
        float(std::min(local + 1e-14 * (t * scale_ + advance_) + double(pad_), 1e38)) * rounding;
  }
  float limit() const { return limit_; }

 private:
  static float entry(Float4 a, Float4 b, float limit) {
    const Float4 near = tumble::min(a, b), far = tumble::max(a, b);
    const float t0 = std::max(std::max(near.first(), near.spread<1>().first()),
                              std::max(near.spread<2>().first(), 0.0f));
    const float t1 = std::min(std::min(far.first(), far.spread<1>().first()),
                              std::min(far.spread<2>().first(), limit));
    return t0 <= t1 * rounding ? t0 * (2 - rounding) : no_entry;
  }

  static constexpr float rounding = 1.000001f;
  Float4 start_, direction_, inverse_, low_, high_;
  double scale_ = 1, advance_ = 0;
  float pad_ = 0, turned_pad_ = 0, limit_ = std::numeric_limits<float>::max();
};

}  // namespace tumble
