#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

struct MeshData;
/// Meshes are immutable and shared; the renderer uploads each `id` once.
using MeshRef = std::shared_ptr<const MeshData>;

/// Triangles to draw, in the mesh's own frame.
struct MeshData {
  uint64_t id = 0;  ///< hash of the content: equal geometry has equal id; never 0
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;     ///< unit, one per position
  std::vector<uint32_t> indices;  ///< three per triangle, counter-clockwise from outside
  Vec3f min = Vec3f::Zero();      ///< bounds of `positions`
  Vec3f max = Vec3f::Zero();
  float reach = 0;        ///< greatest distance of a position from the origin
  bool two_sided = true;  ///< also draw back faces (open or inconsistently wound meshes)
  /// A coarse version that is not inflated: the inflation is added to its scale.
  bool takes_scale = false;
  /// One triangle (impostor) in which the shader draws the unit sphere per pixel.
  bool ball = false;
  MeshRef coarser;                 ///< cheaper version, or null
  float coarser_below_pixels = 0;  ///< use `coarser` when the bounding radius is under this [px]
  /// ... or when the inflation is: thinner roundings only cause aliasing [px].
  float coarser_below_inflate = 0;
};

/// Checks sizes and indices, computes bounds and id. Returns null if an index is out of range, a
/// position is not finite, or there are fewer normals than positions.
MeshRef make_mesh(std::vector<Vec3f> positions, std::vector<Vec3f> normals,
                  std::vector<uint32_t> indices, bool two_sided = true);

/// The same from bare triangles: the normal at a corner is the angle-weighted mean of the faces
/// around the vertex whose normals differ from its own by at most `crease_deg`; vertices at sharper
/// edges are split.
MeshRef make_mesh_from_triangles(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                                 double crease_deg = 35, bool two_sided = true);

}  // namespace tumble
