#pragma once
#include "engine/core/parameters.hpp"
#include "engine/core/random.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/particles/tolerances.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <memory>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

class Hierarchy;

// Regions from which an emitter emits, in its own frame, whose y axis is the direction of emission.
// Points are distributed uniformly.

struct PointEmission {
  static constexpr std::string_view type_name = "point";
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
};

/// A line along x with the origin in its middle.
struct LineEmission {
  static constexpr std::string_view type_name = "line";
  double length = 1;  ///< [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.length, {.name = "length",
                       .unit = "m",
                       .min = 0,
                       .max = tolerances::longest_emission,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "along x of the emitter's frame"});
  }
};

/// A disc or ring perpendicular to y.
struct DiscEmission {
  static constexpr std::string_view type_name = "disc";
  double radius = 1, inner_radius = 0;  ///< [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = tolerances::longest_emission,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "of the disc, across the direction of emission"});
    v.field(d.inner_radius, {.name = "inner_radius",
                             .unit = "m",
                             .min = 0,
                             .max = tolerances::longest_emission,
                             .doc = "of a ring's hole"});
  }
};

struct SphereEmission {
  static constexpr std::string_view type_name = "sphere";
  double radius = 1;     ///< [m]
  bool surface = false;  ///< from its surface only
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = tolerances::longest_emission,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "of the ball"});
    v.field(d.surface, {.name = "surface", .doc = "from its surface only"});
  }
};

struct BoxEmission {
  static constexpr std::string_view type_name = "box";
  Vec3 size{1, 1, 1};    ///< full extents [m]
  bool surface = false;  ///< from its faces only
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = tolerances::longest_emission,
                     .exclusive_min = true,
                     .required = true,
                     .doc = "full extents"});
    v.field(d.surface, {.name = "surface", .doc = "from its faces only"});
  }
};

/// The surface of a mesh.
struct MeshSurfaceEmission {
  static constexpr std::string_view type_name = "mesh_surface";
  std::shared_ptr<const TriangleMesh> mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
};

/// The inside of a closed mesh.
struct MeshVolumeEmission {
  static constexpr std::string_view type_name = "mesh_volume";
  std::shared_ptr<const TriangleMesh> mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
};

/// The list of shapes to emit from. To add one: an alternative at its end (snapshots store the
/// index), its draw in emission_shape.cpp, and a test.
using EmissionShapeDef = std::variant<PointEmission, LineEmission, DiscEmission, SphereEmission,
                                      BoxEmission, MeshSurfaceEmission, MeshVolumeEmission>;

/// The mesh of a definition, null for kinds without.
std::shared_ptr<const TriangleMesh> mesh_of(const EmissionShapeDef& def);
std::shared_ptr<const TriangleMesh>* mesh_of(EmissionShapeDef& def);

/// A point of the shape, and an outward unit vector there: the normal of a surface, the direction
/// from the centre of a ball, otherwise +y.
struct EmissionPoint {
  Vec3 x = Vec3::Zero();
  Vec3 outward = Vec3::UnitY();
};

/// A shape prepared for drawing points.
class EmissionShape {
 public:
  /// Error if a size is not > 0, if a mesh has no area or, for its volume, encloses none or less
  /// than a thousandth of its bounding box.
  static Result<EmissionShape> make(const EmissionShapeDef& def);
  EmissionPoint draw(Random& random) const;

 private:
  EmissionPoint draw(const PointEmission&, Random&) const { return {}; }
  EmissionPoint draw(const LineEmission& line, Random& random) const;
  EmissionPoint draw(const DiscEmission& disc, Random& random) const;
  EmissionPoint draw(const SphereEmission& ball, Random& random) const;
  EmissionPoint draw(const BoxEmission& box, Random& random) const;
  EmissionPoint draw(const MeshSurfaceEmission& surface, Random& random) const;
  EmissionPoint draw(const MeshVolumeEmission& volume, Random& random) const;

  EmissionShapeDef def_;
  std::vector<double> areas_;  ///< cumulative areas of the triangles [m2]
  std::shared_ptr<const Hierarchy> inside_;
};

}  // namespace tumble
