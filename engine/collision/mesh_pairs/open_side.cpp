#include "engine/collision/mesh_pairs/open_side.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// A point is behind a feature if the way to it is within 60 degrees of the feature's normal
/// reversed: beside the rim of a surface it is on neither side.
constexpr double least_cosine = 0.5;
/// A triangle that crosses a plane is behind it if it reaches this many times as far behind it as
/// in front.
constexpr double mostly_ratio = 4;
/// A centre is behind if it is by this many times as much as the shape reaches in front.
constexpr double clear_ratio = 2;

/// How far nearest features are looked for: all the triangles given.
constexpr double any_distance = std::numeric_limits<double>::infinity();

enum class SurfaceSide : uint8_t { front, behind, unknown };

/// The other surface in the frame of S.
class SeenSurface {
 public:
  SeenSurface(const PlacedSurface& S, const PlacedSurface& other)
      : s_(S.s),
        other_(other.s),
        R_(S.R.transpose() * other.R),
        x_(S.R.transpose() * (other.x - S.x)),
        touching_(1e-9 * (s_.size + other_.size)) {}

  /// Of a triangle of the other; `ids` are the triangles of S that are near it. Farther away than
  /// `reach` it has none: S may be nearer there.
  SurfaceSide side_of(uint32_t triangle, const std::vector<uint32_t>& ids, double reach) const {
    const std::array<Vec3, 3> t = corners(triangle);
    double least = any_distance;
    Vec3 nearest = Vec3::Zero();
    bool crosses = false, front = false, behind = false;
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
    if (depth <= least_cosine * near.distance || depth <= touching_) return false;
    double in_front = 0;
    for (const TriangleIds& pair : pairs)
      for (const Vec3& p : corners(pair.a))
        in_front = std::max(in_front, near.normal.dot(p - near.point));
    return depth > clear_ratio * in_front;
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
    return height < -least_cosine * near.distance ? SurfaceSide::behind : SurfaceSide::unknown;
  }
  SurfaceSide side_of_plane(const std::array<Vec3, 3>& t, uint32_t id) const {
    double front = 0, behind = 0;
    for (const Vec3& p : t) {
      const double height = s_.topology.face_normals[id].dot(p - s_.mesh->corner(id, 0));
      front = std::max(front, height);
      behind = std::max(behind, -height);
    }
    if (front <= touching_ && behind <= touching_) return SurfaceSide::unknown;
    return behind > mostly_ratio * front ? SurfaceSide::behind : SurfaceSide::front;
  }

  const MeshSurface &s_, &other_;
  Mat3 R_;
  Vec3 x_;
  double touching_;  ///< distances up to here are rounding [m]
};

}  // namespace

bool lies_behind(const PlacedSurface& S, const PlacedSurface& other, bool convex, double reach,
                 const std::vector<TriangleIds>& pairs, const std::vector<TriangleIds>& swapped) {
  if (S.s.closed) return false;
  thread_local std::vector<uint32_t> ids;
  const SeenSurface seen(S, other);
  NearestFeature of_centre;
  if (convex) {
    ids.clear();
    for (const TriangleIds& pair : swapped)
      if (ids.empty() || ids.back() != pair.a) ids.push_back(pair.a);
    of_centre = nearest_feature(S.s, seen.centre(), ids, any_distance);
    if (!of_centre.inside) return false;
  }
  bool behind = false;
  for (size_t first = 0; first < pairs.size() && !stop_requested();) {
    const uint32_t triangle = pairs[first].a;
    ids.clear();
    for (; first < pairs.size() && pairs[first].a == triangle; ++first)
      ids.push_back(pairs[first].b);
    charge_work(ids.size(), 1000);
    const SurfaceSide side = seen.side_of(triangle, ids, reach);
    if (side == SurfaceSide::front) return convex && seen.centre_behind(of_centre, pairs);
    behind |= side == SurfaceSide::behind;
  }
  return behind;
}

}  // namespace tumble
