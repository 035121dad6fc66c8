#pragma once
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/math/float4.hpp"

#include <cstring>
#include <limits>

// What a tree is built from: boxes of triangles in single precision, and ways to divide them.
namespace tumble {

/// At least one unit in the last place.
inline Float4 rounding_of(Float4 x) {
  return abs(x) * Float4(0x1p-23f) + Float4(std::numeric_limits<float>::min());
}

/// A box that starts empty.
struct GrowingBox {
  Float4 min = Float4(std::numeric_limits<float>::infinity());
  Float4 max = Float4(-std::numeric_limits<float>::infinity());

  void include(const GrowingBox& b) {
    min = tumble::min(min, b.min);
    max = tumble::max(max, b.max);
  }
  void include(Float4 p) {
    min = tumble::min(min, p);
    max = tumble::max(max, p);
  }
  float half_area() const {
    const Float4 e = max - min, f = e * e.shuffled<1, 2, 0, 3>();
    return f.first() + f.spread<1>().first() + f.spread<2>().first();
  }
  int longest_axis() const {
    const auto e = (max - min).array();
    return e[0] >= e[1] && e[0] >= e[2] ? 0 : e[1] >= e[2] ? 1 : 2;
  }
};

/// Box of one triangle about `origin`, rounded outwards.
inline GrowingBox outward_box(const TriangleMesh& mesh, uint32_t triangle, const Vec3& origin) {
  GrowingBox box;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 p = mesh.corner(triangle, k) - origin;
    box.include(Float4::round(p.x(), p.y(), p.z()));
  }
  box.min = box.min - rounding_of(box.min);
  box.max = box.max + rounding_of(box.max);
  return box;
}

/// A triangle's box, carrying the triangle's number in the fourth lane of `min` as a float that is
/// never denormal (numbers stay below 2^25).
struct TreeItem {
  GrowingBox box;

  Float4 centre() const { return box.min + box.max; }  // twice
  uint32_t triangle() const {
    uint32_t bits;
    const float f = box.min.spread<3>().first();
    std::memcpy(&bits, &f, sizeof bits);
    return bits - 0x40000000u;
  }
  static TreeItem make(const GrowingBox& b, uint32_t triangle) {
    const Float4 tag(_mm_castsi128_ps(_mm_set1_epi32(int(0x40000000u + triangle))));
    return {{b.min.with_fourth(tag), b.max.with_fourth(tag)}};
  }
};

/// Some items, by place, with their common box and that of their centres.
struct TreeItems {
  uint32_t begin, end;
  GrowingBox box, centres;

  uint32_t size() const { return end - begin; }
};

/// A division between two bins of an axis, with the boxes of both sides.
struct TreeSplit {
  int axis = -1;
  Float4 low, scale;
  int bin = 0;  ///< the first of the right side
  float cost = std::numeric_limits<float>::infinity();
  GrowingBox left_box, right_box;

  /// With the bins' own arithmetic, so that the division is the one that was weighed.
  static __m128i bins_of(const TreeItem& item, Float4 low, Float4 scale) {
    return _mm_cvttps_epi32(((item.centre() - low) * scale).v);
  }
  bool left(const TreeItem& item) const {
    const __m128i below = _mm_cmplt_epi32(bins_of(item, low, scale), _mm_set1_epi32(bin));
    return (_mm_movemask_ps(_mm_castsi128_ps(below)) >> axis) & 1;
  }
};

}  // namespace tumble
