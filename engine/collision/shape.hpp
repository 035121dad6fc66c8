#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble {

enum class ShapeType : uint8_t {
  sphere,
  capsule,
  box,
  cylinder,
  half_space,
  convex_hull,
  triangle_mesh,
  ellipsoid,
};

/// Plain description of a shape in its own frame; what scene files, commands and snapshots hold.
/// Members that a type does not use are ignored.
struct ShapeDef {
  ShapeType type = ShapeType::sphere;
  double radius = 0.5;  ///< sphere, capsule, cylinder [m]
  double height = 1;    ///< capsule: between the two centres; cylinder: full [m]; along y
  Vec3 half_extents{0.5, 0.5, 0.5};  ///< box; the semi-axes of an ellipsoid [m]
  /// convex_hull: the points are `mesh->vertices`; triangle_mesh: the surface, counter-clockwise
  /// seen from outside. A half_space is y <= 0 of its own frame.
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
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

 protected:
  explicit Shape(ShapeDef def) : def_(std::move(def)) {}

 private:
  ShapeDef def_;
};

/// One entry of the list of shape types: name in scene files and factory.
struct ShapeEntry {
  std::string_view name;
  ShapeType type;
  Result<std::shared_ptr<const Shape>> (*make)(const ShapeDef&);
};

/// Every shape type: "sphere", "capsule", "box", "cylinder", "ellipsoid", "half_space",
/// "convex_hull", "triangle_mesh".
const std::vector<ShapeEntry>& all_shapes();

/// Builds the shape (hull, trees, topology), or says which value is wrong.
Result<std::shared_ptr<const Shape>> make_shape(const ShapeDef& def);

}  // namespace tumble
