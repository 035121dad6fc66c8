#include "engine/collision/fitting/primitive_kinds.hpp"

#include "engine/collision/shapes/nearest_points.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Sizes = std::array<double, 3>;

/// Distance from the axis, y.
double off_axis(const Vec3& p) {
  return std::sqrt(p.x() * p.x() + p.z() * p.z());
}

/// The largest distance from the axis of those points whose height is in a range.
double widest(std::span<const Vec3> points, double low, double high) {
  double most = 0;
  for (const Vec3& p : points)
    if (p.y() >= low && p.y() <= high) most = std::max(most, off_axis(p));
  return most;
}

/// From a cone along y about the middle of its height: half a plane is enough.
double distance_from_cone(const Sizes& size, const Vec3& p) {
  const double r = size[0], h = size[1], across = off_axis(p), up = p.y() + 0.5 * h;
  const double slant = std::sqrt(r * r + h * h);
  // Outside of the base (down) and of the side, whose normal leans up by r / slant.
  const double below = -up, beside = (h * (across - r) + r * up) / slant;
  if (below <= 0 && beside <= 0) return std::max(below, beside);
  const double on_base = std::min(across, r);
  const double along = std::clamp((h * up - r * (across - r)) / (slant * slant), 0.0, 1.0);
  const Vec2 to_base(across - on_base, up), to_side(across - r * (1 - along), up - h * along);
  return std::sqrt(std::min(to_base.squaredNorm(), to_side.squaredNorm()));
}

/// From the hull of two balls at the ends of a height: the plane through a point and the axis
/// shows two circles and their common tangent.
double distance_from_tapered_capsule(const Sizes& size, const Vec3& p) {
  const double low = size[0], top = size[1], h = size[2], across = off_axis(p),
               up = p.y() + 0.5 * h;
  const double lean = (low - top) / h, out = std::sqrt(std::max(0.0, 1 - lean * lean));
  const double foot = out > 0 ? up - across * lean / out : h;  // where the normal meets the axis
  if (foot <= 0) return std::sqrt(across * across + up * up) - low;
  if (foot >= h) return std::sqrt(across * across + (up - h) * (up - h)) - top;
  return across * out + up * lean - low;
}

ShapeDef shape_of(ShapeType type) {
  ShapeDef def;
  def.type = type;
  return def;
}

bool all_positive(const Sizes& size, size_t count) {
  return std::all_of(size.begin(), size.begin() + count, [](double s) { return s > 0; });
}

constexpr double least_height = 1e-3;  ///< of a capsule at first, over its radius

const std::array<PrimitiveKind, 6> kinds{
    PrimitiveKind{ShapeType::sphere, true, false, 1,
                  [](const Sizes& s, const Vec3& p) { return p.norm() - s[0]; },
                  [](std::span<const Vec3>, const Vec3& half) {
                    return Sizes{half.sum() / 3, 0, 0};
                  },
                  [](const Sizes& s) { return all_positive(s, 1); },
                  [](const Sizes& s) {
                    ShapeDef def = shape_of(ShapeType::sphere);
                    def.radius = s[0];
                    return def;
                  }},
    PrimitiveKind{ShapeType::box, false, false, 3,
                  [](const Sizes& s, const Vec3& p) {
                    return nearest_on_box({s[0], s[1], s[2]}, p).distance;
                  },
                  [](std::span<const Vec3>, const Vec3& half) {
                    return Sizes{half.x(), half.y(), half.z()};
                  },
                  [](const Sizes& s) { return all_positive(s, 3); },
                  [](const Sizes& s) {
                    ShapeDef def = shape_of(ShapeType::box);
                    def.half_extents = {s[0], s[1], s[2]};
                    return def;
                  }},
    PrimitiveKind{ShapeType::capsule, true, false, 2,
                  [](const Sizes& s, const Vec3& p) {
                    return nearest_on_capsule(0.5 * s[1], s[0], p).distance;
                  },
                  [](std::span<const Vec3> points, const Vec3& half) {
                    const double r = widest(points, -half.y(), half.y());
                    return Sizes{r, std::max(2 * (half.y() - r), least_height * r), 0};
                  },
                  [](const Sizes& s) { return all_positive(s, 2); },
                  [](const Sizes& s) {
                    ShapeDef def = shape_of(ShapeType::capsule);
                    def.radius = s[0];
                    def.height = s[1];
                    return def;
                  }},
    PrimitiveKind{ShapeType::cylinder, true, false, 2,
                  [](const Sizes& s, const Vec3& p) {
                    return nearest_on_cylinder(0.5 * s[1], s[0], p).distance;
                  },
                  [](std::span<const Vec3> points, const Vec3& half) {
                    return Sizes{widest(points, -half.y(), half.y()), 2 * half.y(), 0};
                  },
                  [](const Sizes& s) { return all_positive(s, 2); },
                  [](const Sizes& s) {
                    ShapeDef def = shape_of(ShapeType::cylinder);
                    def.radius = s[0];
                    def.height = s[1];
                    return def;
                  }},
    PrimitiveKind{ShapeType::cone, true, true, 2, distance_from_cone,
                  [](std::span<const Vec3> points, const Vec3& half) {
                    return Sizes{widest(points, -half.y(), half.y()), 2 * half.y(), 0};
                  },
                  [](const Sizes& s) { return all_positive(s, 2); },
                  [](const Sizes& s) {
                    ShapeDef def = shape_of(ShapeType::cone);
                    def.radius = s[0];
                    def.height = s[1];
                    return def;
                  }},
    PrimitiveKind{
        ShapeType::tapered_capsule, true, false, 3, distance_from_tapered_capsule,
        [](std::span<const Vec3> points, const Vec3& half) {
          const double third = half.y() / 3, both = 0.9;
          const double low = widest(points, -half.y(), -third);
          const double top = widest(points, third, half.y());
          const double h = std::max(2 * half.y() - both * (low + top),
                                    1.1 * std::fabs(low - top) + least_height * half.y());
          return Sizes{std::max(low, least_height * half.y()),
                       std::max(top, least_height * half.y()), h};
        },
        [](const Sizes& s) { return all_positive(s, 3) && s[2] > 1.001 * std::fabs(s[0] - s[1]); },
        [](const Sizes& s) {
          ShapeDef def = shape_of(ShapeType::tapered_capsule);
          def.radius = s[0];
          def.top_radius = s[1];
          def.height = s[2];
          return def;
        }},
};

}  // namespace

std::span<const PrimitiveKind> primitive_kinds() {
  return kinds;
}

}  // namespace tumble
