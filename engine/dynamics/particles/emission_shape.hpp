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

// Where an emitter sends out from, in its own frame, whose y axis is the direction of emission.
// Every point of a kind is as likely as any other.

struct PointEmission {
  static constexpr std::string_view type_name = "point";
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
};

/// Along x, the origin in its middle.
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

/// Across y.
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

/// The triangles of a mesh, by their area.
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

/// The list of shapes to emit from; adding one is an alternative at its end (snapshots keep the
/// number), its draw in emission_shape.cpp and its test.
using EmissionShapeDef = std::variant<PointEmission, LineEmission, DiscEmission, SphereEmission,
                                      BoxEmission, MeshSurfaceEmission, MeshVolumeEmission>;

/// The mesh of a definition, null for kinds without.
std::shared_ptr<const TriangleMesh> mesh_of(const EmissionShapeDef& def);
std::shared_ptr<const TriangleMesh>* mesh_of(EmissionShapeDef& def);

/// A point of the shape and the way out there (unit): of surfaces their normal, of a ball away from
/// its centre, else +y.
struct EmissionPoint {
  Vec3 x = Vec3::Zero();
  Vec3 outward = Vec3::UnitY();
};

/// A shape that is ready to be drawn from.
class EmissionShape {
 public:
  /// Errors: a size that is not > 0, a mesh without area or, for its volume, that encloses none or
  /// less than a thousandth of its box.
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
  std::vector<double> areas_;  ///< of the triangles up to this one [m2]
  std::shared_ptr<const Hierarchy> inside_;
};

}  // namespace tumble
