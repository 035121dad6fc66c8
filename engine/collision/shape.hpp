#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/collision/shape_drawing.hpp"
#include "engine/collision/surface_element.hpp"
#include "engine/core/parameters.hpp"
#include "engine/core/result.hpp"
#include "engine/geometry/constructions/ray.hpp"
#include "engine/geometry/debug_draw.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Kinds of shapes, with the numbers that snapshots store: a new one comes last.
enum class ShapeType : uint8_t {
  sphere,
  capsule,
  box,
  cylinder,
  half_space,
  convex_hull,
  triangle_mesh,
  ellipsoid,
  cone,
  tapered_capsule,
  distance_field,
};
inline constexpr size_t shape_type_count = 11;
/// Number of kinds that are made of a mesh or a cloud of points: the last ones of all_shapes().
inline constexpr size_t mesh_shape_count = 3;

/// Which algorithms apply to a shape.
enum class ShapeFamily : uint8_t { half_space, convex, mesh };

/// Rotations of its frame that leave the shape unchanged.
enum class ShapeSymmetry : uint8_t {
  none,
  axis,   ///< about y
  point,  ///< any about the origin: a ball
};

class DistanceField;

/// Plain description of a shape in its own frame; what scene files, commands and snapshots hold.
/// Members that a type does not use are ignored.
struct ShapeDef {
  ShapeType type = ShapeType::sphere;
  double radius = 0.5;       ///< sphere, capsule, cylinder, base of a cone, lower end [m]
  double height = 1;         ///< of capsules between the two centres, of others full [m]; along y
  double top_radius = 0.25;  ///< tapered_capsule: of its upper end [m]
  Vec3 half_extents{0.5, 0.5, 0.5};  ///< box; the semi-axes of an ellipsoid [m]
  double cell = 0;  ///< distance_field: side of its cells; 0: a 64th of the mesh's longest side [m]
  /// convex_hull: the points are `mesh->vertices`. triangle_mesh and distance_field: the surface,
  /// counter-clockwise seen from outside; that of a distance_field is closed. A half_space is y <=
  /// 0 of its frame.
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  /// distance_field: the field of `mesh` with this `cell`, if it exists already, for instance in a
  /// cache; null: it is made with the shape. Not stored in snapshots.
  std::shared_ptr<const DistanceField> field = nullptr;
};

class ConvexShape;
class Polyhedral;

/// An immutable collision geometry in its own frame; shared by every body that uses it.
class Shape {
 public:
  virtual ~Shape() = default;
  const ShapeDef& def() const { return def_; }
  ShapeType type() const { return def_.type; }

  /// Bounds in world axes for the shape at `pose`; infinite for unbounded shapes.
  virtual Aabb bounds(const Pose& pose) const = 0;
  /// Largest distance of any point of the shape from its frame's origin [m]; infinite for
  /// half-spaces.
  virtual double bounding_radius() const = 0;
  /// Radius of the largest ball that fits inside everywhere near the surface [m]: the shape may
  /// move this far in a tick without passing through a thin wall.
  virtual double inner_radius() const = 0;
  /// Volume, centre and inertia about the centre for density 1 kg/m3. For half-spaces and open
  /// meshes an error.
  virtual Result<MassProperties> mass_properties() const = 0;
  /// First hit of the ray origin + t direction, 0 <= t <= t_max, in the shape's frame. A ray that
  /// starts inside a solid hits at t = 0, except for meshes.
  virtual std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                         double t_max) const = 0;
  /// This shape as a convex one, or null (half-spaces and meshes).
  virtual const ConvexShape* convex() const { return nullptr; }
  /// This shape as a triangulated surface (meshes, hulls, boxes), or null.
  virtual const Polyhedral* polyhedral() const { return nullptr; }
  /// The signed distance field by which this shape touches others, instead of its triangles, or
  /// null.
  virtual const DistanceField* field() const { return nullptr; }
  ShapeFamily family() const { return family_; }
  bool is_half_space() const { return family_ == ShapeFamily::half_space; }
  bool is_mesh() const { return family_ == ShapeFamily::mesh; }
  ShapeSymmetry symmetry() const { return symmetry_; }
  bool is_ball() const { return symmetry_ == ShapeSymmetry::point; }

  // -- contacts; all in the shape's frame

  /// The element of the surface at a point of it where `outward` (unit) points out of the shape. A
  /// face is a plane if its normal is within 1e-6 rad of `outward`; otherwise an edge, a corner or
  /// the extreme point of a rim within 1e-6 of the shape's size is chosen; otherwise the face that
  /// the point is on, or the material point itself.
  virtual SurfaceElement element_at(const Vec3& point, const Vec3& outward) const = 0;
  /// The element for a point that lies on another shape's face: the corner or edge within 1e-6 of
  /// the shape's size, a ball or other rounding about a point, or the material point; never a
  /// plane.
  virtual SurfaceElement border_at(const Vec3& point, const Vec3& outward) const = 0;
  /// Whether a point element is a corner or a ball of the shape itself, and not just some material
  /// point of its surface.
  virtual bool has_point(const SurfaceElement&) const { return false; }
  /// Radius of curvature of the surface where its normal is `outward` (unit), as that of a ball
  /// [m]; 0 at corners, edges and faces.
  virtual double rounding_along(const Vec3& /*outward*/) const { return 0; }
  /// The feature on which a point of the surface lies, within 1e-9 of the size, the one of lowest
  /// dimension; `triangle` is for meshes. Smooth shapes have only face 0.
  virtual PolyhedronFeature feature_at(const Vec3& /*point*/, uint32_t /*triangle*/) const {
    return {FeatureKind::face, 0};
  }
  /// Thickness of the thinnest part of the shape [m]; infinite if it has no other side.
  virtual double least_thickness() const { return 2 * inner_radius(); }

  // -- for display

  /// Kind and sizes in a few words: "sphere, radius 0.5 m".
  virtual std::string words() const = 0;
  /// The lines that show the shape, own frame.
  virtual void outline(DebugDraw& out, const Vec4f& colour) const = 0;
  virtual ShapeDrawing drawing() const { return {}; }
  /// The surface that is drawn if drawing() says `surface`.
  virtual DrawnSurface drawn_surface() const { return {}; }

 protected:
  Shape(ShapeDef def, ShapeFamily family, ShapeSymmetry symmetry)
      : def_(std::move(def)), family_(family), symmetry_(symmetry) {}

 private:
  ShapeDef def_;
  ShapeFamily family_;
  ShapeSymmetry symmetry_;
};

/// A number, or three, of a shape, with its name in scene files.
struct ShapeParameter {
  Parameter parameter;
  double ShapeDef::*number = nullptr;
  Vec3 ShapeDef::*vector = nullptr;
  double factor = 1;  ///< member of the definition = value in the file times this
};

/// One entry of the list of shape types.
struct ShapeEntry {
  std::string_view name;  ///< in scene files
  ShapeType type;
  ShapeFamily family;
  bool polyhedral;  ///< Shape::polyhedral() is not null
  Result<std::shared_ptr<const Shape>> (*make)(const ShapeDef&);
  /// Its parameters in scene files, snapshots and panels, except meshes and clouds of points.
  std::span<const ShapeParameter> parameters;
};

/// Every shape type: "sphere", "capsule", "box", "cylinder", "ellipsoid", "half_space", "cone",
/// "tapered_capsule", "convex_hull", "triangle_mesh", "distance_field".
const std::vector<ShapeEntry>& all_shapes();
const ShapeEntry& shape_entry(ShapeType type);
/// Whether a shape is made of `ShapeDef::mesh`.
bool made_of_mesh(ShapeType type);
/// The definition of a ball, for particles, which have radii and no shapes.
ShapeDef ball_def(double radius);

/// Builds the shape (hull, trees, topology), or says which value is wrong.
Result<std::shared_ptr<const Shape>> make_shape(const ShapeDef& def);

}  // namespace tumble
