#include "engine/geometry/hierarchy/fit_box.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Four vectors, stored by coordinate (structure of arrays).
struct Vectors4 {
  Float4 x, y, z;

  static Vectors4 all(const Float4& p) { return {p.spread<0>(), p.spread<1>(), p.spread<2>()}; }
  static Vectors4 of(const Float4& p, const Float4& q, const Float4& r, const Float4& s) {
    __m128 a = p.v, b = q.v, c = r.v, d = s.v;
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {a, b, c};
  }
  Float4 one(size_t lane) const { return {x.array()[lane], y.array()[lane], z.array()[lane], 0}; }
  /// Rotates the first three lanes by one.
  Vectors4 next() const {
    return {x.shuffled<1, 2, 0, 3>(), y.shuffled<1, 2, 0, 3>(), z.shuffled<1, 2, 0, 3>()};
  }
  friend Vectors4 operator-(const Vectors4& a, const Vectors4& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

Float4 dots(const Vectors4& a, const Vectors4& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vectors4 crosses(const Vectors4& a, const Vectors4& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Unit vectors; where the length is within rounding of zero the result is NaN, which no comparison
/// chooses.
Vectors4 units(const Vectors4& v) {
  const __m128 length = _mm_sqrt_ps(dots(v, v).v);
  const __m128 lost = _mm_cmple_ps(length, _mm_set1_ps(1e-5f));
  const Float4 scale = _mm_or_ps(_mm_div_ps(_mm_set1_ps(1), length), lost);
  return {v.x * scale, v.y * scale, v.z * scale};
}

bool is_lost(const Vectors4& unit) {
  return _mm_movemask_ps(_mm_cmpunord_ps(unit.x.v, unit.x.v)) & 1;
}

Float4 areas(const Float4& x, const Float4& y, const Float4& z) {
  return x * y + y * z + z * x;
}

/// Searches the axes of a tight box about extreme points, which are scaled to magnitude 1, so that
/// no product underflows or overflows. Indices 0 to 7 are the lowest points by direction, the last
/// of them twice, 8 to 15 the highest.
class AxesSearch {
 public:
  explicit AxesSearch(const std::array<Float4, 14>& points) {
    for (size_t k = 0; k < 16; ++k) places_[k] = points[k < 7 ? k : k < 15 ? k - 1 : 13];
    for (size_t g = 0; g < 4; ++g) {
      const Float4* p = &places_[4 * g];
      fours_[g] = Vectors4::of(p[0], p[1], p[2], p[3]);
    }
    for (size_t k = 0; k < 14; ++k) spread_[k] = Vectors4::all(points[k]);
    const Vectors4 straight{Float4(1, 0, 0, 0), Float4(0, 1, 0, 0), Float4(0, 0, 1, 0)};
    const Float4 e = extents(straight);
    best_area_ = areas(e, e.spread<1>(), e.spread<2>()).first();
  }

  Rows3 run() {
    const auto square = [](const Vectors4& v) { return dots(v, v); };
    const Float4 none;
    const size_t far =
        highest({square(fours_[2] - fours_[0]), square(fours_[3] - fours_[1]), none, none});
    const Float4 p0 = places_[far], p1 = places_[far + 8];
    const Vectors4 first = Vectors4::all(p0), edge = units(Vectors4::all(p1 - p0));
    if (is_lost(edge)) return best();
    const auto from_edge = [&](size_t g) { return square(crosses(fours_[g] - first, edge)); };
    const Float4 p2 = places_[highest({from_edge(0), from_edge(1), from_edge(2), from_edge(3)})];
    const Vectors4 normal = units(crosses(edge, Vectors4::all(p2 - p0)));
    if (is_lost(normal)) return along(edge.one(0));

    // The base triangle p0 p1 p2; one lane for each of its sides.
    const Vectors4 corners = Vectors4::of(p0, p1, p2, p0), sides = units(corners.next() - corners);
    const Float4 along_sides = extents(sides);
    offer(normal, extents(normal), sides, along_sides);
    // Triangles from its sides to the points farthest above and below.
    const auto height = [&](size_t g) { return dots(fours_[g] - first, normal); };
    const std::array<Float4, 4> above{height(0), height(1), height(2), height(3)};
    const std::array<Float4, 4> below{none - above[0], none - above[1], none - above[2],
                                      none - above[3]};
    for (const size_t apex : {highest(above), highest(below)}) {
      const float h = above[apex / 4].array()[apex % 4];
      if (std::fabs(h) < 1e-4f) continue;
      const Vectors4 edges = units(Vectors4::all(places_[apex]) - corners);
      const Vectors4 normals = units(crosses(sides, edges));
      const Float4 thickness = extents(normals), along_edges = extents(edges);
      offer(normals, thickness, sides, along_sides);
      offer(normals, thickness, edges, along_edges);
      offer(normals, thickness, edges.next(), along_edges.shuffled<1, 2, 0, 3>());
    }
    return best();
  }

 private:
  /// The first index of the largest of sixteen numbers.
  static size_t highest(const std::array<Float4, 4>& h) {
    const Float4 all(most(max(max(h[0], h[1]), max(h[2], h[3]))));
    unsigned at = 0;
    for (unsigned g = 0; g < 4; ++g)
      at |= unsigned(_mm_movemask_ps(_mm_cmpeq_ps(h[g].v, all.v))) << (4 * g);
    return size_t(std::countr_zero(at | 0x8000u));
  }

  /// Extents of the points along four axes.
  Float4 extents(const Vectors4& axes) const {
    Float4 low = dots(spread_[0], axes), high = low;
    for (size_t k = 1; k < spread_.size(); ++k) {
      const Float4 h = dots(spread_[k], axes);
      low = min(low, h);
      high = max(high, h);
    }
    return high - low;
  }

  /// Tries boxes with a face perpendicular to a normal and an edge along a side, one per lane; the
  /// last lane has no meaning.
  void offer(const Vectors4& normals, Float4 thickness, const Vectors4& sides, Float4 along_sides) {
    const Float4 area = areas(thickness, along_sides, extents(crosses(normals, sides)));
    if (!(greater(Float4(best_area_), area) & 7)) return;
    const auto a = area.array();
    for (size_t k = 0; k < 3; ++k) {
      if (!(a[k] < best_area_)) continue;
      best_area_ = a[k];
      normal_ = normals.one(k);
      side_ = sides.one(k);
    }
  }

  /// Coordinates of the points along an axis.
  Rows3 along(const Float4& unit) {
    const bool x_far = std::fabs(unit.first()) < 0.6f;
    const Vectors4 across = units(crosses(
        Vectors4::all(unit), Vectors4::all(x_far ? Float4(1, 0, 0, 0) : Float4(0, 1, 0, 0))));
    offer(across, extents(across), Vectors4::all(unit), extents(Vectors4::all(unit)));
    return best();
  }

  /// Makes the axes perpendicular to rounding: the computed normal of a narrow triangle is not
  /// quite perpendicular to its sides.
  Rows3 best() const {
    const Vectors4 side = Vectors4::all(side_);
    const Vectors4 third = units(crosses(Vectors4::all(normal_), side));
    return {{crosses(side, third).one(0), side_, third.one(0)}};
  }

  std::array<Float4, 16> places_;
  std::array<Vectors4, 4> fours_;
  std::array<Vectors4, 14> spread_;
  float best_area_;
  Float4 normal_ = Float4(1, 0, 0, 0), side_ = Float4(0, 1, 0, 0);
};

/// Heights of a point along x, y, z and the four diagonals of the cube.
std::array<float, 8> heights(Float4 p) {
  std::array<float, 8> out;
  p.store(out.data());
  const Float4 y = p.spread<1>() * Float4(1, 1, -1, -1), z = p.spread<2>() * Float4(1, -1, 1, -1);
  (p.spread<0>() + y + z).store(out.data() + 3);
  return out;
}

struct Spread {
  Float4 low = Float4(std::numeric_limits<float>::infinity());
  Float4 high = Float4(-std::numeric_limits<float>::infinity());

  void include(Float4 x) {
    low = min(low, x);
    high = max(high, x);
  }
  float area() const {
    const Float4 e = high - low, f = e * e.shuffled<1, 2, 0, 3>();
    return f.first() + f.spread<1>().first() + f.spread<2>().first();
  }
};

}  // namespace

ExtremePoints::ExtremePoints(Float4 p) {
  const auto h = heights(p);
  for (size_t k = 0; k < directions; ++k) heights_[k] = heights_[k + directions] = h[k];
  points_.fill(p);
}

void ExtremePoints::include(Float4 p) {
  const auto h = heights(p);
  for (size_t k = 0; k < directions; ++k) {
    if (h[k] < heights_[k]) {
      heights_[k] = h[k];
      points_[k] = p;
    }
    if (h[k] > heights_[k + directions]) {
      heights_[k + directions] = h[k];
      points_[k + directions] = p;
    }
  }
}

void ExtremePoints::include(const ExtremePoints& other) {
  for (size_t k = 0; k < directions; ++k) {
    if (other.heights_[k] < heights_[k]) {
      heights_[k] = other.heights_[k];
      points_[k] = other.points_[k];
    }
    const size_t j = k + directions;
    if (other.heights_[j] > heights_[j]) {
      heights_[j] = other.heights_[j];
      points_[j] = other.points_[j];
    }
  }
}

Rows3 tight_axes(const ExtremePoints& extreme) {
  std::array<Float4, 14> points = extreme.points();
  const Float4 first = points[0];
  Float4 far;
  for (Float4& p : points) {
    p = p - first;
    far = max(far, abs(p));
  }
  const float size = most(far.xyz());
  if (!(size > 1e-30f)) return Rows3::identity();
  for (Float4& p : points) p = p * Float4(1 / size);
  return AxesSearch(points).run();
}

FittedBox fit_box(std::span<const Float4> points, const Rows3& axes) {
  const Rows3 columns = axes.transposed();
  Spread turned, straight;
  for (const Float4& p : points) {
    turned.include(columns.combine(p));
    straight.include(p);
  }
  FittedBox out;
  if (turned.area() < straight.area()) {
    out.axes = axes;
  } else {
    turned = straight;
  }
  out.centre = out.axes.combine((turned.low + turned.high) * Float4(0.5f)).xyz();
  // Error bound for rounding of points, axes and sums, all relative to the distance from the
  // origin.
  const float far = most(max(abs(turned.low), abs(turned.high)));
  out.half = ((turned.high - turned.low) * Float4(0.5f) + Float4(8e-7f * far)).xyz();
  return out;
}

}  // namespace tumble
