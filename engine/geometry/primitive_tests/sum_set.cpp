#include "engine/geometry/primitive_tests/sum_set.hpp"

#include "engine/geometry/predicates/filtered.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

ExactVector two_term_difference(const Vec3& a, const Vec3& b) {
  ExactVector out;
  for (int k = 0; k < 3; ++k) two_sum(a[k], -b[k], out.high[k], out.low[k]);
  return out;
}

template <class T>
Triple<T> exact_offset(const SumSet& set) {
  return exact_difference<T>(set.twice_a[0], set.twice_b[0]) +
         exact_difference<T>(set.twice_a[1], set.twice_b[1]);
}

template <class T>
Triple<T> lift(const ExactVector& v) {
  return exact_sum<T>(v.high, v.low);
}
template <>
Triple<Estimate> lift(const ExactVector& v) {
  const auto one = [&](int k) { return Estimate(v.high[k], std::fabs(v.low[k])); };
  return {one(0), one(1), one(2)};
}

/// The directions of the edges of the set (a Minkowski sum). Two sides of a triangle span its
/// plane, the third side is their difference.
struct Directions {
  std::array<ExactVector, 12> all;
  std::array<int, 12> owner;  ///< index of the triangle, or -1
  std::array<bool, 12> third;
  int count = 0;

  explicit Directions(const SumSet& set) {
    for (int k = 0; k < set.arm_count; ++k) push(set.arms[size_t(k)], -1, false);
    for (int t = 0; t < set.triangle_count; ++t) {
      const auto& [u, v] = set.triangles[size_t(t)];
      push(u, t, false);
      push(v, t, false);
      // Rounded to the last bits of three terms; exact() has all digits.
      ExactVector w = two_term_difference(v.high, u.high);
      w.low += v.low - u.low;
      push(w, t, true);
    }
  }
  void push(const ExactVector& v, int triangle, bool is_third) {
    all[size_t(count)] = v;
    owner[size_t(count)] = triangle;
    third[size_t(count++)] = is_third;
  }
  /// Direction k, exactly.
  template <class T>
  Triple<T> exact(const SumSet& set, int k) const {
    const auto i = size_t(k);
    if (!third[i]) return lift<T>(all[i]);
    const auto& [u, v] = set.triangles[size_t(owner[i])];
    return lift<T>(v) - lift<T>(u);
  }
  /// Whether the cross product of i and j repeats that of the first two sides of a triangle.
  bool repeats(int i, int j) const {
    return owner[size_t(i)] >= 0 && owner[size_t(i)] == owner[size_t(j)] && third[size_t(j)];
  }
};

/// Distance (times |axis|) by which the axis separates the set from the origin; positive: it
/// separates.
template <class T>
T separation(const SumSet& set, const Triple<T>& axis) {
  T low = axis.dot(exact_offset<T>(set)), high = low;
  for (int k = 0; k < set.arm_count; ++k) {
    const T reach = abs(axis.dot(lift<T>(set.arms[size_t(k)])));
    low = low - reach;
    high = high + reach;
  }
  for (int t = 0; t < set.triangle_count; ++t) {
    const T u = axis.dot(lift<T>(set.triangles[size_t(t)][0]));
    const T v = axis.dot(lift<T>(set.triangles[size_t(t)][1]));
    low = low + min(T(0.0), min(u, v));
    high = high + max(T(0.0), max(u, v));
  }
  return max(low, -high);
}

/// The set's extent along an axis, in doubles.
struct Extent {
  double low, high;
};
Extent extent(const SumSet& set, const Vec3& axis) {
  const double middle = axis.dot(set.offset());
  Extent out{middle, middle};
  for (int k = 0; k < set.arm_count; ++k) {
    const double reach = std::fabs(axis.dot(set.arms[size_t(k)].high));
    out.low -= reach;
    out.high += reach;
  }
  for (int t = 0; t < set.triangle_count; ++t) {
    const double u = axis.dot(set.triangles[size_t(t)][0].high);
    const double v = axis.dot(set.triangles[size_t(t)][1].high);
    out.low += std::min({0.0, u, v});
    out.high += std::max({0.0, u, v});
  }
  return out;
}

double largest(const ExactVector& v) {
  return v.high.cwiseAbs().maxCoeff();
}

bool is_zero(const Triple<Expansion>& v) {
  return v.x.sign() == 0 && v.y.sign() == 0 && v.z.sign() == 0;
}

/// Whether direction i x j separates, decided exactly.
bool separates(const SumSet& set, const Directions& d, int i, int j) {
  const auto at = [&](auto number) {
    using T = decltype(number);
    return separation<T>(set, d.exact<T>(set, i).cross(d.exact<T>(set, j)));
  };
  return exact_sign(at) > 0;
}

/// The answer if no cross product separates: yes for a set with volume; a flat set, segment or
/// point also needs the axes within its plane or line.
bool contains_origin_flat(const SumSet& set, const Directions& d) {
  using Vector = Triple<Expansion>;
  std::array<Vector, 12> directions;
  const auto count = size_t(d.count);
  for (size_t k = 0; k < count; ++k) directions[k] = d.exact<Expansion>(set, int(k));
  const auto apart = [&](const Vector& axis) { return separation(set, axis).sign() > 0; };

  Vector along{}, normal{};
  for (size_t i = 0; i < count && is_zero(normal); ++i) {
    if (is_zero(directions[i])) continue;
    if (is_zero(along)) along = directions[i];
    normal = along.cross(directions[i]);
  }
  const Vector offset = exact_offset<Expansion>(set);
  if (is_zero(along)) return is_zero(offset);
  if (is_zero(normal)) return is_zero(along.cross(offset)) && !apart(along);
  for (size_t k = 0; k < count; ++k) {
    if (normal.dot(directions[k]).sign() != 0) return true;
  }
  if (normal.dot(offset).sign() != 0) return false;
  for (size_t k = 0; k < count; ++k) {
    if (apart(normal.cross(directions[k]))) return false;
  }
  return true;
}

/// a x b with full accuracy, even if the two are nearly parallel.
Vec3 accurate_cross(const ExactVector& a, const ExactVector& b) {
  const Vec3 plain = a.high.cross(b.high);
  if (plain.squaredNorm() > 1e-6 * a.high.squaredNorm() * b.high.squaredNorm()) return plain;
  const auto product = [&](int i, int j, double sign) {
    return DoubleDouble{a.high[i], a.low[i]} * DoubleDouble{sign * b.high[j], sign * b.low[j]};
  };
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const DoubleDouble sum = product(i, j, 1) + product(j, i, -1);
    out[k] = sum.high + sum.low;
  }
  return out;
}

/// The two points of operand a or b whose sum enters twice the offset of the set.
std::array<Vec3, 2>& twice(SumSet& set, Part part) {
  return part == Part::a ? set.twice_a : set.twice_b;
}

}  // namespace

void add(SumSet& set, Part part, const Vec3& point) {
  twice(set, part) = {point, point};
}

void add(SumSet& set, Part part, const Segment& segment) {
  twice(set, part) = {segment.a, segment.b};
  set.arms[size_t(set.arm_count++)] = two_term_difference(segment.b, segment.a);
}

void add(SumSet& set, Part part, const Triangle3& t) {
  add(set, part, t[0]);
  auto& sides = set.triangles[size_t(set.triangle_count++)];
  for (size_t k = 0; k < 2; ++k) {
    const Vec3 &from = part == Part::a ? t[0] : t[k + 1], &to = part == Part::a ? t[k + 1] : t[0];
    sides[k] = two_term_difference(to, from);
    sides[k].high *= 2;
    sides[k].low *= 2;
  }
}

void add(SumSet& set, Part part, const OrientedBox& box) {
  add(set, part, box.centre);
  for (int k = 0; k < 3; ++k) {
    set.arms[size_t(set.arm_count++)] = {2 * box.half_axes.col(k), Vec3::Zero()};
  }
}

void add(SumSet& set, Part part, const Aabb& box) {
  twice(set, part) = {box.min, box.max};
  const ExactVector diagonal = two_term_difference(box.max, box.min);
  for (int k = 0; k < 3; ++k) {
    auto& arm = set.arms[size_t(set.arm_count++)];
    arm.high[k] = diagonal.high[k];
    arm.low[k] = diagonal.low[k];
  }
}

bool contains_origin(const SumSet& set) {
  const Directions d(set);
  std::array<double, 12> length;
  const Vec3 offset_parts = (set.twice_a[0] - set.twice_b[0])
                                .cwiseAbs()
                                .cwiseMax((set.twice_a[1] - set.twice_b[1]).cwiseAbs());
  double size = 2 * offset_parts.maxCoeff();
  for (size_t k = 0; k < size_t(d.count); ++k) {
    // A third side has the rounding errors of the two from which it is computed.
    length[k] = d.third[k] ? length[k - 1] + length[k - 2] : largest(d.all[k]);
    size += length[k];
  }

  // First all axes in double precision. Their error is below 128 u |i| |j| size (maximum norms):
  // rounding two terms to one, 2 u each; cross product, 4 u; dot product, 5 u; the sum of up to
  // twelve terms, 12 u; each factor counted for three coordinates.
  constexpr double bound = 256 * Estimate::u;
  std::array<std::array<int8_t, 2>, 66> unsure;
  size_t unsure_count = 0;
  bool has_volume = false;
  for (int i = 0; i < d.count; ++i) {
    for (int j = i + 1; j < d.count; ++j) {
      if (d.repeats(i, j)) continue;
      const Extent e = extent(set, d.all[size_t(i)].high.cross(d.all[size_t(j)].high));
      const double error = bound * length[size_t(i)] * length[size_t(j)] * size;
      if (e.low > error || e.high < -error) return false;
      has_volume = has_volume || e.high - e.low > 2 * error;
      if (!(e.low < -error && e.high > error)) unsure[unsure_count++] = {int8_t(i), int8_t(j)};
    }
  }
  for (size_t k = 0; k < unsure_count; ++k) {
    if (separates(set, d, unsure[k][0], unsure[k][1])) return false;
  }
  return has_volume || contains_origin_flat(set, d);
}

std::vector<Penetration> penetrations(const SumSet& set) {
  const Directions d(set);
  double size = set.offset().norm();
  for (size_t k = 0; k < size_t(d.count); ++k) size += d.all[k].high.norm();
  std::vector<Penetration> all;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& axis) {
    const Vec3 n = axis.normalized();
    const Extent e = extent(set, n);
    for (const bool ahead : {true, false}) {
      const double depth = ahead ? e.high : -e.low;
      if (depth > least + 1e-14 * size) continue;
      least = std::min(least, depth);
      all.push_back({ahead ? n : Vec3(-n), std::max(0.5 * depth, 0.0)});
    }
  };
  const auto try_pair = [&](int i, int j) {
    const auto &u = d.all[size_t(i)], &v = d.all[size_t(j)];
    const Vec3 axis = accurate_cross(u, v);
    if (axis.norm() > 1e-15 * u.high.norm() * v.high.norm()) offer(axis);
  };
  const auto of_one_shape = [&](int i, int j) {
    return d.owner[size_t(i)] >= 0 ? d.owner[size_t(i)] == d.owner[size_t(j)]
                                   : d.owner[size_t(j)] < 0 && i / 3 == j / 3;
  };
  for (const bool faces : {true, false}) {
    for (int i = 0; i < d.count; ++i) {
      for (int j = i + 1; j < d.count; ++j) {
        if (of_one_shape(i, j) == faces && !d.repeats(i, j)) try_pair(i, j);
      }
    }
  }
  std::erase_if(all, [&](const Penetration& p) { return 2 * p.depth > least + 1e-14 * size; });
  if (!all.empty()) return all;
  // A segment or point: any perpendicular normal.
  Penetration any;
  for (size_t k = 0; k < size_t(d.count); ++k) {
    Vec3 other;
    if (d.all[k].high.norm() > 0) {
      tangent_frame(d.all[k].high.normalized(), any.normal, other);
      break;
    }
  }
  return {any};
}

}  // namespace tumble
