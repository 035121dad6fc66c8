#include "engine/collision/convex_pairs/box_box.hpp"

#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/convex_pairs/face_clipping.hpp"
#include "engine/collision/feature_key.hpp"
#include "engine/collision/shapes/box.hpp"
#include "engine/math/float4.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Result of the axis tests: the largest separation and its direction from A to B.
struct Separation {
  double face = -std::numeric_limits<double>::infinity();
  double edge = face;
  Vec3 face_normal = Vec3::Zero(), edge_normal = Vec3::Zero();
  int edge_a = 0, edge_b = 0;
  /// An edge axis is chosen only if its separation exceeds this [m].
  double edge_threshold = 0;
  bool apart = false;  ///< farther than the margin

  bool by_edges() const { return edge > edge_threshold; }
};

/// The edge pairs that may separate the boxes by more than `least`: bit 3 i + j for edges i of A
/// and j of B, computed for a row of B's edges at a time. A conservative estimate in single
/// precision, without roots and divisions. `C` rotates from B's axes to A's; `da` is the vector
/// from A to B in A's axes.
unsigned edges_beyond(double least, const Vec3& ha, const Vec3& hb, const Mat3& C, const Vec3& da) {
  // several times the rounding error of the sums
  const Float4 rounding(float(2e-6 * (ha.sum() + hb.sum() + da.cwiseAbs().sum())));
  const Float4 least2(float(least * std::abs(least)));
  const Float4 b = Float4::round(hb[0], hb[1], hb[2]);
  const Float4 b_next = b.shuffled<1, 2, 0, 3>(), b_last = b.shuffled<2, 0, 1, 3>();
  std::array<Float4, 3> c, abs_c;
  for (size_t i = 0; i < 3; ++i) {
    const auto row = C.row(int(i));
    c[i] = Float4::round(row[0], row[1], row[2]);
    abs_c[i] = abs(c[i]);
  }
  unsigned beyond = 0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t k = (i + 1) % 3, l = (i + 2) % 3;
    const Float4 hk{float(ha[int(k)])}, hl{float(ha[int(l)])};
    const Float4 dk{float(da[int(k)])}, dl{float(da[int(l)])};
    // along the cross product of the edges, whose length is the sine of their angle
    const Float4 distance = abs(dl * c[k] - dk * c[l]);
    const Float4 radii =
        (hk * abs_c[l] + hl * abs_c[k]) +
        (b_next * abs_c[i].shuffled<2, 0, 1, 3>() + b_last * abs_c[i].shuffled<1, 2, 0, 3>());
    const Float4 gap = distance - radii + rounding;
    const Float4 sine2 = c[k] * c[k] + c[l] * c[l];
    const int within = greater(least2 * sine2, gap * abs(gap));
    beyond |= unsigned(~within & 7) << (3 * i);
  }
  return beyond;
}

Separation separate(const Vec3& ha, const Vec3& hb, const Mat3& RA, const Mat3& RB, const Vec3& d,
                    double margin) {
  Separation s;
  const Mat3 C = RA.transpose() * RB, absC = C.cwiseAbs();
  const Vec3 da = RA.transpose() * d, db = RB.transpose() * d;
  const auto face = [&](double separation, const Vec3& axis, double side) {
    if (separation <= s.face) return;
    s.face = separation;
    s.face_normal = side < 0 ? Vec3(-axis) : axis;
  };
  // B's faces must be clearly better than A's, so that the choice does not alternate
  const double level = 1e-6 * (ha.minCoeff() + hb.minCoeff());
  for (int i = 0; i < 3; ++i) face(std::abs(da[i]) - ha[i] - absC.row(i).dot(hb), RA.col(i), da[i]);
  for (int i = 0; i < 3; ++i) {
    const double separation = std::abs(db[i]) - hb[i] - absC.col(i).dot(ha);
    if (separation > s.face + level) face(separation, RB.col(i), db[i]);
  }
  if (s.face > margin) {
    s.apart = true;
    return s;
  }
  s.edge_threshold = s.face + 0.05 * std::abs(s.face) + 1e-4 * (ha.minCoeff() + hb.minCoeff());
  unsigned left = edges_beyond(std::min(s.edge_threshold, margin), ha, hb, C, da);
  for (; left != 0; left &= left - 1) {
    const int which = std::countr_zero(left), i = which / 3, j = which % 3;
    const Vec3 axis = Vec3::Unit(i).cross(C.col(j));  // in A's axes
    const double length = axis.norm();
    if (length < 1e-6) continue;
    const Vec3 u = axis / length;
    const double distance = u.dot(da);
    const double separation =
        std::abs(distance) - u.cwiseAbs().dot(ha) - (C.transpose() * u).cwiseAbs().dot(hb);
    if (separation <= s.edge) continue;
    s.edge = separation;
    s.edge_normal = RA * (distance < 0 ? Vec3(-u) : u);
    s.edge_a = i, s.edge_b = j;
  }
  s.apart = s.edge > margin;
  return s;
}

/// Nearest points of the lines through the two edges that define the normal.
struct EdgePoints {
  Vec3 on_a, on_b;
  bool between_ends;  ///< otherwise some corner is as near
  uint64_t key;
};

EdgePoints nearest_on_edges(const ShapePair& pair, const Vec3& ha, const Vec3& hb, const Mat3& RA,
                            const Mat3& RB, const Separation& s) {
  const Vec3& n = s.edge_normal;
  Vec3 pa = Vec3::Zero(), pb = Vec3::Zero();
  unsigned ida = 0, idb = 0;
  for (int k = 0; k < 3; ++k) {
    const double sa = n.dot(RA.col(k)) > 0 ? 1 : -1, sb = n.dot(RB.col(k)) < 0 ? 1 : -1;
    if (k != s.edge_a) pa[k] = sa * ha[k], ida |= unsigned(sa > 0) << k;
    if (k != s.edge_b) pb[k] = sb * hb[k], idb |= unsigned(sb > 0) << k;
  }
  const Vec3 p = pair.pose_a.x + RA * pa, q = pair.pose_b.x + RB * pb;
  const Vec3 u = RA.col(s.edge_a), v = RB.col(s.edge_b), r = q - p;
  const Vec3 c = u.cross(v);  // exact even where the edges are nearly parallel
  const double su = r.cross(v).dot(c) / c.squaredNorm(), sv = r.cross(u).dot(c) / c.squaredNorm();
  const double la = ha[s.edge_a], lb = hb[s.edge_b];
  return {p + std::clamp(su, -la, la) * u, q + std::clamp(sv, -lb, lb) * v,
          std::abs(su) <= la && std::abs(sv) <= lb,
          feature_key(FeaturePair::edge_edge, 8u * unsigned(s.edge_a) + ida,
                      8u * unsigned(s.edge_b) + idb)};
}

/// Boxes separated by an edge pair. If the edges are nearest between their ends, these are the
/// nearest points of the boxes; otherwise some corner is.
void apart_by_edges(const ShapePair& pair, const EdgePoints& at, const Mat3& RA, const Mat3& RB,
                    const Separation& s, std::vector<Manifold>& out) {
  if (!at.between_ends) return collide_convex_convex(pair, out);
  CoreContact contact;
  contact.normal = s.edge_normal;
  contact.gap = s.edge;
  contact.a = at.on_a;
  contact.b = at.on_b;
  ManifoldBuilder points;
  contact_points(PlacedCore(*pair.a.convex(), RA, pair.pose_a.x),
                 PlacedCore(*pair.b.convex(), RB, pair.pose_b.x), contact, pair.margin, points);
  emit(pair, points, s.edge_normal, 0, out);
}

/// Points of the two faces that face each other along the face normal.
void face_points(const ShapePair& pair, const BoxShape& a, const BoxShape& b, const Mat3& RA,
                 const Mat3& RB, const Vec3& normal, ManifoldBuilder& points) {
  SupportingFace fa, fb;
  PlacedCore(a, RA, pair.pose_a.x).supporting_face(normal, fa);
  PlacedCore(b, RB, pair.pose_b.x).supporting_face(-normal, fb);
  clip_faces(fa, fb, normal, 0, 0, pair.margin, points);
}

/// Whether boxes that overlap deeply lie on each other by faces, slightly tilted: a single point
/// where edges cross would let them rotate deeper about it.
bool sunk_by_faces(const Separation& s, double thickness) {
  const bool sunk = s.edge < -0.01 * thickness;
  return sunk && s.edge - s.face < 0.05 * thickness && s.edge_normal.dot(s.face_normal) > 0.98;
}

}  // namespace

void collide_box_box(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& a = static_cast<const BoxShape&>(pair.a);
  const auto& b = static_cast<const BoxShape&>(pair.b);
  const Vec3 &ha = a.half_extents(), &hb = b.half_extents();
  const Mat3 RA = pair.pose_a.q.toRotationMatrix(), RB = pair.pose_b.q.toRotationMatrix();
  const Vec3 d = pair.pose_b.x - pair.pose_a.x;
  const Separation s = separate(ha, hb, RA, RB, d, pair.margin);
  if (s.apart) {
    pair.found_apart(std::max(s.face, s.edge), ha.sum() + hb.sum() + d.cwiseAbs().sum());
    return;
  }
  if (s.by_edges()) {
    const EdgePoints at = nearest_on_edges(pair, ha, hb, RA, RB, s);
    if (s.edge > 0) return apart_by_edges(pair, at, RA, RB, s, out);
    if (sunk_by_faces(s, ha.minCoeff() + hb.minCoeff())) {
      ManifoldBuilder points;
      face_points(pair, a, b, RA, RB, s.face_normal, points);
      const auto deep = [&](const ManifoldPoint& p) { return p.gap < 0.5 * s.face; };
      if (std::ranges::any_of(points.points(), deep))
        return emit(pair, points, s.face_normal, 0, out);
    }
    ManifoldBuilder points;
    points.add(0.5 * (at.on_a + at.on_b), s.edge, at.key);
    emit(pair, points, s.edge_normal, 0, out);
    return;
  }
  ManifoldBuilder points;
  face_points(pair, a, b, RA, RB, s.face_normal, points);
  if (points.count() == 0) {
    // No face is opposite to the other box: the boxes pass each other at corners.
    collide_convex_convex(pair, out);
    return;
  }
  emit(pair, points, s.face_normal, 0, out);
}

}  // namespace tumble
