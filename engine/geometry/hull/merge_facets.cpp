#include "engine/geometry/hull/merge_facets.hpp"

#include "engine/geometry/hull/triangle_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

/// Levels of merging: at each level the tolerance shrinks by a factor of 16, and at the last one
/// the seed triangle remains a facet of its own.
constexpr uint8_t level_alone = 6;
/// Rounds after which facets that fail are no longer merged at all, and after which none is.
constexpr int rounds_patient = 8, rounds_most = 40;
/// Outlines with more corners than this are only tested for strict convexity.
constexpr size_t outline_large = 1024;

/// The plane of a triangle, moved outwards until all three corners are on its inner side.
Plane support_plane(std::span<const Vec3> points, const Triangle& t, const Vec3& normal) {
  double offset = normal.dot(points[t[0]]);
  for (uint32_t v : t) offset = std::max(offset, normal.dot(points[v]));
  return {normal, offset};
}

std::vector<TriangleShape> shapes_of(std::span<const Vec3> points,
                                     std::span<const HullTriangle> triangles, double tolerance) {
  Aabb box;
  for (const HullTriangle& t : triangles) box.include(points[t.vertices[0]]);
  for (const HullTriangle& t : triangles) box.include(points[t.vertices[1]]);
  for (const HullTriangle& t : triangles) box.include(points[t.vertices[2]]);
  const double good_enough = tolerance / (16 * box.extent().norm());
  std::vector<TriangleShape> out;
  out.reserve(triangles.size());
  for (const HullTriangle& t : triangles) {
    const auto& [a, b, c] = t.vertices;
    out.push_back(triangle_shape(points[a], points[b], points[c], good_enough));
  }
  return out;
}

class Merger {
 public:
  Merger(std::span<const Vec3> points, std::span<const HullTriangle> triangles, double tolerance)
      : points_(points),
        triangles_(triangles),
        tolerance_(tolerance),
        shapes_(shapes_of(points, triangles, tolerance)),
        level_(triangles.size(), 0),
        links_(points.size()),
        meets_(points.size()),
        order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
      const double x = shapes_[a].area2, y = shapes_[b].area2;
      return x != y ? x > y : a < b;
    });
  }

  MergedFacets run() {
    for (int round = 0; round < rounds_most; ++round) {
      patient_ = round < rounds_patient;
      join_all();
      if (drop_corners()) return result();
    }
    return separate_facets(points_, triangles_, tolerance_);
  }

 private:
  std::span<const uint32_t> outline(size_t f) const {
    return {outlines_.data() + first_[f], first_[f + 1] - first_[f]};
  }

  bool joins(const Plane& plane, uint32_t t, double within) const {
    for (uint32_t v : triangles_[t].vertices) {
      if (std::fabs(plane.distance(points_[v])) > within) return false;
    }
    // The normal of a sliver is meaningless; its corners are tested instead.
    const bool sliver = shapes_[t].area2 <= 4 * tolerance_ * shapes_[t].longest;
    return sliver || shapes_[t].normal.dot(plane.normal) > 0.5;
  }

  void grow(uint32_t seed, const Plane& plane, double within) {
    members_.assign(1, seed);
    region_[seed] = seed;
    for (size_t i = 0; i < members_.size(); ++i) {
      for (uint32_t n : triangles_[members_[i]].neighbours) {
        if (region_[n] != no_index || !joins(plane, n, within)) continue;
        region_[n] = seed;
        members_.push_back(n);
      }
    }
  }

  /// Appends the outline of the region around `seed` if it is one simple loop.
  bool append_outline(uint32_t seed) {
    const auto each_side = [&](const auto& use) {
      for (uint32_t t : members_) {
        const HullTriangle& m = triangles_[t];
        for (size_t k = 0; k < 3; ++k) {
          if (region_[m.neighbours[k]] != seed) use(m.vertices[k], m.vertices[(k + 1) % 3]);
        }
      }
    };
    size_t sides = 0;
    uint32_t least = no_index;
    each_side([&](uint32_t a, uint32_t b) {
      links_[a] = b;
      ++sides;
      least = std::min(least, a);
    });
    if (sides < 3) return false;
    // A vertex with two outgoing sides is passed only once, which makes the loop too short.
    const size_t begin = outlines_.size();
    uint32_t at = least;
    do {
      outlines_.push_back(at);
      at = links_[at];
    } while (at != least && outlines_.size() - begin <= sides);
    if (outlines_.size() - begin == sides) return true;
    outlines_.resize(begin);
    return false;
  }

  /// Merges the facet around `seed`, as large as its level allows, or smaller if that does not give
  /// a simple loop.
  void join(uint32_t seed, const Plane& plane) {
    for (uint8_t& level = level_[seed]; level < level_alone; ++level) {
      grow(seed, plane, tolerance_ * std::pow(2.0, -4 * level));
      if (members_.size() == 1) break;
      if (append_outline(seed)) return;
      for (uint32_t t : members_) region_[t] = no_index;
    }
    region_[seed] = seed;
    const Triangle& v = triangles_[seed].vertices;
    const size_t k = size_t(std::min_element(v.begin(), v.end()) - v.begin());
    for (size_t j = 0; j < 3; ++j) outlines_.push_back(v[(k + j) % 3]);
  }

  void join_all() {
    region_.assign(triangles_.size(), no_index);
    first_.assign(1, 0);
    outlines_.clear();
    seeds_.clear();
    planes_.clear();
    for (uint32_t seed : order_) {
      if (region_[seed] != no_index) continue;
      const Triangle& v = triangles_[seed].vertices;
      planes_.push_back(support_plane(points_, v, shapes_[seed].normal));
      join(seed, planes_.back());
      seeds_.push_back(seed);
      first_.push_back(uint32_t(outlines_.size()));
    }
    gone_.assign(seeds_.size(), 0);
  }

  void narrow(size_t f) {
    uint8_t& level = level_[seeds_[f]];
    level = patient_ ? uint8_t(std::min(level + 1, int(level_alone))) : level_alone;
  }

  void kept_corners(size_t f, std::vector<uint32_t>& out) const {
    out.clear();
    for (uint32_t v : outline(f)) {
      if (meets_[v] > 2) out.push_back(v);
    }
  }

  /// Removes corners where only two facets meet, and facets with two corners. False if that would
  /// move the surface too far; the level of the facets concerned is then raised.
  bool drop_corners() {
    // Number of facets at each corner; a facet with two corners vanishes and is no longer counted.
    std::fill(meets_.begin(), meets_.end(), 0u);
    for (uint32_t v : outlines_) ++meets_[v];
    std::vector<uint32_t> loop;
    for (bool again = true; again;) {
      again = false;
      for (size_t f = 0; f < seeds_.size(); ++f) {
        if (gone_[f]) continue;
        kept_corners(f, loop);
        if (loop.size() > 2) continue;
        gone_[f] = 1;
        for (uint32_t v : loop) --meets_[v];
        again = true;
      }
    }
    std::vector<uint8_t> bad(points_.size(), 0);
    bool good = true;
    for (size_t f = 0; f < seeds_.size(); ++f) {
      if (!chains_are_straight(f, bad)) good = false;
    }
    if (!good) {
      for (size_t f = 0; f < seeds_.size(); ++f) {
        const auto corners = outline(f);
        if (std::any_of(corners.begin(), corners.end(), [&](uint32_t v) { return bad[v] != 0; })) {
          narrow(f);
        }
      }
      return false;
    }
    for (size_t f = 0; f < seeds_.size(); ++f) {
      if (gone_[f]) continue;
      kept_corners(f, loop);
      if (loop.size() == 3 && outline(f).size() == 3) continue;
      if (!is_convex(loop, planes_[f])) {
        narrow(f);
        good = false;
      }
    }
    return good;
  }

  /// Whether all removed corners of facet f lie on the sides that replace them.
  bool chains_are_straight(size_t f, std::vector<uint8_t>& bad) const {
    const auto corners = outline(f);
    const size_t n = corners.size();
    size_t start = 0;
    while (start < n && meets_[corners[start]] < 3) ++start;
    if (start == n) {
      for (uint32_t v : corners) bad[v] = 1;
      return false;
    }
    bool good = true;
    for (size_t i = start; i < start + n;) {
      size_t j = i + 1;
      while (meets_[corners[j % n]] < 3) ++j;
      const Vec3 &a = points_[corners[i % n]], &b = points_[corners[j % n]];
      for (size_t k = i + 1; k < j; ++k) {
        if (distance_to_segment(a, b, points_[corners[k % n]]) <= tolerance_) continue;
        bad[corners[k % n]] = 1;
        good = false;
      }
      i = j;
    }
    return good;
  }

  bool is_convex(const std::vector<uint32_t>& loop, const Plane& plane) const {
    if (loop.size() > outline_large) return turns_left(points_, loop, plane.normal);
    return is_convex_loop(points_, loop, plane.normal, tolerance_);
  }

  MergedFacets result() const {
    MergedFacets out;
    out.first.push_back(0);
    for (size_t f = 0; f < seeds_.size(); ++f) {
      if (gone_[f]) continue;
      for (uint32_t v : outline(f)) {
        if (meets_[v] > 2) out.corners.push_back(v);
      }
      out.first.push_back(uint32_t(out.corners.size()));
      out.planes.push_back(planes_[f]);
    }
    return out;
  }

  std::span<const Vec3> points_;
  std::span<const HullTriangle> triangles_;
  double tolerance_;
  std::vector<TriangleShape> shapes_;
  std::vector<uint8_t> level_;   // level of the facet whose seed is each triangle
  std::vector<uint32_t> links_;  // next corner of each one in the outline being built
  std::vector<uint32_t> meets_;  // number of facets at each point
  std::vector<uint32_t> order_;  // triangles, largest first
  bool patient_ = true;
  std::vector<uint32_t> region_;  // seed of the facet that each triangle belongs to
  std::vector<uint32_t> members_;
  // Of facets: seed, and outline before corners are removed.
  std::vector<uint32_t> seeds_, first_, outlines_;
  std::vector<Plane> planes_;
  std::vector<uint8_t> gone_;
};

}  // namespace

MergedFacets merge_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                          double tolerance) {
  return Merger(points, triangles, tolerance).run();
}

MergedFacets separate_facets(std::span<const Vec3> points, std::span<const HullTriangle> triangles,
                             double tolerance) {
  const auto shapes = shapes_of(points, triangles, tolerance);
  MergedFacets out;
  for (size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& v = triangles[t].vertices;
    out.first.push_back(uint32_t(3 * t));
    out.corners.insert(out.corners.end(), v.begin(), v.end());
    out.planes.push_back(support_plane(points, v, shapes[t].normal));
  }
  out.first.push_back(uint32_t(out.corners.size()));
  return out;
}

}  // namespace tumble
