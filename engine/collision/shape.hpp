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

/// Kinds of shapes, by number as snapshots hold them: a new one comes last.
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
/// Of these, how many are made of a mesh or a cloud of points: the last ones of all_shapes().
inline constexpr size_t mesh_shape_count = 3;

/// Which algorithms answer for a shape.
enum class ShapeFamily : uint8_t { half_space, convex, mesh };

/// What turns of its frame leave the set of a shape's points as it is.
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
  /// convex_hull: the points are `mesh->vertices`; triangle_mesh: the surface, counter-clockwise
  /// seen from outside, of a distance_field closed. A half_space is y <= 0 of its own frame.
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  /// distance_field: the field of `mesh` with this `cell`, where it has been made already, as from
  /// a cache; null: it is made with the shape. Not part of what snapshots hold.
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

  /// Bounds in world axes for the shape at `pose`; infinite where the shape is.
  virtual Aabb bounds(const Pose& pose) const = 0;
  /// Largest distance of any point of the shape from its frame's origin [m]; infinite for
  /// half-spaces.
  virtual double bounding_radius() const = 0;
  /// Radius of the largest sphere that is sure to stay inside near the surface [m]: how far the
  /// shape may move in one tick without any risk of passing through a thin wall.
  virtual double inner_radius() const = 0;
  /// Volume, centre and inertia about the centre for density 1 kg/m3. Half-spaces and open meshes
  /// have none and say why.
  virtual Result<MassProperties> mass_properties() const = 0;
  /// First hit of the ray origin + t direction, 0 <= t <= t_max, in the shape's frame. A ray that
  /// starts inside a solid hits at t = 0, except for meshes.
  virtual std::optional<RayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                         double t_max) const = 0;
  /// This shape as a convex one, or null (half-spaces and meshes).
  virtual const ConvexShape* convex() const { return nullptr; }
  /// This shape as a triangulated surface (meshes, hulls, boxes), or null.
  virtual const Polyhedral* polyhedral() const { return nullptr; }
  /// The signed distance that this shape touches others by, in place of its triangles, or null.
  virtual const DistanceField* field() const { return nullptr; }
  ShapeFamily family() const { return family_; }
  bool is_half_space() const { return family_ == ShapeFamily::half_space; }
  bool is_mesh() const { return family_ == ShapeFamily::mesh; }
  ShapeSymmetry symmetry() const { return symmetry_; }
  bool is_ball() const { return symmetry_ == ShapeSymmetry::point; }

  // -- contacts; all in the shape's frame

  /// The piece of the surface at a point of it where `outward` (unit) points out of the shape. A
  /// face counts as a plane where its normal is within 1e-6 rad of `outward`; else an edge, a
  /// corner or the furthest point of a rim within 1e-6 of the shape's size is taken; else the face
  /// that the point is on, or the material point itself.
  virtual SurfaceElement element_at(const Vec3& point, const Vec3& outward) const = 0;
  /// The corner or edge within 1e-6 of the shape's size of the point, what is round about a point,
  /// or the material point; never a plane. For what lies on a face.
  virtual SurfaceElement border_at(const Vec3& point, const Vec3& outward) const = 0;
  /// Whether a point element is a corner or a ball of the shape itself, not a material point
  /// somewhere on it.
  virtual bool has_point(const SurfaceElement&) const { return false; }
  /// Radius of a ball as much curved as the surface where its normal is `outward` (unit) [m]; 0 at
  /// corners, edges and faces.
  virtual double rounding_along(const Vec3& /*outward*/) const { return 0; }
  /// The feature on which a point of the surface lies, up to 1e-9 of the size, the one of lowest
  /// dimension; `triangle` is that of a mesh. Smooth shapes have face 0 alone.
  virtual PolyhedronFeature feature_at(const Vec3& /*point*/, uint32_t /*triangle*/) const {
    return {FeatureKind::face, 0};
  }
  /// How thick the thinnest part of the shape is [m]; infinite where there is no other side.
  virtual double least_thickness() const { return 2 * inner_radius(); }

  // -- for people

  /// Kind and sizes in a few words: "sphere, radius 0.5 m".
  virtual std::string words() const = 0;
  /// The lines that show the shape, own frame.
  virtual void outline(DebugDraw& out, const Vec4f& colour) const = 0;
  virtual ShapeDrawing drawing() const { return {}; }
  /// What is drawn where drawing() says `surface`.
  virtual DrawnSurface drawn_surface() const { return {}; }

 protected:
  Shape(ShapeDef def, ShapeFamily family, ShapeSymmetry symmetry)
      : def_(std::move(def)), family_(family), symmetry_(symmetry) {}

 private:
  ShapeDef def_;
  ShapeFamily family_;
  ShapeSymmetry symmetry_;
};

/// One number, or three, of a shape as scene files name it.
struct ShapeParameter {
  Parameter parameter;
  double ShapeDef::*number = nullptr;
  Vec3 ShapeDef::*vector = nullptr;
  double factor = 1;  ///< the definition holds the file's value times this
};

/// One entry of the list of shape types.
struct ShapeEntry {
  std::string_view name;  ///< in scene files
  ShapeType type;
  ShapeFamily family;
  bool polyhedral;  ///< Shape::polyhedral() is not null
  Result<std::shared_ptr<const Shape>> (*make)(const ShapeDef&);
  /// Its own numbers, those that scene files, snapshots and panels know. Meshes and clouds of
  /// points are not among them.
  std::span<const ShapeParameter> parameters;
};

/// Every shape type: "sphere", "capsule", "box", "cylinder", "ellipsoid", "half_space", "cone",
/// "tapered_capsule", "convex_hull", "triangle_mesh", "distance_field".
const std::vector<ShapeEntry>& all_shapes();
const ShapeEntry& shape_entry(ShapeType type);
/// Whether a shape is made of `ShapeDef::mesh`.
bool made_of_mesh(ShapeType type);
/// A ball; for particles, which have radii and no shapes.
ShapeDef ball_def(double radius);

/// Builds the shape (hull, trees, topology), or says which value is wrong.
Result<std::shared_ptr<const Shape>> make_shape(const ShapeDef& def);

}  // namespace tumble
