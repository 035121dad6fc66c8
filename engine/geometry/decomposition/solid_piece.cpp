#include "engine/geometry/decomposition/solid_piece.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/geometry/decomposition/tolerances.hpp"
#include "engine/geometry/mesh_sides.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// One connected surface.
struct Surface {
  SolidPiece piece;
  double volume = 0;
};

/// Numbers of the groups of a partition in order of their first members.
std::vector<uint32_t> numbered(DisjointSets& sets, size_t count, uint32_t& groups) {
  std::vector<uint32_t> number(count, no_index), out(count);
  groups = 0;
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t& n = number[sets.root(i)];
    if (n == no_index) n = groups++;
    out[i] = n;
  }
  return out;
}

/// How often a closed surface winds around a point.
int winding_about(const TriangleMesh& mesh, const Vec3& p) {
  int out = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    out += ray_crossing(p, {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  return out;
}

/// Connected surfaces, with vertices of their own.
std::vector<Surface> connected_surfaces(const TriangleMesh& mesh, std::span<const uint32_t> planes,
                                        std::span<const TriangleSide> mates) {
  const size_t triangles = mesh.triangles.size();
  DisjointSets corners(3 * triangles), faces(triangles);
  for (TriangleSide s = 0; s < 3 * triangles; ++s) {
    const TriangleSide m = mates[s];
    if (m == no_index || m < s) continue;
    const auto end = [](TriangleSide side) { return side / 3 * 3 + (side % 3 + 1) % 3; };
    corners.join(s, end(m));
    corners.join(end(s), m);
    faces.join(s / 3, m / 3);
  }
  uint32_t vertex_count = 0, surface_count = 0;
  const std::vector<uint32_t> vertex = numbered(corners, 3 * triangles, vertex_count);
  const std::vector<uint32_t> surface = numbered(faces, triangles, surface_count);
  std::vector<Surface> out(surface_count);
  std::vector<uint32_t> place(triangles);  // of each triangle in its surface
  std::vector<uint32_t> local(vertex_count, no_index);
  for (size_t t = 0; t < triangles; ++t) {
    SolidPiece& piece = out[surface[t]].piece;
    Triangle corner;
    for (size_t k = 0; k < 3; ++k) {
      uint32_t& number = local[vertex[3 * t + k]];
      if (number == no_index) {
        number = uint32_t(piece.mesh.vertices.size());
        piece.mesh.vertices.push_back(mesh.corner(t, k));
      }
      corner[k] = number;
    }
    place[t] = uint32_t(piece.mesh.triangles.size());
    piece.mesh.triangles.push_back(corner);
    piece.plane.push_back(planes[t]);
  }
  for (TriangleSide s = 0; s < 3 * triangles; ++s)
    out[surface[s / 3]].piece.mates.push_back(
        mates[s] == no_index ? no_index : 3 * place[mates[s] / 3] + mates[s] % 3);
  for (Surface& s : out) s.volume = enclosed_volume(s.piece.mesh);
  return out;
}

}  // namespace

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Vec3 about = mesh.corner(0, 0);
  double six = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - about, b = mesh.corner(t, 1) - about,
               c = mesh.corner(t, 2) - about;
    six += a.dot(b.cross(c));
  }
  return six / 6;
}

std::vector<TriangleSide> side_mates(const TriangleMesh& mesh) {
  std::vector<TriangleSide> out(3 * mesh.triangles.size(), no_index);
  const std::vector<MeshSide> sides = sorted_sides(mesh);
  for (size_t first = 0; first < sides.size();) {
    size_t end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low &&
           sides[end].high == sides[first].high)
      ++end;
    if (end == first + 2 && sides[first].forward != sides[first + 1].forward) {
      const TriangleSide a = 3 * sides[first].face + sides[first].k,
                         b = 3 * sides[first + 1].face + sides[first + 1].k;
      out[a] = b;
      out[b] = a;
    }
    first = end;
  }
  return out;
}

std::vector<SolidPiece> separate_solids(const TriangleMesh& mesh, std::span<const uint32_t> planes,
                                        std::span<const TriangleSide> mates, double tolerance,
                                        double& lost) {
  std::vector<Surface> surfaces = connected_surfaces(mesh, planes, mates);
  std::vector<SolidPiece> out;
  std::vector<double> volumes;
  for (Surface& s : surfaces) {
    if (std::fabs(s.volume) <= tolerances::skin * tolerance * surface_area(s.piece.mesh)) {
      lost += s.volume;
    } else if (s.volume > 0) {
      volumes.push_back(s.volume);
      out.push_back(std::move(s.piece));
    }
  }
  // A cavity belongs to the smallest solid around it. Pieces of the solids stay as they are while
  // cavities are given out: only the surfaces that were there at first count.
  const std::vector<SolidPiece> outer = out;
  for (Surface& s : surfaces) {
    if (s.piece.mesh.triangles.empty() || s.volume > 0 ||
        std::fabs(s.volume) <= tolerances::skin * tolerance * surface_area(s.piece.mesh))
      continue;
    size_t best = outer.size();
    for (size_t n = 0; n < outer.size(); ++n)
      if (winding_about(outer[n].mesh, s.piece.mesh.vertices[0]) > 0 &&
          (best == outer.size() || volumes[n] < volumes[best]))
        best = n;
    if (best == outer.size()) {
      lost += s.volume;
      continue;
    }
    const auto before = TriangleSide(out[best].mates.size());
    for (const TriangleSide m : s.piece.mates) out[best].mates.push_back(before + m);
    append(out[best].mesh, s.piece.mesh);
    out[best].plane.insert(out[best].plane.end(), s.piece.plane.begin(), s.piece.plane.end());
  }
  return out;
}

}  // namespace tumble
