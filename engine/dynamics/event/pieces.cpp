#include "engine/dynamics/event/pieces.hpp"

#include "engine/collision/mesh_pairs/near_triangles.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/core_gap.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tumble {
namespace {

const MeshSurface& surface_of(const Shape& s) {
  return s.polyhedral()->surface();
}

/// One piece, placed in a frame with world axes.
struct Piece {
  std::optional<TriangleCore> triangle;
  PlacedCore core;
  double rounding = 0, size = 0;
  Vec3 face = Vec3::Zero();  ///< unit normal of a triangle

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

/// The greatest separation of two pieces; if they touch, the search also starts from face normals,
/// along which flat pieces separate.
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

Aabb bounds_of(const AabbTree::Node& n, const Vec3& origin) {
  return {origin + Vec3(n.min[0], n.min[1], n.min[2]), origin + Vec3(n.max[0], n.max[1], n.max[2])};
}

/// The box about a convex shape in its own axes, inflated by `reach`, tested against boxes and
/// triangles of a mesh. If they are apart along a face axis of either box, the distance is more
/// than `reach`.
class ReachBox {
 public:
  ReachBox(const Shape& convex, const Pose& in_mesh, double reach)
      : R_(in_mesh.q.toRotationMatrix()),
        absolute_(R_.cwiseAbs() + Mat3::Constant(tolerances::axis_rounding)) {
    const Aabb own = convex.bounds(Pose{}).inflated(reach);
    centre_ = in_mesh.point(own.centre());
    half_ = 0.5 * own.extent();
  }
  bool apart(const Aabb& box) const {
    const Vec3 d = box.centre() - centre_, half = 0.5 * box.extent();
    return ((d.cwiseAbs() - absolute_ * half_ - half).maxCoeff() > 0) ||
           ((R_.transpose() * d).cwiseAbs() - absolute_.transpose() * half - half_).maxCoeff() > 0;
  }
  bool apart(const std::array<Vec3, 3>& corners) const {
    Aabb own;
    for (const Vec3& p : corners) own.include(R_.transpose() * (p - centre_));
    return (own.min - half_).maxCoeff() > 0 || (-own.max - half_).maxCoeff() > 0;
  }

 private:
  Mat3 R_, absolute_;
  Vec3 centre_, half_;
};

void near_triangles_of(const Shape& mesh, const Pose& at, const Shape& other, const Pose& other_at,
                       double reach, std::vector<uint32_t>& out) {
  const MeshSurface& s = surface_of(mesh);
  const Pose relative = at.inverse() * other_at;
  const ConvexShape& c = *other.convex();
  const double far = reach + c.rounding();
  const auto beyond_plane = [&](uint32_t t, const Vec3& on_plane) {
    const Vec3& n = s.topology.face_normals[t];
    const double offset = n.dot(on_plane);
    const Vec3 local = relative.inverse_direction(n);
    return n.dot(relative.point(c.support(-local))) > offset + far ||
           n.dot(relative.point(c.support(local))) < offset - far;
  };
  // The tree's boxes are rounded to single precision.
  const ReachBox box(other, relative,
                     reach + tolerances::box_rounding_of_size * (s.size + other.bounding_radius()));
  const auto& nodes = s.tree->nodes();
  out.clear();
  NodeStack stack{};
  if (!nodes.empty()) stack.push(0);
  while (stack.size > 0) {
    const uint32_t i = stack.pop();
    charge_work(prices::box);
    const AabbTree::Node& n = nodes[i];
    if (box.apart(bounds_of(n, s.tree->origin()))) continue;
    if (!n.is_leaf()) {
      stack.push(n.start);
      stack.push(i + 1);
      continue;
    }
    for (uint32_t k = n.start; k < n.start + n.count; ++k) {
      charge_work(prices::box);
      const uint32_t t = s.tree->triangle_order()[k];
      const std::array<Vec3, 3> corners{s.mesh->corner(t, 0), s.mesh->corner(t, 1),
                                        s.mesh->corner(t, 2)};
      if (s.topology.face_normals[t].isZero(0) || box.apart(corners)) continue;
      if (!beyond_plane(t, corners[0])) out.push_back(t);
    }
  }
  std::sort(out.begin(), out.end());
}

/// An upper bound of the least gap of a mesh and a convex shape, found by alternating projections
/// (von Neumann; between convex sets they converge to the nearest points): the triangle nearest to
/// a point of the shape, the point of the shape nearest to that triangle, and so on. 0 where one of
/// the triangles touches.
double gap_by_projections(const Shape& mesh, const Pose& at, const Shape& convex,
                          const Pose& convex_at, double farthest) {
  const MeshSurface& s = surface_of(mesh);
  double least = farthest;
  Vec3 p = convex_at.x;
  for (;;) {
    charge_work(prices::tree_search);
    const auto near = s.tree->closest(at.inverse_point(p), std::numeric_limits<double>::infinity());
    if (!near || s.topology.face_normals[near->triangle].isZero(0)) return least;
    const PairGap g =
        piece_gap(mesh, at, convex, convex_at, {near->triangle, no_index}, least, Vec3::Zero());
    if (!g.near || !(g.gap < least)) return least;
    least = std::max(0.0, g.gap);
    if (least == 0) return 0;
    p = g.on_b;
  }
}

/// The nearest points of two meshes, if they are within `farthest`. The normal is accurate where
/// the meshes are well apart.
std::optional<NearestPieces> mesh_distance(const Shape& a, const Pose& pose_a, const Shape& b,
                                           const Pose& pose_b, double farthest) {
  charge_work(prices::tree_search);
  const auto d =
      surface_of(a).tree->distance(*surface_of(b).tree, pose_a.inverse() * pose_b, farthest);
  if (!d) return std::nullopt;
  NearestPieces out;
  out.pieces = {d->triangles.a, d->triangles.b};
  out.gap.near = true;
  out.gap.gap = std::sqrt(d->squared_distance);
  out.gap.on_a = pose_a.point(d->on_a);
  out.gap.on_b = pose_a.point(d->on_b);
  out.gap.normal = (out.gap.on_b - out.gap.on_a).normalized();
  return out;
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
    charge_work(prices::tree_search + 4 * prices::box * near.size());
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
  charge_work(2 * prices::separation);
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
  charge_work(prices::separation);
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
  best.gap.gap = (pose_b.x - pose_a.x).norm() - a.bounding_radius() - b.bounding_radius();
  if (best.gap.gap > margin) return best;
  const double size = std::min(a.bounding_radius(), b.bounding_radius());
  // An upper bound of the least gap; pieces farther apart need not be examined.
  double reach = margin;
  if (a.is_mesh() && b.is_mesh()) {
    const auto nearest = mesh_distance(a, pose_a, b, pose_b, margin);
    best.gap.gap = margin;
    if (!nearest) return best;
    if (nearest->gap.gap > tolerances::touch_zone_of_size * size) return *nearest;
    reach = nearest->gap.gap;
  } else {
    reach = a.is_mesh() ? gap_by_projections(a, pose_a, b, pose_b, margin)
                        : gap_by_projections(b, pose_b, a, pose_a, margin);
  }
  reach = std::min(margin, reach + tolerances::nearest_of_size * size);  // plus rounding error
  std::vector<PiecePair> near;
  for (;; reach = std::min(margin, tolerances::reach_growth *
                                       std::max(reach, tolerances::first_reach_of_size * size))) {
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
