#pragma once
#include "engine/collision/shape.hpp"
#include "engine/dynamics/bodies/mesh_source.hpp"
#include "engine/scene/description/material.hpp"
#include "engine/scene/description/placement.hpp"

#include <type_traits>
#include <utility>
#include <variant>

namespace tumble {

/// The fault of a shape whose numbers are each in range; "": none.
std::string shape_fault(const ShapeDef& def);

template <>
struct EnumNames<MeshMode> {
  static constexpr std::array<std::pair<std::string_view, MeshMode>, mesh_mode_count> values = {
      {{"triangle_mesh", MeshMode::triangle_mesh},
       {"convex_hull", MeshMode::convex_hull},
       {"decomposition", MeshMode::decomposition},
       {"field", MeshMode::field},
       {"fit", MeshMode::fit}}};
};

/// How a mesh collides, with the parameters of that mode: for all shapes that refer to a mesh, or
/// for one such shape.
struct MeshModeDescription {
  std::optional<MeshMode> mode;
  std::optional<double> concavity;
  std::optional<int> pieces;
  std::optional<double> cell;
  std::optional<double> error;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.mode, {.name = "mode",
                     .doc = "how shapes of type mesh collide; triangle_mesh unless given, of a "
                            "shape as its mesh says"});
    v.field(d.concavity,
            {.name = "concavity",
             .unit = "m",
             .min = 1e-9,
             .max = 1e6,
             .doc = "of mode decomposition: pieces reach no farther outside the mesh; a fiftieth "
                    "of its diagonal unless given"});
    v.field(d.pieces, {.name = "pieces",
                       .min = 1,
                       .max = 1000,
                       .doc = "of mode decomposition: no more than this; 64 unless given"});
    v.field(d.cell, {.name = "cell",
                     .unit = "m",
                     .min = 1e-9,
                     .max = 1e6,
                     .doc = "of mode field: side of its cells; a 64th of the mesh's longest side "
                            "unless given"});
    v.field(d.error, {.name = "error",
                      .unit = "m",
                      .min = 1e-9,
                      .max = 1e6,
                      .doc = "of mode field, instead of cell: distances err by no more"});
  }
  static void check(const MeshModeDescription& d, Complaints& complaints) {
    if (d.mode != MeshMode::field) {
      if (d.cell) complaints.add("cell", "only mode field has cells");
      if (d.error) complaints.add("error", "only mode field has an error to choose");
    }
    if (d.cell && d.error) complaints.add("error", "give either cell or error");
    if (d.mode == MeshMode::decomposition) return;
    if (d.concavity) complaints.add("concavity", "only mode decomposition has pieces");
    if (d.pieces) complaints.add("pieces", "only mode decomposition has pieces");
  }
};

enum class UpAxis : uint8_t { y, z, x };
template <>
struct EnumNames<UpAxis> {
  static constexpr std::array<std::pair<std::string_view, UpAxis>, 3> values = {
      {{"y", UpAxis::y}, {"z", UpAxis::z}, {"x", UpAxis::x}}};
};

/// A closed surface that replaces a mesh that is open or broken; values not given are derived from
/// the size of the mesh (geometry/wrap/wrap_mesh.hpp).
struct WrapDescription {
  std::optional<double> gap;
  std::optional<double> offset;
  std::optional<double> cell;

  static constexpr std::string_view schema_name = "wrap";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.gap, {.name = "gap",
                    .unit = "m",
                    .min = 1e-9,
                    .max = 1e6,
                    .doc = "holes and slits that a ball of this diameter does not pass are closed; "
                           "a 12th of the mesh's longest side unless given"});
    v.field(d.offset,
            {.name = "offset",
             .unit = "m",
             .min = 1e-9,
             .max = 1e6,
             .doc = "how far the wrap stands off the mesh; a quarter of a cell unless given"});
    v.field(d.cell,
            {.name = "cell",
             .unit = "m",
             .min = 1e-9,
             .max = 1e6,
             .doc = "side of its cells; a quarter of gap, but from a 128th to a 40th of the "
                    "mesh's longest side unless given"});
  }
};

/// A mesh file that shapes refer to by name. In a file a bare string stands for {"file": string}.
struct MeshDescription {
  std::string file;
  double scale = 1;
  std::optional<Vec3> stretch;
  UpAxis up = UpAxis::y;
  MeshModeDescription how;
  bool centre = false;
  std::optional<double> weld;
  std::optional<WrapDescription> wrap;

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
    v.part(d.how);
    v.field(d.centre, {.name = "centre", .doc = "move the middle of the bounds to the origin"});
    v.field(d.weld, {.name = "weld",
                     .unit = "m",
                     .min = 0,
                     .max = 1e6,
                     .doc = "vertices this near are one, and corners this near to a side lie on "
                            "it; a billionth of the mesh's size unless given"});
    v.object(d.wrap, {.name = "wrap",
                      .doc = "a closed surface about the mesh takes its place; {} is enough"});
  }
  static void check(const MeshDescription& d, Complaints& complaints) {
    if (d.stretch && (d.stretch->array() == 0).any())
      complaints.add("stretch", "a factor of 0 makes the mesh flat");
  }
};

/// A shape defined by its own numbers only: entry `place` of all_shapes(), which names them.
template <size_t place>
struct ListedShapeDescription {
  ShapeDef def = fresh();

  static const ShapeEntry& entry() { return all_shapes()[place]; }
  static std::string_view type_name() { return entry().name; }
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    for (const ShapeParameter& p : entry().parameters) {
      if (p.number) show(v, d.def.*p.number, p);
      if (p.vector) show(v, d.def.*p.vector, p);
    }
  }
  static void check(const ListedShapeDescription& d, Complaints& complaints) {
    const std::string fault = shape_fault(d.def);
    if (!fault.empty()) complaints.add("", fault);
  }

 private:
  static ShapeDef fresh() {
    ShapeDef def;
    def.type = entry().type;
    return def;
  }
  /// Files give full extents where definitions have halves.
  template <class Visitor, class Value>
  static void show(Visitor& v, Value& held, const ShapeParameter& p) {
    std::remove_const_t<Value> shown = held / p.factor;
    v.field(shown, p.parameter);
    if constexpr (!std::is_const_v<Value>) held = p.factor * shown;
  }
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

/// A mesh that collides as its declaration says, or in a mode of its own.
struct MeshShapeDescription {
  static constexpr std::string_view type_name = "mesh";
  std::string mesh;
  MeshModeDescription how;
  std::optional<WrapDescription> wrap;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    TriangleMeshShapeDescription::parameters(v, d);
    v.part(d.how);
    v.object(d.wrap, {.name = "wrap",
                      .doc = "a closed surface about the mesh takes its place; {} is enough"});
  }
};

template <class Places>
struct ShapeKinds;
template <size_t... place>
struct ShapeKinds<std::index_sequence<place...>> {
  using type = std::variant<ListedShapeDescription<place>..., ConvexHullShapeDescription,
                            TriangleMeshShapeDescription, MeshShapeDescription>;
};
using ShapeKind = ShapeKinds<std::make_index_sequence<shape_type_count - mesh_shape_count>>::type;

/// The description of a definition without a mesh.
ShapeKind shape_kind(const ShapeDef& def);

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

/// A shape that is drawn but does not collide, placed in the body frame.
struct DrawnDescription {
  ShapeKind kind;
  Placement placement;
  std::optional<Colour> colour;

  static constexpr std::string_view schema_name = "drawn";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.one_of(d.kind, {.name = "type", .required = true, .doc = "kind of shape"});
    v.part(d.placement);
    v.field(d.colour, {.name = "colour", .doc = "instead of the body's"});
  }
};

}  // namespace tumble
