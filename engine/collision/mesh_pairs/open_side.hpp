#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/polyhedron_feature.hpp"

#include <algorithm>
#include <vector>

namespace tumble {

/// Where a surface lies that is near an open one; on both sides, or where it does not tell,
/// unknown.
enum class SurfaceSide : uint8_t { unknown, front, behind };

/// Triangles of a surface that are near another, in parts that hang together by common vertices.
class NearParts {
 public:
  /// `pairs` ascends by the triangles of the surface, which are first in each.
  void find(const MeshSurface& surface, const std::vector<TriangleIds>& pairs, bool one_part);
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  /// The part of a near triangle.
  uint32_t part_of(uint32_t triangle) const {
    return part_[size_t(std::ranges::lower_bound(triangles_, triangle) - triangles_.begin())];
  }

 private:
  std::vector<uint32_t> triangles_;  ///< ascending
  std::vector<uint32_t> part_;       ///< of each
  std::vector<TriangleIds> corners_;
};

/// In which pairs of near triangles an open surface S has the other one behind it.
///
/// That is decided for each two parts of the surfaces that are near each other: a clamp about the
/// rim of a sheet is in front of it with one jaw and behind it with the other.
///
/// A part that crosses S lies where it came from, `before`, if that is known: half through, no
/// shape tells. Of parts on both sides that is known by a triangle of one part that was behind; the
/// others that cross then came from the front. Otherwise every near triangle of the other gives its
/// side: where it is apart from S, that of its point nearest to S, by the pseudo-normal of S there,
/// or none beside a rim; where it crosses S, that of nearly all of it. The part lies where all that
/// have a side do, and where they disagree in front. A convex other has one centre and is one part,
/// whatever was before: it is never behind while its centre is in front of the near triangles, and
/// where some of its triangles are in front it is behind if its centre is, by more than twice what
/// of it is in front.
class OpenSides {
 public:
  /// `pairs` holds all pairs of triangles within `reach` [m] and perhaps more as (other, S),
  /// `swapped` as (S, other), both in ascending order. Of a closed S nothing is behind.
  void find(const PlacedSurface& S, const PlacedSurface& other, bool convex, double reach,
            const PolyhedronFeature& before, const std::vector<TriangleIds>& pairs,
            const std::vector<TriangleIds>& swapped);

  bool all_behind() const { return found_ == behind_bit; }
  bool mixed() const { return found_ == (front_bit | behind_bit); }
  bool behind(uint32_t triangle_of_s, uint32_t triangle_of_other) const;
  /// Where near parts of an other that is not convex are, which is `before` next time: the side of
  /// all, as feature_of_side(), or if they are on both a triangle of one that is behind.
  const PolyhedronFeature& kept() const { return kept_; }

 private:
  static constexpr uint8_t front_bit = 1, behind_bit = 2;
  struct Part {
    TriangleIds parts;     ///< of S and of the other
    uint8_t sides = 0;     ///< those that triangles were found on; then the one that it is
    bool crosses = false;  ///< some triangle of the other crosses S
  };
  Part* find_part(const TriangleIds& parts);
  /// Decides for each part by the sides that its triangles were found on and by where it was.
  template <class CentreBehind>
  void settle(bool convex, const PolyhedronFeature& before, const CentreBehind& centre_behind);

  NearParts own_, others_;
  std::vector<Part> parts_;  ///< ascending
  uint8_t found_ = front_bit;
  PolyhedronFeature kept_;
};

/// A side as what Manifold::closest keeps of a surface from one query to the next.
inline PolyhedronFeature feature_of_side(SurfaceSide side) {
  return {FeatureKind::vertex, uint32_t(side)};
}
inline SurfaceSide side_of_feature(const PolyhedronFeature& feature) {
  const bool is_side =
      feature.kind == FeatureKind::vertex && feature.index <= uint32_t(SurfaceSide::behind);
  return is_side ? SurfaceSide(feature.index) : SurfaceSide::unknown;
}

}  // namespace tumble
