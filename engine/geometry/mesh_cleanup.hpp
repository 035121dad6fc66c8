#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <string>

namespace tumble {

/// What cleaning a mesh changed, and what it found that it cannot change.
struct CleanupReport {
  size_t welded_vertices = 0;       ///< joined with another one
  size_t unused_vertices = 0;       ///< that no triangle referred to, removed
  size_t split_triangles = 0;       ///< at a corner of another one that lay on their side
  size_t degenerate_triangles = 0;  ///< without area, removed
  size_t duplicate_triangles = 0;   ///< with the same three corners as another one, removed
  size_t flipped_triangles = 0;     ///< turned so that neighbours agree
  size_t flipped_parts = 0;         ///< closed parts that were inside-out, turned whole
  size_t parts = 0;                 ///< connected by edges
  size_t open_edges = 0;            ///< left, with one face
  size_t holes = 0;                 ///< closed loops of open edges
  size_t non_manifold_edges = 0;    ///< left, with more than two faces
  size_t unorientable_parts = 0;    ///< like a Moebius strip: left as they were

  // The same as lists. Numbers are those of the mesh as it was given, unless said otherwise.
  std::vector<std::array<uint32_t, 2>> welded;      ///< vertex, and the one that it became
  std::vector<uint32_t> unused;                     ///< vertices
  std::vector<uint32_t> degenerate;                 ///< triangles
  std::vector<std::array<uint32_t, 2>> duplicates;  ///< triangle dropped, the one kept
  std::vector<uint32_t> flipped;                    ///< triangles
  std::vector<uint32_t> turned_parts;             ///< the first triangle of each part turned whole
  std::vector<uint32_t> unorientable;             ///< the first triangle of each
  std::vector<std::vector<uint32_t>> hole_loops;  ///< vertices of the cleaned mesh around each hole
  std::vector<uint32_t>
      triangle_origin;  ///< of each triangle of the cleaned mesh: its number before

  bool changed() const {
    return welded_vertices + unused_vertices + split_triangles + degenerate_triangles +
               duplicate_triangles + flipped_triangles + flipped_parts >
           0;
  }
  /// "welded 24 vertices, dropped 2 degenerate triangles; 1 hole of 4 open edges"; empty when
  /// nothing was changed or found.
  std::string text() const;
};

struct CleanupOptions {
  /// Vertices this near are one, and corners this near to a side lie on it [m]; 0: equal ones and
  /// rounding error only; < 0: none.
  double weld_distance = 0;
  /// Triangles are split at T-junctions, open or closed by triangles without area
  /// (close_t_junctions, split_at_slivers); what is left without area is dropped.
  bool drop_degenerate = true;
  bool drop_duplicates = true;
  bool orient = true;  ///< neighbours agree; closed parts enclose positive volume
};

/// Where the vertices and triangles of a mesh being cleaned were before: pass the same one to each
/// step.
struct MeshOrigin {
  std::vector<uint32_t> vertex, triangle;
  explicit MeshOrigin(const TriangleMesh& mesh);
};

/// Joins vertices no further apart than `distance` (transitively), each group at the position of
/// its lowest vertex, and drops unused ones. Returns how many were joined. -0 equals 0.
size_t weld(TriangleMesh& mesh, double distance, MeshOrigin* origin = nullptr,
            std::vector<std::array<uint32_t, 2>>* welded = nullptr);

/// Drops triangles with a repeated corner or whose height is below 1e-15 of their longest side.
size_t drop_degenerate_triangles(TriangleMesh& mesh, MeshOrigin* origin = nullptr,
                                 std::vector<uint32_t>* dropped = nullptr);
/// Of triangles with the same three corners, in any order, the first is kept.
size_t drop_duplicate_triangles(TriangleMesh& mesh, MeshOrigin* origin = nullptr,
                                std::vector<std::array<uint32_t, 2>>* dropped = nullptr);
size_t drop_unused_vertices(TriangleMesh& mesh, MeshOrigin* origin = nullptr,
                            std::vector<uint32_t>* dropped = nullptr);

/// Number of the connected part of each triangle (over shared edges), in order of first triangle.
std::vector<uint32_t> connected_parts(const TriangleMesh& mesh, size_t* count = nullptr);
/// One mesh for each connected part.
std::vector<TriangleMesh> split_parts(const TriangleMesh& mesh);

/// Loops of open edges, each as the vertices around one hole, in the direction of their faces
/// (in either where the mesh is misoriented). Where holes touch in a vertex they are cut apart
/// there.
std::vector<std::vector<uint32_t>> find_holes(const TriangleMesh& mesh);

/// All of the above in a fixed order on a mesh that passed validate(): weld, split, drop, orient,
/// count. A mesh may lose all its triangles; validate() says so afterwards.
CleanupReport clean_up(TriangleMesh& mesh, const CleanupOptions& options = {});

}  // namespace tumble
