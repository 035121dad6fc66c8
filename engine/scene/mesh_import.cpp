#include "engine/scene/mesh_import.hpp"

#include "engine/core/watched.hpp"
#include "engine/geometry/constructions/triangulate_polygon.hpp"
#include "engine/geometry/mesh_orientation.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/scene/mesh_files/formats.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

Vec3 turned(const Vec3& v, UpAxis up) {
  switch (up) {
    case UpAxis::z:
      return {v.x(), v.z(), -v.y()};
    case UpAxis::x:
      return {-v.y(), v.x(), v.z()};
    case UpAxis::y:
      break;
  }
  return v;
}

/// The triangles of one part with their own copies of vertices; polygons that refer to missing
/// corners are counted and left out.
TriangleMesh part_mesh(PolygonFile& file, size_t part) {
  const auto& p = file.parts[part];
  const bool last = part + 1 == file.parts.size();
  const size_t vertex_end = last ? file.vertices.size() : file.parts[part + 1].first_vertex;
  const size_t polygon_end = last ? file.polygon_count() : file.parts[part + 1].first_polygon;
  TriangleMesh out;
  out.vertices.assign(file.vertices.begin() + std::ptrdiff_t(p.first_vertex),
                      file.vertices.begin() + std::ptrdiff_t(vertex_end));
  std::vector<uint32_t> corners;
  for (size_t f = p.first_polygon; f < polygon_end; ++f) {
    corners.assign(file.corners.begin() + std::ptrdiff_t(file.polygon_first[f]),
                   file.corners.begin() + std::ptrdiff_t(file.polygon_first[f + 1]));
    bool there = true;
    for (uint32_t& c : corners) {
      there = there && c >= p.first_vertex && c < vertex_end;
      c -= uint32_t(p.first_vertex);
    }
    if (!there) {
      ++file.dropped_polygons;
      continue;
    }
    triangulate_polygon(out.vertices, corners, out.triangles);
  }
  return out;
}

void add(CleanupReport& to, const CleanupReport& from) {
  to.welded_vertices += from.welded_vertices;
  to.unused_vertices += from.unused_vertices;
  to.split_triangles += from.split_triangles;
  to.degenerate_triangles += from.degenerate_triangles;
  to.duplicate_triangles += from.duplicate_triangles;
}

/// Default distance for welding, and the greatest allowed, over the largest extent [-].
constexpr double default_weld = 1e-9, most_weld = 0.01;

/// Joins the parts. Closed parts are not welded to others even if they touch; open ones, such as
/// the faces of a box with different materials, are welded to each other.
ImportedMesh join(PolygonFile& file, double weld) {
  ImportedMesh out;
  TriangleMesh open;
  CleanupReport done;
  for (size_t i = 0; i < file.parts.size(); ++i) {
    TriangleMesh part = part_mesh(file, i);
    if (part.triangles.empty()) continue;
    out.parts.push_back({file.parts[i].name, part.triangles.size()});
    add(done, clean_up(part, {.weld_distance = weld, .orient = false}));
    append(build_topology(part).closed() ? out.mesh : open, part);
  }
  add(done, clean_up(open, {.weld_distance = weld, .orient = false}));
  append(out.mesh, open);
  out.cleanup =
      clean_up(out.mesh, {.weld_distance = -1, .drop_degenerate = false, .drop_duplicates = false});
  add(out.cleanup, done);
  return out;
}

}  // namespace

Result<ImportedMesh> import_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  if (const Status there = check_mesh_file(file); !there) return there.error();
  const auto format = mesh_format_of(file);
  if (!format) return format.error();
  auto read = (*format)->read(file);
  if (!read) return read.error();
  tell_progress(0.3);
  for (size_t i = 0; i < read->vertices.size(); ++i) {
    Vec3& v = read->vertices[i];
    if (!v.allFinite()) {
      return mesh_file_fault(
          file, fmt::format("vertex {} is ({}, {}, {}), not finite", i, v.x(), v.y(), v.z()));
    }
    v = options.stretch.cwiseProduct(options.scale * turned(v, options.up));
  }
  Aabb box;
  for (const Vec3& v : read->vertices) box.include(v);
  const double size = read->vertices.empty() ? 0 : box.extent().maxCoeff();
  const double most = 2 * MeshLimits{}.max_coordinate;
  if (size > most)
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the mesh is {:.6g} m large; at most {} m are allowed", size, most),
                 file.string(), "give it a smaller \"scale\""};
  const double weld = options.weld.value_or(default_weld * size);
  if (!(weld >= 0 && weld <= most_weld * size) && size > 0) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("weld is {} m, and the whole mesh {} m", weld, size), file.string(),
                 "give a distance from 0 to a hundredth of the mesh's size"};
  }
  ImportedMesh out = join(*read, weld);
  if (out.parts.empty()) return mesh_file_fault(file, "the file has no triangles");
  if (out.mesh.triangles.empty()) {
    return mesh_file_fault(file, "all triangles of the file are without area");
  }
  const Vec3 factors = options.scale * options.stretch;
  const bool mirrored = factors.x() * factors.y() * factors.z() < 0;
  if (mirrored && !build_topology(out.mesh).closed()) flip(out.mesh);
  if (options.centre) {
    const Vec3 middle = bounds(out.mesh).centre();
    for (Vec3& v : out.mesh.vertices) v -= middle;
  }
  if (const Status ok = validate(out.mesh); !ok) {
    return Error{ok.error().code, ok.error().message, file.string(), ok.error().cure};
  }
  if (read->dropped_polygons > 0) {
    out.notes.push_back(fmt::format(
        "{} faces refer to vertices that do not exist and were left out", read->dropped_polygons));
  }
  // Duplicate vertices are normal in files, and open surfaces may be intended: neither is reported.
  CleanupReport unusual = out.cleanup;
  unusual.welded_vertices = unusual.unused_vertices = unusual.open_edges = unusual.holes = 0;
  if (const std::string text = unusual.text(); !text.empty()) out.notes.push_back(text);
  return out;
}

}  // namespace tumble
