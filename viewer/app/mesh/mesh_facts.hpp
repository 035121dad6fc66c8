#pragma once
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "engine/scene/build/mesh_representations.hpp"
#include "engine/scene/mesh_import.hpp"
#include "viewer/app/mesh/hierarchy_facts.hpp"
#include "viewer/app/mesh/mesh_field.hpp"
#include "viewer/app/mesh/mesh_fit.hpp"
#include "viewer/app/mesh/mesh_pieces.hpp"
#include "viewer/app/mesh/mesh_wrap.hpp"

#include <memory>
#include <optional>

namespace tumble {

/// Convex hull of a mesh, or the reason why there is none.
struct HullFacts {
  size_t vertices = 0, facets = 0;
  double volume = 0, area = 0;
  MassProperties mass;
  std::string missing;  ///< empty when there is a hull
};

/// Everything that `tumble mesh` reports about a file; it refers to the mesh after the clean-up of
/// loading.
struct MeshFacts {
  std::string file, format;
  double density = 1;  ///< [kg/m3]
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<ImportedPart> parts;
  CleanupReport cleanup;
  std::vector<std::string> notes;
  MeshTopology topology;
  std::vector<std::vector<uint32_t>> holes;
  SolidReport solid;
  Aabb box;
  double area = 0;                                 ///< [m2]
  Result<MassProperties> mass = MassProperties{};  ///< of the solid, at `density`
  PrincipalAxes principal;
  HullFacts hull;
  std::vector<HierarchyFacts> hierarchies;
  std::optional<WrapFacts> wrap;                     ///< if `mesh` is a wrap of the file's mesh
  std::optional<PiecesFacts> pieces;                 ///< when asked for
  std::optional<FieldFacts> field;                   ///< when asked for
  std::optional<FitFacts> fit;                       ///< when asked for
  std::vector<RepresentationFacts> representations;  ///< when asked for
};

/// Computes all facts, and tells its progress; the mesh must have been imported without errors.
MeshFacts mesh_facts(std::string file, ImportedMesh imported, double density);

std::string mesh_text(const MeshFacts& facts);
/// The facts as one JSON object; its keys are listed in the command's help and never change their
/// meaning.
std::string mesh_json(const MeshFacts& facts, const std::string& picture);

}  // namespace tumble
