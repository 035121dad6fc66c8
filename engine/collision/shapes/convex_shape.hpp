#pragma once
#include "engine/collision/shape.hpp"
#include "engine/collision/shapes/core_view.hpp"
#include "engine/collision/shapes/nearest_points.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tumble {

/// The vertex, side or face of a convex core that is extreme along some direction: one point, a
/// segment of two, or a planar convex polygon, counter-clockwise seen from outside.
struct SupportingFace {
  static constexpr int capacity = 64;
  std::array<Vec3, capacity> points;
  /// Index of the vertex of the shape; stable from call to call.
  std::array<uint32_t, capacity> ids;
  int count = 0;

  void add(const Vec3& p, uint32_t id) {
    points[size_t(count)] = p;
    ids[size_t(count++)] = id;
  }
};

/// A convex set given by its support function, with a radius of rounding: the solid is all points
/// within `rounding()` of the core. The core of a ball is a point and that of a capsule a segment,
/// so that the closest points of cores give shallow contacts exactly.
class ConvexCore {
 public:
  virtual ~ConvexCore() = default;
  /// Radius of the rounding [m].
  double rounding() const { return rounding_; }
  /// A point of the core furthest along `direction` (any length; zero gives any point).
  virtual Vec3 support(const Vec3& direction) const = 0;
  /// The feature of the core to clip contacts against if `direction` (unit) points out of it: the
  /// face most nearly perpendicular to it, or a side or vertex if the core has no face.
  virtual void supporting_face(const Vec3& direction, SupportingFace& face) const = 0;
  /// Some point inside the core.
  Vec3 centre() const { return view_.centre; }
  /// The core's data for use without virtual calls.
  const CoreView& view() const { return view_; }

 protected:
  ConvexCore() = default;
  explicit ConvexCore(const CoreView& view) : view_(view) {}
  // a view may refer to its core
  ConvexCore(const ConvexCore&) = delete;
  ConvexCore& operator=(const ConvexCore&) = delete;

  double rounding_ = 0;
  CoreView view_;
};

struct VoronoiPolyhedron;

/// A convex shape: every type but half-spaces and meshes.
class ConvexShape : public Shape, public ConvexCore {
 public:
  const ConvexShape* convex() const final { return this; }
  /// Computed from the supports along the axes.
  Aabb bounds(const Pose& pose) const override;
  /// The point of the surface nearest to `p`, own frame, for types with a closed form; for others
  /// (hulls) GJK is used.
  virtual std::optional<SurfacePoint> nearest(const Vec3& p) const;
  double rounding_along(const Vec3& /*outward*/) const override { return rounding(); }
  /// The ball of radius rounding() about the core point below the surface; a material point if
  /// there is no rounding.
  SurfaceElement border_at(const Vec3& point, const Vec3& outward) const override;
  /// All corners, for shapes of which several faces next to the lowest one may touch a plane:
  /// hulls. For others the supporting face suffices.
  virtual std::span<const Vec3> corners() const { return {}; }
  /// Boxes and hulls: their Voronoi planes, for V-Clip. Null for curved shapes.
  virtual const VoronoiPolyhedron* voronoi() const { return nullptr; }

 protected:
  explicit ConvexShape(const ShapeDef& def, const CoreView& view = {},
                       ShapeSymmetry symmetry = ShapeSymmetry::none)
      : Shape(def, ShapeFamily::convex, symmetry), ConvexCore(view) {}
};

}  // namespace tumble
