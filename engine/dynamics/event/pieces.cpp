#include "engine/dynamics/event/pieces.hpp"

#include "engine/collision/mesh_pairs/near_triangles.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/core_gap.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace tumble {
namespace {

const MeshSurface& surface_of(const Shape& s) {
  return s.polyhedral()->surface();
}

/// One piece, with its place in a frame with world axes.
struct Piece {
  std::optional<TriangleCore> triangle;
  PlacedCore core;
  double rounding = 0, size = 0;
  Vec3 face = Vec3::Zero();  ///< normal of a triangle

  Piece(const Shape& s, uint32_t id, const Quat& q, const Vec3& x) {
    if (id == no_index) {
      core = PlacedCore(*s.convex(), q, x);
      rounding = s.convex()->rounding();
      size = s.bounding_radius();
      return;
    }
    const TriangleMesh& mesh = *surface_of(s).mesh;
    const Vec3 a = mesh.corner(id, 0), b = mesh.corner(id, 1), c = mesh.corner(id, 2);
    core = PlacedCore(triangle.emplace(a, b, c), q, x);
    size = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    face = core.R * surface_of(s).topology.face_normals[id];
  }
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;
};

/// The normals from which a search may start: of faces, across which flat pieces part.
CoreContact touching_gap(const CorePair& cores, const Piece& a, const Piece& b, double farthest,
                         const Vec3& towards_b) {
  CoreContact best = core_gap(cores, farthest, towards_b);
  if (best.gap > tolerances::touch_zone_of_size * cores.size) return best;
  for (const Vec3& n : {a.face, Vec3(-a.face), b.face, Vec3(-b.face)}) {
    if (n.isZero(0) || cores.separation(n) <= best.gap) continue;
    const CoreContact other = core_gap(cores, farthest, n);
    if (other.gap > best.gap) best = other;
  }
  return best;
}

void near_triangles_of(const Shape& mesh, const Pose& at, const Shape& other, const Pose& other_at,
                       double reach, std::vector<uint32_t>& out) {
  const MeshSurface& s = surface_of(mesh);
  const Pose relative = at.inverse() * other_at;
  s.tree->overlap(other.bounds(relative).inflated(reach), out);
  const ConvexShape& c = *other.convex();
  std::erase_if(out, [&](uint32_t t) {
    const Vec3& n = s.topology.face_normals[t];
    if (n.isZero(0)) return true;
    const double offset = n.dot(s.mesh->corner(t, 0)), far = reach + c.rounding();
    const Vec3 local = relative.inverse_direction(n);
    return n.dot(relative.point(c.support(-local))) > offset + far ||
           n.dot(relative.point(c.support(local))) < offset - far;
  });
  std::sort(out.begin(), out.end());
}

}  // namespace

void near_pieces(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                 double reach, const HierarchyKind* hierarchy, std::vector<PiecePair>& out) {
  out.clear();
  if (has_pair_gap(a, b)) {
    out.emplace_back();
  } else if (a.is_mesh() && b.is_mesh()) {
    const PlacedSurface A{surface_of(a), pose_a.q.toRotationMatrix(), Vec3::Zero()};
    const PlacedSurface B{surface_of(b), pose_b.q.toRotationMatrix(), pose_b.x - pose_a.x};
    std::vector<TriangleIds> near;
    near_triangles(A, B, reach, std::numeric_limits<size_t>::max(), hierarchy, near);
    for (const TriangleIds& ids : near)
      if (!A.s.topology.face_normals[ids.a].isZero(0) &&
          !B.s.topology.face_normals[ids.b].isZero(0))
        out.push_back({ids.a, ids.b});
  } else {
    std::vector<uint32_t> near;
    if (a.is_mesh()) {
      near_triangles_of(a, pose_a, b, pose_b, reach, near);
      for (const uint32_t t : near) out.push_back({t, no_index});
    } else {
      near_triangles_of(b, pose_b, a, pose_a, reach, near);
      for (const uint32_t t : near) out.push_back({no_index, t});
    }
  }
}

PairGap piece_gap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                  const PiecePair& pieces, double margin, const Vec3& towards_b) {
  if (pieces.a == no_index && pieces.b == no_index)
    return pair_gap(a, pose_a, b, pose_b, margin, towards_b);
  const Piece pa(a, pieces.a, pose_a.q, Vec3::Zero()),
      pb(b, pieces.b, pose_b.q, pose_b.x - pose_a.x);
  const CorePair cores{pa.core, pb.core, std::min(pa.size, pb.size)};
  const double rounding = pa.rounding + pb.rounding;
  const CoreContact c = touching_gap(cores, pa, pb, margin + rounding, towards_b);
  PairGap g;
  g.gap = c.gap - rounding;
  g.near = c.within && g.gap <= margin;
  if (!g.near) return g;
  g.normal = c.normal;
  g.on_a = pose_a.x + c.a + pa.rounding * c.normal;
  g.on_b = pose_a.x + c.b - pb.rounding * c.normal;
  return g;
}

double piece_separation(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                        const PiecePair& pieces, const Vec3& n) {
  if (pieces.a == no_index && pieces.b == no_index)
    return separation_along(a, pose_a, b, pose_b, n);
  const auto reach = [](const Shape& s, const Pose& pose, uint32_t id, const Vec3& origin,
                        const Vec3& along) {
    const Vec3 local = pose.inverse_direction(along);
    const double at = along.dot(pose.x - origin);
    if (id == no_index) return at + local.dot(s.convex()->support(local)) + s.convex()->rounding();
    const TriangleMesh& mesh = *surface_of(s).mesh;
    return at + std::max({local.dot(mesh.corner(id, 0)), local.dot(mesh.corner(id, 1)),
                          local.dot(mesh.corner(id, 2))});
  };
  return -reach(b, pose_b, pieces.b, pose_a.x, -n) - reach(a, pose_a, pieces.a, pose_a.x, n);
}

NearestPieces nearest_pieces(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                             double margin, const HierarchyKind* hierarchy) {
  NearestPieces best;
  if (has_pair_gap(a, b)) {
    best.gap = pair_gap(a, pose_a, b, pose_b, margin, Vec3::Zero());
    return best;
  }
  std::vector<PiecePair> near;
  const double size = std::min(a.bounding_radius(), b.bounding_radius());
  // Few triangles first: of those within ten times as far there are a hundred times as many.
  for (double reach = std::min(margin, tolerances::first_reach_of_size * size);;
       reach = std::min(margin, tolerances::reach_growth * reach)) {
    near_pieces(a, pose_a, b, pose_b, reach, hierarchy, near);
    best.gap.gap = reach;
    for (const PiecePair& p : near) {
      if (stop_requested()) return best;
      const PairGap g = piece_gap(a, pose_a, b, pose_b, p, best.gap.gap, Vec3::Zero());
      if (g.near && (!best.gap.near || g.gap < best.gap.gap)) best = {g, p};
    }
    if (best.gap.near || reach >= margin) return best;
  }
}

}  // namespace tumble
