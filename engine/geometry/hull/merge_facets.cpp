#include "engine/geometry/hull/merge_facets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

struct Shape {
  Vec3 normal;
  double area2, longest;  // twice the area, longest side
};

Shape shape_of(std::span<const Vec3> points, const Triangle& t) {
  const Vec3 u = points[t[1]] - points[t[0]], v = points[t[2]] - points[t[0]];
  const Vec3 n = u.cross(v);
  const double area2 = n.norm();
  const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
  return {area2 > 0 ? Vec3(n / area2) : Vec3(Vec3::Zero()), area2, longest};
}

Plane support_plane(std::span<const Vec3> points, const Triangle& t, const Vec3& normal) {
  double offset = normal.dot(points[t[0]]);
  for (uint32_t v : t) offset = std::max(offset, normal.dot(points[v]));
  return {normal, offset};
}

struct Merger {
  std::span<const Vec3> points;
  std::span<const HullTriangle> triangles;
  double tolerance;
  std::vector<Shape> shapes;
  std::vector<uint32_t> region;  // of each triangle

  bool joins(const Plane& plane, uint32_t t, double within) const {
    for (uint32_t v : triangles[t].vertices) {
      if (std::fabs(plane.distance(points[v])) > within) return false;
    }
    // The normal of a sliver says nothing; its corners do.
    const bool sliver = shapes[t].area2 <= 4 * tolerance * shapes[t].longest;
    return sliver || shapes[t].normal.dot(plane.normal) > 0.5;
  }

  std::vector<uint32_t> grow(uint32_t seed, uint32_t number, const Plane& plane, double within) {
    std::vector<uint32_t> members{seed};
    region[seed] = number;
    for (size_t i = 0; i < members.size(); ++i) {
      for (uint32_t n : triangles[members[i]].neighbours) {
        if (region[n] != no_index || !joins(plane, n, within)) continue;
        region[n] = number;
        members.push_back(n);
      }
    }
    return members;
  }

  /// The outline of a region as one simple loop; empty when it is not.
  std::vector<uint32_t> outline(const std::vector<uint32_t>& members, uint32_t number) const {
    std::vector<std::pair<uint32_t, uint32_t>> sides;
    for (uint32_t t : members) {
      for (size_t k = 0; k < 3; ++k) {
        if (region[triangles[t].neighbours[k]] == number) continue;
        sides.emplace_back(triangles[t].vertices[k], triangles[t].vertices[(k + 1) % 3]);
      }
    }
    std::sort(sides.begin(), sides.end());
    for (size_t i = 1; i < sides.size(); ++i) {
      if (sides[i].first == sides[i - 1].first) return {};  // pinched
    }
    std::vector<uint32_t> loop;
    if (sides.empty()) return loop;
    uint32_t at = sides[0].first;
    do {
      loop.push_back(at);
      const auto it = std::lower_bound(sides.begin(), sides.end(), std::pair(at, 0u));
      at = it->second;
    } while (at != sides[0].first && loop.size() <= sides.size());
    if (loop.size() != sides.size()) return {};  // more than one loop
    return loop;
  }

  /// No corner of the loop turns inwards by more than the tolerance.
  bool is_convex(const std::vector<uint32_t>& loop, const Plane& plane) const {
    const size_t n = loop.size();
    for (size_t k = 0; k < n; ++k) {
      const Vec3& before = points[loop[k]];
      const Vec3 along = points[loop[(k + 2) % n]] - before;
      const Vec3 inward = plane.normal.cross(along);
      const double depth = inward.dot(points[loop[(k + 1) % n]] - before);
      if (depth > tolerance * along.norm()) return false;
    }
    return true;
  }

  /// The facet around `seed`: as wide as the tolerance allows, narrower where that gives an outline
  /// that is not one convex loop; in the end the triangle alone.
  std::vector<uint32_t> facet(uint32_t seed, uint32_t number, const Plane& plane) {
    for (double within = tolerance; within > 1e-6 * tolerance; within /= 16) {
      const std::vector<uint32_t> members = grow(seed, number, plane, within);
      std::vector<uint32_t> loop = outline(members, number);
      if (!loop.empty() && is_convex(loop, plane)) return loop;
      for (uint32_t t : members) region[t] = no_index;
    }
    region[seed] = number;
    const Triangle& v = triangles[seed].vertices;
    return {v.begin(), v.end()};
  }

  MergedFacets run() {
    std::vector<uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    for (const HullTriangle& t : triangles) shapes.push_back(shape_of(points, t.vertices));
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return shapes[a].area2 > shapes[b].area2; });
    region.assign(triangles.size(), no_index);
    MergedFacets out;
    uint32_t number = 0;
    for (uint32_t seed : order) {
      if (region[seed] != no_index) continue;
      const Plane plane = support_plane(points, triangles[seed].vertices, shapes[seed].normal);
      out.loops.push_back(facet(seed, number++, plane));
      out.planes.push_back(plane);
    }
    drop_straight_corners(out);
    return out;
  }

  /// A corner at which only two facets meet is no corner.
  void drop_straight_corners(MergedFacets& facets) const {
    std::vector<uint8_t> degree(points.size(), 0);
    for (const auto& loop : facets.loops) {
      for (uint32_t v : loop) degree[v] = uint8_t(std::min(degree[v] + 1, 3));
    }
    for (const auto& loop : facets.loops) {
      // Keep all corners of a facet that would lose too many.
      if (std::count_if(loop.begin(), loop.end(), [&](uint32_t v) { return degree[v] > 2; }) < 3) {
        for (uint32_t v : loop) degree[v] = 3;
      }
    }
    for (auto& loop : facets.loops) std::erase_if(loop, [&](uint32_t v) { return degree[v] < 3; });
  }
};

}  // namespace

MergedFacets merge_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                          double tolerance) {
  return Merger{points, triangles, tolerance, {}, {}}.run();
}

MergedFacets separate_facets(std::span<const Vec3> points,
                             std::span<const HullTriangle> triangles) {
  MergedFacets out;
  for (const HullTriangle& t : triangles) {
    out.loops.emplace_back(t.vertices.begin(), t.vertices.end());
    out.planes.push_back(support_plane(points, t.vertices, shape_of(points, t.vertices).normal));
  }
  return out;
}

}  // namespace tumble
