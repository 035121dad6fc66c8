#pragma once
#include "engine/scene/description/material.hpp"
#include "engine/scene/description/placement.hpp"

#include <variant>

namespace tumble {

/// How a mesh collides.
enum class MeshMode : uint8_t {
  triangle_mesh,  ///< as it is
  convex_hull,    ///< as its convex hull
};
template <>
struct EnumNames<MeshMode> {
  static constexpr std::array<std::pair<std::string_view, MeshMode>, 2> values = {
      {{"triangle_mesh", MeshMode::triangle_mesh}, {"convex_hull", MeshMode::convex_hull}}};
};

enum class UpAxis : uint8_t { y, z, x };
template <>
struct EnumNames<UpAxis> {
  static constexpr std::array<std::pair<std::string_view, UpAxis>, 3> values = {
      {{"y", UpAxis::y}, {"z", UpAxis::z}, {"x", UpAxis::x}}};
};

/// A mesh file that shapes refer to by name. In a file a bare string stands for {"file": string}.
struct MeshDescription {
  std::string file;
  double scale = 1;
  std::optional<Vec3> stretch;
  UpAxis up = UpAxis::y;
  MeshMode mode = MeshMode::triangle_mesh;
  bool centre = false;
  std::optional<double> weld;

  static constexpr std::string_view shorthand_key = "file";
  static constexpr std::string_view schema_name = "mesh";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.file, {.name = "file",
                     .required = true,
                     .doc = "path from the scene's folder, or a name under assets/meshes"});
    v.field(d.scale,
            {.name = "scale", .min = 1e-9, .max = 1e9, .doc = "metres per unit of the file"});
    v.field(d.stretch, {.name = "stretch",
                        .min = -1e6,
                        .max = 1e6,
                        .doc = "further factors along x, y, z, after up; a negative one mirrors"});
    v.field(d.up, {.name = "up", .doc = "axis of the file that points up"});
    v.field(d.mode, {.name = "mode", .doc = "how shapes of type mesh collide"});
    v.field(d.centre, {.name = "centre", .doc = "move the middle of the bounds to the origin"});
    v.field(d.weld, {.name = "weld",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .doc = "vertices this near are one, and corners this near to a side lie on "
                            "it; a billionth of the mesh's size unless given"});
  }
  static void check(const MeshDescription& d, Complaints& complaints) {
    if (d.stretch && (d.stretch->array() == 0).any())
      complaints.add("stretch", "a factor of 0 makes the mesh flat");
  }
};

struct SphereShapeDescription {
  static constexpr std::string_view type_name = "sphere";
  double radius = 0.5;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.radius, {.name = "radius",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "radius"});
  }
};

struct CapsuleShapeDescription {
  static constexpr std::string_view type_name = "capsule";
  double radius = 0.5, height = 1;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    SphereShapeDescription::parameters(v, d);
    v.field(d.height, {.name = "height",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "between the centres of the two caps, along y"});
  }
};

struct BoxShapeDescription {
  static constexpr std::string_view type_name = "box";
  Vec3 size{1, 1, 1};
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.size, {.name = "size",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .exclusive_min = true,
                     .required = true,
                     .doc = "full extents along x, y, z"});
  }
};

struct CylinderShapeDescription {
  static constexpr std::string_view type_name = "cylinder";
  double radius = 0.5, height = 1;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    SphereShapeDescription::parameters(v, d);
    v.field(d.height, {.name = "height",
                       .unit = "m",
                       .min = 0,
                       .max = 1e6,
                       .exclusive_min = true,
                       .required = true,
                       .doc = "full height along y"});
  }
};

struct EllipsoidShapeDescription {
  static constexpr std::string_view type_name = "ellipsoid";
  Vec3 semi_axes{0.5, 0.5, 0.5};
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.semi_axes, {.name = "semi_axes",
                          .unit = "m",
                          .min = 0,
                          .max = 1e6,
                          .exclusive_min = true,
                          .required = true,
                          .doc = "from the centre to the surface along x, y, z"});
  }
};

struct HalfSpaceShapeDescription {
  static constexpr std::string_view type_name = "half_space";
  template <class Visitor, class Self>
  static void parameters(Visitor&, Self&) {}
};

struct ConvexHullShapeDescription {
  static constexpr std::string_view type_name = "convex_hull";
  std::vector<Vec3> points;
  std::string mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.points, {.name = "points",
                       .unit = "m",
                       .min = -1e6,
                       .max = 1e6,
                       .doc = "at least four, not in one plane"});
    v.field(d.mesh, {.name = "mesh", .doc = "instead of points: name of a mesh"});
  }
  static void check(const ConvexHullShapeDescription& d, Complaints& complaints) {
    if (d.points.empty() == d.mesh.empty())
      complaints.add("", "a convex_hull needs either points or mesh");
    else if (d.mesh.empty() && d.points.size() < 4)
      complaints.add("points",
                     "a hull needs at least 4 points, got " + std::to_string(d.points.size()));
  }
};

struct TriangleMeshShapeDescription {
  static constexpr std::string_view type_name = "triangle_mesh";
  std::string mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.mesh, {.name = "mesh", .required = true, .doc = "name of a mesh"});
  }
};

/// A mesh that collides as its declaration says.
struct MeshShapeDescription {
  static constexpr std::string_view type_name = "mesh";
  std::string mesh;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    TriangleMeshShapeDescription::parameters(v, d);
  }
};

using ShapeKind =
    std::variant<SphereShapeDescription, CapsuleShapeDescription, BoxShapeDescription,
                 CylinderShapeDescription, EllipsoidShapeDescription, HalfSpaceShapeDescription,
                 ConvexHullShapeDescription, TriangleMeshShapeDescription, MeshShapeDescription>;

/// One shape of a body, placed in the body frame.
struct ShapeDescription {
  ShapeKind kind;
  Placement placement;
  std::optional<MaterialDescription> material;

  static constexpr std::string_view schema_name = "shape";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of shape"});
    v.part(d.placement);
    v.object(d.material, {.name = "material", .doc = "instead of the body's"});
  }
};

}  // namespace tumble
