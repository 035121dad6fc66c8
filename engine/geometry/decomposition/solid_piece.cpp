#include "engine/geometry/decomposition/solid_piece.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/geometry/decomposition/tolerances.hpp"
#include "engine/geometry/mesh_sides.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Winding number of a closed surface about a point.
int winding_about(const TriangleMesh& mesh, const Vec3& p) {
  int out = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    out += ray_crossing(p, {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  return out;
}

uint32_t opposite(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][(s % 3 + 2) % 3];
}

/// Planes of the triangles of a mesh. A triangle without area is assigned to the plane of the
/// neighbour across its longest side.
class TrianglePlanes {
 public:
  TrianglePlanes(const TriangleMesh& mesh, std::span<const TriangleSide> mates, ExactSpace& space)
      : mesh_(mesh), stands_for_(mesh.triangles.size()) {
    std::vector<uint32_t> flat;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      plane.push_back(space.add_plane(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)));
      stands_for_[t] = t;
      if (plane[t] == no_index) flat.push_back(t);
    }
    for (size_t round = 0; round < flat.size(); ++round)
      for (const uint32_t t : flat) {
        const TriangleSide m = mates[longest(t)];
        if (plane[t] != no_index || plane[m / 3] == no_index) continue;
        plane[t] = plane[m / 3];
        stands_for_[t] = stands_for_[m / 3];
      }
  }

  std::vector<uint32_t> plane;

  /// A point of a side's face that is not on the line of the side.
  uint32_t apex(TriangleSide s) const {
    const uint32_t t = stands_for_[s / 3];
    if (t == s / 3) return opposite(mesh_, s);
    // The corner farthest from the line, of the triangle to whose plane it is assigned.
    const Vec3 &a = mesh_.vertices[side_start(mesh_, s)], &b = mesh_.vertices[side_end(mesh_, s)];
    return *std::ranges::max_element(mesh_.triangles[t], {}, [&](uint32_t v) {
      return (mesh_.vertices[v] - a).cross(b - a).squaredNorm();
    });
  }

 private:
  TriangleSide longest(uint32_t t) const {
    TriangleSide out = 3 * t;
    const auto length = [&](TriangleSide s) {
      return (mesh_.vertices[side_end(mesh_, s)] - mesh_.vertices[side_start(mesh_, s)]).norm();
    };
    for (const TriangleSide s : {3 * t + 1, 3 * t + 2})
      if (length(s) > length(out)) out = s;
    return out;
  }

  const TriangleMesh& mesh_;
  std::vector<uint32_t> stands_for_;
};

/// A plane through an edge that is nearly perpendicular to that of its face.
uint32_t add_wall(ExactSpace& space, const Vec3& a, const Vec3& b, const Vec3& face_normal) {
  int k = 0;
  face_normal.cwiseAbs().maxCoeff(&k);
  const double length = (b - a).cwiseAbs().maxCoeff();
  return space.add_plane(a, b, a + (a[k] > 0 ? -length : length) * Vec3::Unit(k));
}

std::vector<SolidPiece> connected_surfaces(const SolidPiece& all) {
  DisjointSets faces(all.faces.size());
  for (const SolidPiece::Side& s : all.sides)
    if (!all.faces[s.face].sides.empty()) faces.join(s.face, all.sides[s.mate].face);
  std::vector<SolidPiece> out;
  std::vector<uint32_t> surface(all.faces.size(), no_index), place(all.sides.size());
  for (uint32_t f = 0; f < all.faces.size(); ++f) {
    if (all.faces[f].sides.empty()) continue;
    uint32_t& number = surface[faces.root(f)];
    if (number == no_index) {
      number = uint32_t(out.size());
      out.emplace_back();
    }
    SolidPiece& piece = out[number];
    SolidPiece::Face& face = piece.faces.emplace_back(all.faces[f]);
    for (uint32_t& s : face.sides) {
      place[s] = uint32_t(piece.sides.size());
      piece.sides.push_back(all.sides[s]);
      piece.sides.back().face = uint32_t(piece.faces.size()) - 1;
      s = place[s];
    }
  }
  for (SolidPiece& s : out)
    for (SolidPiece::Side& side : s.sides) side.mate = place[side.mate];
  return out;
}

/// An outer surface with rounded coordinates, and the solid that it bounds.
struct Outer {
  TriangleMesh mesh;
  double volume;
  SolidPiece piece;
};

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

TriangleMesh to_mesh(const ExactSpace& space, const SolidPiece& piece) {
  TriangleMesh out;
  std::vector<uint32_t> points;
  for (const SolidPiece::Side& s : piece.sides) points.push_back(s.start);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const uint32_t p : points) out.vertices.push_back(space.at(p));
  const auto number = [&](uint32_t p) {
    return uint32_t(std::lower_bound(points.begin(), points.end(), p) - points.begin());
  };
  for (const SolidPiece::Face& f : piece.faces) {
    const uint32_t apex = piece.sides[f.sides[0]].start;
    for (const uint32_t s : f.sides) {
      const SolidPiece::Side& side = piece.sides[s];
      if (side.start != apex && side.end != apex)
        out.triangles.push_back({number(apex), number(side.start), number(side.end)});
    }
  }
  return out;
}

namespace {

/// Assigns cavities to the outer surfaces that contain them.
std::vector<SolidPiece> solids_within(const ExactSpace& space, std::span<SolidPiece> surfaces,
                                      double skin, LeftOut* left_out) {
  std::vector<Outer> outer;
  std::vector<SolidPiece> cavities;
  for (SolidPiece& s : surfaces) {
    TriangleMesh mesh = to_mesh(space, s);
    const double volume = enclosed_volume(mesh);
    if (std::fabs(volume) <= skin * surface_area(mesh)) {
      if (left_out) left_out->add(volume);
      continue;
    }
    if (std::ranges::all_of(s.faces, &SolidPiece::Face::cavity)) {
      cavities.push_back(std::move(s));
    } else {
      outer.push_back({std::move(mesh), volume, std::move(s)});
    }
  }
  // A cavity belongs to the smallest solid that contains it.
  for (const SolidPiece& c : cavities) {
    Outer* best = nullptr;
    for (Outer& o : outer)
      if ((!best || o.volume < best->volume) &&
          winding_about(o.mesh, space.at(c.sides[0].start)) > 0)
        best = &o;
    if (!best) continue;
    const auto sides = uint32_t(best->piece.sides.size()),
               first = uint32_t(best->piece.faces.size());
    for (SolidPiece::Side s : c.sides) {
      s.mate += sides;
      s.face += first;
      best->piece.sides.push_back(s);
    }
    for (SolidPiece::Face f : c.faces) {
      for (uint32_t& s : f.sides) s += sides;
      best->piece.faces.push_back(std::move(f));
    }
  }
  std::vector<SolidPiece> out;
  for (Outer& o : outer) out.push_back(std::move(o.piece));
  return out;
}

}  // namespace

Result<Solids> make_solids(const TriangleMesh& mesh, ExactSpace& space, double skin) {
  Solids out;
  const std::vector<TriangleSide> mates = side_mates(mesh);
  const TrianglePlanes planes(mesh, mates, space);
  SolidPiece all;
  all.sides.resize(mates.size());
  all.faces.resize(mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    all.faces[t] = {planes.plane[t], false, false, {3 * t, 3 * t + 1, 3 * t + 2}};
  for (TriangleSide s = 0; s < mates.size(); ++s) {
    const TriangleSide m = mates[s];
    if (m < s) continue;
    const uint32_t a = side_start(mesh, s), b = side_end(mesh, s);
    if (mesh.vertices[a] == mesh.vertices[b] || planes.plane[s / 3] == no_index ||
        planes.plane[m / 3] == no_index)
      return Error{ErrorCode::invalid_argument,
                   fmt::format("triangles {} and {} have no area", s / 3, m / 3),
                   {},
                   "weld vertices and remove triangles without area"};
    const uint32_t plane = planes.plane[s / 3], other = planes.plane[m / 3];
    const uint32_t wall =
        add_wall(space, mesh.vertices[a], mesh.vertices[b], space.plane(plane).normal);
    all.sides[s] = {a, b, m, s / 3, {plane, wall}};
    all.sides[m] = {b, a, s, m / 3, {plane, wall}};
    if (space.side(plane, planes.apex(m)) <= 0) continue;
    all.sides[s].edge = all.sides[m].edge = uint32_t(out.edges.size());
    out.edges.push_back({{a, b}, {plane, other}});
  }
  std::vector<SolidPiece> surfaces = connected_surfaces(all);
  for (SolidPiece& s : surfaces) {
    const bool cavity = enclosed_volume(to_mesh(space, s)) < 0;
    for (SolidPiece::Face& f : s.faces) f.cavity = cavity;
  }
  out.pieces = solids_within(space, surfaces, skin, &out.left_out);
  return out;
}

std::vector<SolidPiece> separate_solids(const ExactSpace& space, const SolidPiece& all, double skin,
                                        LeftOut* left_out) {
  std::vector<SolidPiece> surfaces = connected_surfaces(all);
  return solids_within(space, surfaces, skin, left_out);
}

}  // namespace tumble
