#include "engine/collision/mesh_pairs/open_side.hpp"

#include "engine/collision/mesh_pairs/tolerances.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// How far nearest features are looked for: all the triangles given.
constexpr double any_distance = std::numeric_limits<double>::infinity();

/// The other surface in the frame of S.
class SeenSurface {
 public:
  SeenSurface(const PlacedSurface& S, const PlacedSurface& other)
      : s_(S.s),
        other_(other.s),
        R_(S.R.transpose() * other.R),
        x_(S.R.transpose() * (other.x - S.x)),
        touching_(tolerances::touching_share * (s_.size + other_.size)) {}

  /// Of a triangle of the other, and whether it crosses S; `ids` are the triangles of S that are
  /// near it. Farther away than `reach` it has none: S may be nearer there.
  SurfaceSide side_of(uint32_t triangle, const std::vector<uint32_t>& ids, double reach,
                      bool& crosses) const {
    const std::array<Vec3, 3> t = corners(triangle);
    double least = any_distance;
    Vec3 nearest = Vec3::Zero();
    bool front = false, behind = false;
    crosses = false;
    for (const uint32_t id : ids) {
      const std::array<Vec3, 3> own{s_.mesh->corner(id, 0), s_.mesh->corner(id, 1),
                                    s_.mesh->corner(id, 2)};
      const TrianglePair pair = closest_triangle_triangle(t, own);
      if (pair.squared_distance <= touching_ * touching_) {
        crosses = true;
        const SurfaceSide side = side_of_plane(t, id);
        front |= side == SurfaceSide::front, behind |= side == SurfaceSide::behind;
      }
      if (pair.squared_distance >= least) continue;
      least = pair.squared_distance;
      nearest = pair.on_a;
    }
    if (least > reach * reach) return SurfaceSide::unknown;
    if (!crosses) return side_of_point(nearest, ids);
    if (front) return SurfaceSide::front;
    return behind ? SurfaceSide::behind : SurfaceSide::unknown;
  }

  Vec3 centre() const { return point(other_.tree->bounds().centre()); }
  /// Whether the centre of the other, whose nearest feature is given, is clearly behind S; `pairs`
  /// are those of lies_behind().
  bool centre_behind(const NearestFeature& near, const std::vector<TriangleIds>& pairs) const {
    const double depth = near.normal.dot(near.point - centre());
    if (depth <= tolerances::least_cosine * near.distance || depth <= touching_) return false;
    double in_front = 0;
    for (const TriangleIds& pair : pairs)
      for (const Vec3& p : corners(pair.a))
        in_front = std::max(in_front, near.normal.dot(p - near.point));
    return depth > tolerances::clear_ratio * in_front;
  }

 private:
  Vec3 point(const Vec3& p) const { return R_ * p + x_; }
  std::array<Vec3, 3> corners(uint32_t t) const {
    return {point(other_.mesh->corner(t, 0)), point(other_.mesh->corner(t, 1)),
            point(other_.mesh->corner(t, 2))};
  }
  SurfaceSide side_of_point(const Vec3& p, const std::vector<uint32_t>& ids) const {
    const NearestFeature near = nearest_feature(s_, p, ids, any_distance);
    if (near.triangle == no_index || near.normal.isZero(0)) return SurfaceSide::unknown;
    const double height = near.normal.dot(p - near.point);
    if (height > touching_) return SurfaceSide::front;
    return height < -tolerances::least_cosine * near.distance ? SurfaceSide::behind
                                                              : SurfaceSide::unknown;
  }
  SurfaceSide side_of_plane(const std::array<Vec3, 3>& t, uint32_t id) const {
    double front = 0, behind = 0;
    for (const Vec3& p : t) {
      const double height = s_.topology.face_normals[id].dot(p - s_.mesh->corner(id, 0));
      front = std::max(front, height);
      behind = std::max(behind, -height);
    }
    if (front <= touching_ && behind <= touching_) return SurfaceSide::unknown;
    return behind > tolerances::mostly_ratio * front ? SurfaceSide::behind : SurfaceSide::front;
  }

  const MeshSurface &s_, &other_;
  Mat3 R_;
  Vec3 x_;
  double touching_;  ///< distances up to here are rounding [m]
};

}  // namespace

void NearParts::find(const MeshSurface& surface, const std::vector<TriangleIds>& pairs,
                     bool one_part) {
  triangles_.clear();
  for (const TriangleIds& pair : pairs)
    if (triangles_.empty() || triangles_.back() != pair.a) triangles_.push_back(pair.a);
  part_.assign(triangles_.size(), 0);
  if (one_part) return;
  const auto root = [this](uint32_t i) {
    while (part_[i] != i) i = part_[i] = part_[part_[i]];
    return i;
  };
  corners_.clear();
  for (uint32_t i = 0; i < triangles_.size(); ++i) {
    part_[i] = i;
    for (const uint32_t v : surface.mesh->triangles[triangles_[i]]) corners_.push_back({v, i});
  }
  std::sort(corners_.begin(), corners_.end());
  for (size_t i = 1; i < corners_.size(); ++i) {
    if (corners_[i].a != corners_[i - 1].a) continue;
    const uint32_t x = root(corners_[i].b), y = root(corners_[i - 1].b);
    part_[std::max(x, y)] = std::min(x, y);
  }
  for (uint32_t i = 0; i < part_.size(); ++i) part_[i] = root(i);
}

OpenSides::Part* OpenSides::find_part(const TriangleIds& parts) {
  const auto at = std::ranges::lower_bound(parts_, parts, {}, &Part::parts);
  return at != parts_.end() && at->parts == parts ? &*at : nullptr;
}

bool OpenSides::behind(uint32_t triangle_of_s, uint32_t triangle_of_other) const {
  if (parts_.empty()) return false;
  const TriangleIds parts{own_.part_of(triangle_of_s), others_.part_of(triangle_of_other)};
  const auto at = std::ranges::lower_bound(parts_, parts, {}, &Part::parts);
  return at != parts_.end() && at->parts == parts && at->sides == behind_bit;
}

template <class CentreBehind>
void OpenSides::settle(bool convex, const PolyhedronFeature& before,
                       const CentreBehind& centre_behind) {
  const SurfaceSide all_were = side_of_feature(before);
  const bool were_both = before.kind == FeatureKind::face &&
                         std::ranges::binary_search(others_.triangles(), before.index);
  const uint32_t was_behind = were_both ? others_.part_of(before.index) : no_index;
  const auto side_before = [&](const Part& part) {
    if (!were_both) return all_were;
    return part.parts.b == was_behind ? SurfaceSide::behind : SurfaceSide::front;
  };
  bool told = false;
  found_ = 0;
  for (Part& part : parts_) {
    told |= part.sides != 0;
    const SurfaceSide was = side_before(part);
    if (part.crosses && !convex && was != SurfaceSide::unknown) {
      told = true;
      part.sides = was == SurfaceSide::behind ? behind_bit : front_bit;
    } else if (part.sides != behind_bit) {
      const bool is_behind = convex && part.sides != 0 && centre_behind();
      part.sides = is_behind ? behind_bit : front_bit;
    }
    found_ |= part.sides;
  }
  if (convex) return;
  if (mixed()) {
    const auto at = std::ranges::find(parts_, behind_bit, &Part::sides);
    kept_ = {FeatureKind::face, others_.triangles()[at->parts.b]};
  } else if (told) {
    kept_ = feature_of_side(all_behind() ? SurfaceSide::behind : SurfaceSide::front);
  } else {
    // Beside a rim nothing tells, and to be seen from the front there is not to have been in front.
    kept_ = were_both ? before : feature_of_side(all_were);
  }
}

void OpenSides::find(const PlacedSurface& S, const PlacedSurface& other, bool convex, double reach,
                     const PolyhedronFeature& before, const std::vector<TriangleIds>& pairs,
                     const std::vector<TriangleIds>& swapped) {
  found_ = front_bit;
  kept_ = {};
  parts_.clear();
  if (S.s.closed) return;
  const SeenSurface seen(S, other);
  own_.find(S.s, swapped, convex);
  others_.find(other.s, pairs, convex);
  NearestFeature of_centre;
  if (convex) {
    of_centre = nearest_feature(S.s, seen.centre(), own_.triangles(), any_distance);
    if (!of_centre.inside) return;
  }
  thread_local std::vector<TriangleIds> run;
  thread_local std::vector<uint32_t> ids;
  for (const TriangleIds& pair : pairs)
    parts_.push_back({{own_.part_of(pair.b), others_.part_of(pair.a)}});
  std::ranges::sort(parts_, {}, &Part::parts);
  const auto same = [](const Part& a, const Part& b) { return a.parts == b.parts; };
  parts_.erase(std::unique(parts_.begin(), parts_.end(), same), parts_.end());
  for (size_t first = 0; first < pairs.size() && !stop_requested();) {
    const uint32_t triangle = pairs[first].a;
    run.clear();
    for (; first < pairs.size() && pairs[first].a == triangle; ++first)
      run.push_back({own_.part_of(pairs[first].b), pairs[first].b});
    std::sort(run.begin(), run.end());
    charge_work(run.size(), 1000);
    for (size_t i = 0; i < run.size();) {
      const uint32_t part = run[i].a;
      ids.clear();
      for (; i < run.size() && run[i].a == part; ++i) ids.push_back(run[i].b);
      bool crosses = false;
      const SurfaceSide side = seen.side_of(triangle, ids, reach, crosses);
      Part& found = *find_part({part, others_.part_of(triangle)});
      found.crosses |= crosses;
      if (side != SurfaceSide::unknown)
        found.sides |= side == SurfaceSide::front ? front_bit : behind_bit;
    }
  }
  settle(convex, before, [&] { return seen.centre_behind(of_centre, pairs); });
}

}  // namespace tumble
