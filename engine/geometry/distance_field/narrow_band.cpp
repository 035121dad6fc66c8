#include "engine/geometry/distance_field/narrow_band.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/distance_field/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace tumble {
namespace {

struct Near {
  uint32_t tile, triangle;
};

/// The longest side of a triangle, and how far the triangle reaches from it: for one whose normal
/// is of no use, a bound from below on distances.
class Needle {
 public:
  Needle(const TriangleMesh& mesh, uint32_t t) {
    double longest = -1;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.corner(t, k), &b = mesh.corner(t, (k + 1) % 3);
      if (!((b - a).squaredNorm() > longest)) continue;
      longest = (b - a).squaredNorm();
      start_ = a, side_ = b - a, inverse_square_ = longest > 0 ? 1 / longest : 0;
      tip_ = mesh.corner(t, (k + 2) % 3);
    }
    width_ = std::sqrt(square_from_side(tip_));
  }
  /// Whether the triangle is surely farther from p than this [m].
  bool beyond(const Vec3& p, double distance) const {
    const double reach = distance + width_;
    return square_from_side(p) > (1 + tolerances::prune_slack) * reach * reach;
  }

 private:
  double square_from_side(const Vec3& p) const {
    const Vec3 from = p - start_;
    const double s = std::clamp(from.dot(side_) * inverse_square_, 0.0, 1.0);
    return (from - s * side_).squaredNorm();
  }

  Vec3 start_, side_, tip_;
  double inverse_square_ = 0, width_ = 0;
};

/// Side of the box of a tile's nodes [m].
double tile_size(const FieldLayout& layout) {
  return layout.cell * (tile_nodes - 1);
}

/// Finds the tiles within range of triangles.
class NearTiles {
 public:
  NearTiles(const FieldLayout& layout, double range)
      : layout_(layout),
        range_(range),
        size_(tile_size(layout)),
        inverse_step_(1 / layout.block_size()) {}

  /// Appends those of one triangle; whether it is narrow.
  bool add(const TriangleMesh& mesh, uint32_t t, std::vector<Near>& out) const {
    const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const Vec3 cross = (b - a).cross(c - a);
    const double square = cross.squaredNorm();
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    constexpr double sine = tolerances::narrow_sine;
    const bool narrow = !(square > sine * sine * longest * longest);
    const Vec3 normal = narrow ? Vec3(Vec3::Zero()) : Vec3(cross / std::sqrt(square));
    const auto [first, last] = places(low, high);
    const double reach = range_ + size_ / 2 * normal.cwiseAbs().sum();
    const double plane = normal.dot(a);
    std::optional<Needle> needle;
    if (narrow) needle.emplace(mesh, t);
    const double within = range_ + size_ / 2 * std::numbers::sqrt3;
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) {
          const Vec3 corner = layout_.node(tile_nodes * x, tile_nodes * y, tile_nodes * z);
          const Vec3 centre = corner.array() + size_ / 2;
          if (std::fabs(normal.dot(centre) - plane) > reach) continue;
          if (needle && needle->beyond(centre, within)) continue;
          double gap_square = 0;
          for (int k = 0; k < 3; ++k) {
            const double gap = std::max({corner[k] - high[k], low[k] - corner[k] - size_, 0.0});
            gap_square += gap * gap;
          }
          if (gap_square > range_ * range_) continue;
          out.push_back({uint32_t(layout_.block_index(x, y, z)), t});
        }
    return narrow;
  }

 private:
  /// The first and the last tiles that a box with the range about it may meet.
  std::pair<std::array<int, 3>, std::array<int, 3>> places(const Vec3& low,
                                                           const Vec3& high) const {
    std::pair<std::array<int, 3>, std::array<int, 3>> out;
    for (int k = 0; k < 3; ++k) {
      const double most = layout_.blocks[size_t(k)] - 1;
      const double from = (low[k] - range_ - layout_.origin[k]) * inverse_step_,
                   to = (high[k] + range_ - layout_.origin[k]) * inverse_step_;
      out.first[size_t(k)] = int(std::clamp(from, 0.0, most));
      out.second[size_t(k)] = int(std::clamp(to, 0.0, most));
    }
    return out;
  }

  const FieldLayout& layout_;
  double range_, size_, inverse_step_;
};

}  // namespace

NearTriangles triangles_near_tiles(const TriangleMesh& mesh, const FieldLayout& layout,
                                   double range, Crew* crew) {
  NearTriangles out;
  out.narrow.resize(mesh.triangles.size());
  std::vector<std::vector<Near>> found(chunk_count);
  const NearTiles tiles(layout, range);
  for_chunks(crew, mesh.triangles.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t t = first; t < last && !stop_requested(); ++t)
      out.narrow[t] = tiles.add(mesh, uint32_t(t), found[chunk]);
  });
  if (stop_requested()) return {};
  // Triangles are in ascending order within chunks; counting sort preserves that.
  std::vector<size_t> start(layout.block_count() + 1, 0);
  for (const auto& part : found)
    for (const Near& n : part) ++start[n.tile + 1];
  for (size_t b = 0; b < layout.block_count(); ++b) {
    if (start[b + 1] > 0) {
      out.tiles.push_back(b);
      out.first.push_back(start[b]);
    }
    start[b + 1] += start[b];
  }
  out.first.push_back(start.back());
  out.triangles.resize(start.back());
  for (const auto& part : found)
    for (const Near& n : part) out.triangles[start[n.tile]++] = n.triangle;
  return out;
}

const TileDistances& TileMeasure::squares(const TriangleMesh& mesh, const FieldLayout& layout,
                                          double range, const NearTriangles& near, size_t n) {
  const auto place = layout.block_place(near.tiles[n]);
  const Vec3 first =
      layout.node(tile_nodes * place[0], tile_nodes * place[1], tile_nodes * place[2]);
  const auto triangles = near.of(n);
  narrow_.clear();
  triangles_.resize(triangles.size());
  size_t count = 0;
  for (const uint32_t t : triangles) {
    if (near.narrow[t]) {
      narrow_.push_back(t);
      continue;
    }
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 corner = mesh.corner(t, k) - first;
      for (size_t axis = 0; axis < 3; ++axis)
        triangles_.column(TileTriangles::corner + 3 * k + axis)[count] = corner[int(axis)];
    }
    ++count;
  }
  triangles_.keep(count);
  best_.fill(range * range);
  prepare_triangles(triangles_);
  measure_tile(triangles_, layout.cell, range * range, best_);
  measure_narrow(mesh, first, layout.cell);
  return best_;
}

/// Triangles whose normals are of no use: for them distances are computed one by one, by digits
/// enough (closest_on_triangle).
void TileMeasure::measure_narrow(const TriangleMesh& mesh, const Vec3& first, double cell) {
  for (const uint32_t t : narrow_) {
    const Needle needle(mesh, t);
    for (int z = 0; z < tile_nodes; ++z)
      for (int y = 0; y < tile_nodes; ++y)
        for (int x = 0; x < tile_nodes; ++x) {
          const Vec3 p = first + cell * Vec3(x, y, z);
          double& best = best_[node_in_tile(x, y, z)];
          if (needle.beyond(p, std::sqrt(best))) continue;
          best = std::min(
              best, closest_on_triangle(p, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))
                        .squared_distance);
        }
  }
}

}  // namespace tumble
