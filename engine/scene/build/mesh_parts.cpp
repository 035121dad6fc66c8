#include "engine/scene/build/mesh_parts.hpp"

#include "engine/collision/fitting/solid_error.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/scene/build/field_cache.hpp"
#include "engine/scene/build/fit_cache.hpp"
#include "engine/scene/build/piece_cache.hpp"
#include "engine/scene/description/shape.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

ShapeDef of_mesh(ShapeType type, std::shared_ptr<const TriangleMesh> mesh) {
  ShapeDef out;
  out.type = type;
  out.mesh = std::move(mesh);
  return out;
}

/// Errors below this share of a mesh's diagonal are those of the six digits with which files are
/// written [-].
constexpr double as_written = 2e-6;

bool negligible(double error, const TriangleMesh& mesh) {
  return error <= as_written * bounds(mesh).extent().norm();
}

Result<MeshParts> convex_pieces(const std::shared_ptr<const TriangleMesh>& mesh, MeshParts out) {
  ApproximateDecompositionOptions options;
  options.concavity = out.how.concavity;
  if (out.how.pieces > 0) options.max_pieces = out.how.pieces;
  const auto made = PieceCache().pieces(mesh, options);
  if (!made) return made.error();
  out.how.concavity = made->concavity;
  if (!negligible(std::max(made->added, made->missing), *mesh))
    out.note = fmt::format(
        "approximate: touches as convex pieces ({}), which reach {:.3g} m outside the mesh and "
        "leave {:.3g} m of it out{}",
        made->pieces.size(), made->added, made->missing,
        made->bound_met ? ""
                        : fmt::format("; a concavity of {:.3g} m takes more", made->concavity));
  for (const MeshPieces::Piece& p : made->pieces) {
    auto corners = std::make_shared<TriangleMesh>();
    corners->vertices = p.vertices;
    out.parts.push_back({of_mesh(ShapeType::convex_hull, std::move(corners)),
                         {},
                         p.volume > 0 && p.solid > 0 ? p.solid / p.volume : 1});
  }
  return out;
}

Result<MeshParts> field_of_mesh(const std::shared_ptr<const TriangleMesh>& mesh, MeshParts out) {
  DistanceFieldOptions options;
  options.cell = out.how.cell;
  out.how.cell = field_cell(options, bounds(*mesh));
  const auto made = FieldCache().field(mesh, out.how.cell);
  if (!made) return made.error();
  out.note = fmt::format(
      "approximate: touches as a distance field with cells of {:.3g} m, which errs by {:.2g} m at "
      "most",
      out.how.cell, field_error(out.how.cell));
  ShapeDef shape = of_mesh(ShapeType::distance_field, mesh);
  shape.cell = out.how.cell;
  shape.field = *made;
  out.parts.push_back({std::move(shape), {}, 1});
  return out;
}

Result<MeshParts> fitted_primitive(const std::shared_ptr<const TriangleMesh>& mesh, MeshParts out) {
  const auto fit = FitCache().fit(mesh);
  if (!fit) return fit.error();
  const auto shape = make_shape(fit->shape);
  if (!shape) return shape.error();
  const bool solid = fit->mesh_volume > 0 && fit->volume > 0;
  out.note = fmt::format(
      "approximate: touches as a {}, which reaches {:.3g} m outside the mesh and leaves {:.3g} m "
      "of it out{}",
      (*shape)->words(), fit->error.added, fit->error.missing,
      solid ? fmt::format("; its volume is {:.3g} times the mesh's", fit->volume / fit->mesh_volume)
            : "");
  out.parts.push_back({fit->shape, fit->pose, solid ? fit->mesh_volume / fit->volume : 1});
  return out;
}

}  // namespace

std::string hull_note(const std::shared_ptr<const TriangleMesh>& mesh) {
  const auto hull = make_shape(of_mesh(ShapeType::convex_hull, mesh));
  if (!hull) return {};
  const bool closed = build_topology(*mesh).closed_and_oriented();
  const auto of_hull = (*hull)->mass_properties();
  const auto volume = closed ? mesh_mass(*mesh) : Result<MassProperties>(Error{});
  const double more = of_hull && volume && volume->mass > 0 ? of_hull->mass / volume->mass : 0;
  // If the volumes are equal, nothing is outside and no samples are needed.
  constexpr double same_volume = 1e-9;
  if (more > 0 && more < 1 + same_volume) return {};
  const PlacedShape placed{*hull, {}};
  const SolidError error = solid_error({&placed, 1}, AabbTree(mesh), closed, 2000);
  if (negligible(error.added, *mesh)) return {};
  return fmt::format(
      "approximate: touches as its convex hull, which reaches {:.3g} m outside the mesh; mass and "
      "inertia, unless given, are the hull's{}",
      error.added, more > 0 ? fmt::format(", {:.3g} times the mesh's volume", more) : "");
}

Result<MeshParts> mesh_parts(const std::shared_ptr<const TriangleMesh>& mesh,
                             const MeshRepresentation& how) {
  MeshParts out;
  out.how = how;
  switch (how.mode) {
    case MeshMode::decomposition:
      return convex_pieces(mesh, std::move(out));
    case MeshMode::field:
      return field_of_mesh(mesh, std::move(out));
    case MeshMode::fit:
      return fitted_primitive(mesh, std::move(out));
    case MeshMode::convex_hull:
      out.note = hull_note(mesh);
      out.parts.push_back({of_mesh(ShapeType::convex_hull, mesh), {}, 1});
      break;
    case MeshMode::triangle_mesh:
      out.parts.push_back({of_mesh(ShapeType::triangle_mesh, mesh), {}, 1});
      break;
  }
  return out;
}

void append_mesh_parts(std::vector<BodyShapeDef>& shapes, const BodyShapeDef& whole,
                       const std::shared_ptr<const TriangleMesh>& mesh, const MeshParts& parts) {
  const auto source = std::make_shared<const MeshSource>(MeshSource{mesh, whole.pose, parts.how});
  for (const MeshPart& p : parts.parts) {
    BodyShapeDef& part = shapes.emplace_back(whole);
    part.shape = p.shape;
    part.pose = whole.pose * p.pose;
    part.material.density *= p.filled;
    part.filled = p.filled;
    part.source = source;
  }
}

std::vector<ShapeGroup> shape_groups(const BodyDef& def) {
  std::vector<ShapeGroup> out;
  for (size_t i = 0; i < def.shapes.size(); ++i) {
    const auto& source = def.shapes[i].source;
    if (i > 0 && source && source == def.shapes[i - 1].source)
      ++out.back().count;
    else
      out.push_back({i, 1});
  }
  return out;
}

std::shared_ptr<const MeshSource> source_of(const BodyDef& def, const ShapeGroup& group) {
  const BodyShapeDef& first = def.shapes[group.first];
  if (first.source) return first.source;
  if (!first.shape.mesh || first.shape.mesh->triangles.empty()) return nullptr;
  MeshSource out{first.shape.mesh, first.pose, {}};
  out.how.mode = first.shape.type == ShapeType::convex_hull      ? MeshMode::convex_hull
                 : first.shape.type == ShapeType::distance_field ? MeshMode::field
                                                                 : MeshMode::triangle_mesh;
  out.how.cell = first.shape.cell;
  return std::make_shared<const MeshSource>(std::move(out));
}

void replace_group(BodyDef& def, size_t group, const MeshParts& parts) {
  const std::vector<ShapeGroup> groups = shape_groups(def);
  if (group >= groups.size()) return;
  const auto [first, count] = groups[group];
  const auto source = source_of(def, groups[group]);
  if (!source) return;
  BodyShapeDef whole = def.shapes[first];
  whole.pose = source->pose;
  whole.material.density /= whole.filled;
  std::vector<BodyShapeDef> shapes(def.shapes.begin(), def.shapes.begin() + std::ptrdiff_t(first));
  append_mesh_parts(shapes, whole, source->mesh, parts);
  shapes.insert(shapes.end(), def.shapes.begin() + std::ptrdiff_t(first + count), def.shapes.end());
  def.shapes = std::move(shapes);
}

}  // namespace tumble
