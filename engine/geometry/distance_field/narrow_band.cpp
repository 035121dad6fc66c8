#include "engine/geometry/distance_field/narrow_band.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/distance_field/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace tumble {
namespace {

constexpr int row_cells = FieldLayout::cells_along, row_nodes = FieldLayout::nodes_along;

/// A triangle prepared for distance tests: its bounding ball about the centroid, and its plane.
struct MeasuredTriangle {
  std::array<Vec3, 3> corner;
  Vec3 middle, normal;  ///< `normal` is zero for a triangle without area
  double radius;

  MeasuredTriangle(const TriangleMesh& mesh, uint32_t t)
      : corner{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)},
        middle((corner[0] + corner[1] + corner[2]) / 3) {
    double square = 0;
    for (const Vec3& c : corner) square = std::max(square, (c - middle).squaredNorm());
    radius = std::sqrt(square) * (1 + tolerances::distance_rounding);
    const Vec3 cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double length = cross.norm();
    // A normal of about the size of its rounding error has no meaning.
    normal = length > tolerances::node_error * square ? Vec3(cross / length) : Vec3(Vec3::Zero());
  }
};

struct Near {
  uint32_t block, triangle;
};

/// Appends the blocks within range of one triangle.
void near_blocks(const MeasuredTriangle& m, uint32_t t, const FieldLayout& layout, double range,
                 std::vector<Near>& out) {
  Aabb box;
  for (const Vec3& c : m.corner) box.include(c);
  const double size = layout.block_size();
  std::array<int, 3> low, high;
  for (int k = 0; k < 3; ++k) {
    const int most = layout.blocks[size_t(k)] - 1;
    const double from = std::floor((box.min[k] - range - layout.origin[k]) / size),
                 to = std::floor((box.max[k] + range - layout.origin[k]) / size);
    low[size_t(k)] = int(std::clamp(from, 0.0, double(most)));
    high[size_t(k)] = int(std::clamp(to, 0.0, double(most)));
  }
  const double reach = range + size / 2 * m.normal.cwiseAbs().sum();
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const Vec3 first = layout.node(row_cells * x, row_cells * y, row_cells * z),
                   centre = first.array() + size / 2;
        if (std::fabs(m.normal.dot(centre - m.middle)) > reach) continue;
        double square = 0;
        for (int k = 0; k < 3; ++k) {
          const double gap = std::max({first[k] - box.max[k], box.min[k] - first[k] - size, 0.0});
          square += gap * gap;
        }
        if (square <= range * range) out.push_back({uint32_t(layout.block_index(x, y, z)), t});
      }
}

/// A row of nodes, padded by one, so that pairs of numbers can be computed at once.
using Row = Eigen::Array<double, row_nodes + 1, 1>;

/// The nodes of one block with their least squared distances so far.
class BlockMeasure {
 public:
  BlockMeasure(const FieldLayout& layout, size_t block, double range)
      : range_(range), cell_(layout.cell) {
    const auto place = layout.block_place(block);
    for (int k = 0; k < 3; ++k)
      for (int n = 0; n <= row_nodes; ++n)
        at_[size_t(k)][n] = layout.at(k, row_cells * place[size_t(k)] + n);
    best_.fill(Row::Constant(range * range));
  }

  /// Upper bound by the distance from the centroid of a triangle, which is cheap and saves most of
  /// the exact tests.
  void offer_middle(const MeasuredTriangle& m) {
    each_row(m, [&](int y, int z, double square, double) {
      Row& best = row(y, z);
      best = best.min(((at_[0] - m.middle.x()).square() + square) * (1 + tolerances::prune_slack));
    });
  }

  void offer(const MeasuredTriangle& m) {
    each_row(m, [&](int y, int z, double square, double height) {
      Row& best = row(y, z);
      // In its plane the triangle lies in a disc of radius r about its centroid. So, with q^2 =
      // best - height^2, only nodes whose projections are within r + q of the centroid can get
      // nearer.
      const double r_square = m.radius * m.radius;
      const Row dx = at_[0] - m.middle.x();
      const Row height_square = (height + m.normal.x() * dx).square();
      const Row q_square = best * (1 + tolerances::prune_slack) - height_square;
      const Row beyond = (dx.square() + square - height_square - r_square - q_square).max(0.0);
      const Row chance = q_square.min(4 * r_square * q_square - beyond.square());
      if (!(chance.maxCoeff() >= 0)) return;
      for (int x = 0; x < row_nodes; ++x) {
        if (!(chance[x] >= 0)) continue;
        const Vec3 p(at_[0][x], at_[1][y], at_[2][z]);
        const double found =
            closest_on_triangle(p, m.corner[0], m.corner[1], m.corner[2]).squared_distance;
        best[x] = std::min(best[x], found);
      }
    });
  }

  /// Writes the distances; infinity if nothing is within the range.
  void write(BlockDistances& out) const {
    for (int z = 0; z < row_nodes; ++z)
      for (int y = 0; y < row_nodes; ++y)
        for (int x = 0; x < row_nodes; ++x) {
          const double square = best_[size_t(z * row_nodes + y)][x];
          out[FieldLayout::node_in_block(x, y, z)] = square < range_ * range_
                                                         ? std::sqrt(square)
                                                         : std::numeric_limits<double>::infinity();
        }
  }

 private:
  Row& row(int y, int z) { return best_[size_t(z * row_nodes + y)]; }

  /// Calls f for the rows within reach of a triangle, with the parts of the squared distance from
  /// the centroid and of the height over the plane that their nodes have in common.
  template <class F>
  void each_row(const MeasuredTriangle& m, const F& f) const {
    std::array<int, 3> low, high;
    for (size_t k = 1; k < 3; ++k) {
      const int axis = int(k);
      const auto [least, most] =
          std::minmax({m.corner[0][axis], m.corner[1][axis], m.corner[2][axis]});
      const double first = at_[k][0];
      low[k] = int(std::clamp(std::ceil((least - range_ - first) / cell_), 0.0, double(row_nodes)));
      high[k] =
          int(std::clamp(std::floor((most + range_ - first) / cell_), -1.0, double(row_cells)));
    }
    const double row_reach = (range_ + m.radius) * (range_ + m.radius);
    for (int z = low[2]; z <= high[2]; ++z) {
      const double dz = at_[2][z] - m.middle.z();
      for (int y = low[1]; y <= high[1]; ++y) {
        const double dy = at_[1][y] - m.middle.y(), square = dz * dz + dy * dy;
        if (square > row_reach) continue;
        f(y, z, square, m.normal.z() * dz + m.normal.y() * dy);
      }
    }
  }

  double range_, cell_;
  std::array<Row, 3> at_;  ///< coordinates of the nodes along each axis [m]
  std::array<Row, size_t(row_nodes* row_nodes)> best_;  ///< squared [m^2]
};

}  // namespace

BlockTriangles triangles_near_blocks(const TriangleMesh& mesh, const FieldLayout& layout,
                                     double range, Crew* crew) {
  std::vector<std::vector<Near>> found(chunk_count);
  for_chunks(crew, mesh.triangles.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t t = first; t < last && !stop_requested(); ++t)
      near_blocks(MeasuredTriangle(mesh, uint32_t(t)), uint32_t(t), layout, range, found[chunk]);
  });
  if (stop_requested()) return {};
  // Triangles are in ascending order within chunks; counting sort preserves that.
  std::vector<size_t> start(layout.block_count() + 1, 0);
  for (const auto& part : found)
    for (const Near& n : part) ++start[n.block + 1];
  BlockTriangles out;
  for (size_t b = 0; b < layout.block_count(); ++b) {
    if (start[b + 1] > 0) {
      out.blocks.push_back(b);
      out.first.push_back(start[b]);
    }
    start[b + 1] += start[b];
  }
  out.first.push_back(start.back());
  out.triangles.resize(start.back());
  for (const auto& part : found)
    for (const Near& n : part) out.triangles[start[n.block]++] = n.triangle;
  return out;
}

void measure_block(const TriangleMesh& mesh, const FieldLayout& layout, size_t block,
                   std::span<const uint32_t> triangles, double range, BlockDistances& out) {
  std::vector<MeasuredTriangle> measured;
  measured.reserve(triangles.size());
  for (const uint32_t t : triangles) measured.emplace_back(mesh, t);
  BlockMeasure measure(layout, block, range);
  for (const MeasuredTriangle& m : measured) measure.offer_middle(m);
  for (const MeasuredTriangle& m : measured) measure.offer(m);
  measure.write(out);
}

}  // namespace tumble
