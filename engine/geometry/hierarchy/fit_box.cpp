#include "engine/geometry/hierarchy/fit_box.hpp"

#include <cmath>
#include <limits>

namespace tumble {
namespace {

Float4 cross3(Float4 a, Float4 b) {
  return a.shuffled<1, 2, 0, 3>() * b.shuffled<2, 0, 1, 3>() -
         a.shuffled<2, 0, 1, 3>() * b.shuffled<1, 2, 0, 3>();
}

/// Unit vector; false when its length is lost in rounding beside 1.
bool normalise(Float4& v) {
  const float length = std::sqrt(dot3(v, v));
  if (!(length > 1e-5f)) return false;
  v = v * Float4(1 / length);
  return true;
}

/// The extreme points by coordinate, four at a time.
struct PointTable {
  std::array<Float4, 4> x, y, z;

  explicit PointTable(const std::array<Float4, 2 * ExtremePoints::directions>& p) {
    for (size_t g = 0; g < 4; ++g) {
      const auto at = [&](size_t k) { return p[std::min(4 * g + k, p.size() - 1)].v; };
      __m128 a = at(0), b = at(1), c = at(2), d = at(3);
      _MM_TRANSPOSE4_PS(a, b, c, d);
      x[g] = a;
      y[g] = b;
      z[g] = c;
    }
  }
  float extent(Float4 axis) const {
    const Float4 ax = axis.spread<0>(), ay = axis.spread<1>(), az = axis.spread<2>();
    Float4 low = x[0] * ax + y[0] * ay + z[0] * az, high = low;
    for (size_t g = 1; g < 4; ++g) {
      const Float4 h = x[g] * ax + y[g] * ay + z[g] * az;
      low = min(low, h);
      high = max(high, h);
    }
    return most(high) - least(low);
  }
};

class AxesSearch {
 public:
  /// `points` about 1 in size, so that no product underflows or overflows.
  explicit AxesSearch(const std::array<Float4, 14>& points) : table_(points), points_(points) {
    const float x = table_.extent(Float4(1, 0, 0, 0)), y = table_.extent(Float4(0, 1, 0, 0)),
                z = table_.extent(Float4(0, 0, 1, 0));
    best_area_ = x * y + y * z + z * x;
  }

  Rows3 run() {
    Float4 p0, p1;
    furthest_pair(p0, p1);
    Float4 edge = p1 - p0;
    if (!normalise(edge)) return best_;
    const Float4 p2 = furthest_from_line(p0, edge);
    if (!try_triangle(p0, p1, p2)) {
      try_line(edge);
      return best_;
    }
    Float4 normal = cross3(p1 - p0, p2 - p0);
    normal = normal * Float4(1 / std::sqrt(dot3(normal, normal)));
    for (const Float4& apex : {furthest_along(normal, 1), furthest_along(normal, -1)}) {
      if (std::fabs(dot3(apex - p0, normal)) < 1e-4f) continue;
      try_triangle(p0, p1, apex);
      try_triangle(p1, p2, apex);
      try_triangle(p2, p0, apex);
    }
    return best_;
  }

 private:
  void furthest_pair(Float4& p0, Float4& p1) const {
    float most_square = -1;
    for (size_t k = 0; k < ExtremePoints::directions; ++k) {
      const Float4 &a = points_[k], &b = points_[k + ExtremePoints::directions];
      const float square = dot3(b - a, b - a);
      if (square > most_square) {
        most_square = square;
        p0 = a;
        p1 = b;
      }
    }
  }

  Float4 furthest_from_line(Float4 p, Float4 unit) const {
    float most_square = -1;
    Float4 best = p;
    for (const Float4& q : points_) {
      const Float4 c = cross3(q - p, unit);
      const float square = dot3(c, c);
      if (square > most_square) {
        most_square = square;
        best = q;
      }
    }
    return best;
  }

  Float4 furthest_along(Float4 axis, float sign) const {
    float highest = -std::numeric_limits<float>::infinity();
    Float4 best = points_[0];
    for (const Float4& q : points_) {
      const float h = sign * dot3(q, axis);
      if (h > highest) {
        highest = h;
        best = q;
      }
    }
    return best;
  }

  void offer(Float4 a, float extent_a, Float4 b, Float4 c) {
    const float y = table_.extent(b), z = table_.extent(c);
    const float area = extent_a * y + y * z + z * extent_a;
    if (!(area < best_area_)) return;
    best_area_ = area;
    best_ = {{a, b, c}};
  }

  /// Boxes with a face on the triangle and an edge along one of its sides; false if it is a line.
  bool try_triangle(Float4 a, Float4 b, Float4 c) {
    Float4 normal = cross3(b - a, c - a);
    if (!normalise(normal)) return false;
    const float thickness = table_.extent(normal);
    for (Float4 side : {b - a, c - b, a - c}) {
      if (normalise(side)) offer(normal, thickness, side, cross3(normal, side));
    }
    return true;
  }

  void try_line(Float4 unit) {
    const auto u = unit.array();
    Float4 other = std::fabs(u[0]) < 0.6f ? Float4(1, 0, 0, 0) : Float4(0, 1, 0, 0);
    other = cross3(unit, other);
    if (normalise(other)) offer(unit, table_.extent(unit), other, cross3(unit, other));
  }

  PointTable table_;
  const std::array<Float4, 14>& points_;
  float best_area_;
  Rows3 best_ = Rows3::identity();
};

/// Heights along x, y, z and the four diagonals of the cube.
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
  // Rounding of points, axes and sums, all relative to the distance from the origin.
  const float far = most(max(abs(turned.low), abs(turned.high)));
  out.half = ((turned.high - turned.low) * Float4(0.5f) + Float4(8e-7f * far)).xyz();
  return out;
}

}  // namespace tumble
