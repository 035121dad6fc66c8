#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// Delassus matrix of points with three rows each, of which the first names the bodies. Only the 3
/// x 3 blocks of points that act on a common body are stored: memory and products grow with the
/// number of points times the points per body. All points on jointed bodies count as coupled.
class PointMobility {
 public:
  PointMobility() = default;
  /// Entries are zero if a stop was requested.
  PointMobility(std::span<const Row> rows, std::span<const DofBlock> blocks,
                const Articulation& joints);

  int points() const { return int(first_.size()) - 1; }
  /// How many points an impulse at one point moves, itself included.
  size_t degree(int point) const { return end(point) - begin(point); }
  /// Number of stored blocks.
  size_t size() const { return entries_.size(); }
  /// The diagonal block of a point.
  const Mat3& own(int point) const { return entries_[own_[size_t(point)]].block; }
  /// Calls f(row, block) for the blocks in the column of a point.
  template <class F>
  void for_column(int point, const F& f) const {
    for (size_t at = begin(point); at < end(point); ++at)
      f(int(entries_[at].row), entries_[at].block);
  }
  /// y += A z, summed in the order of the points.
  void add_product(const Eigen::VectorXd& z, Eigen::VectorXd& y) const;
  /// y += A z for an impulse at one point only.
  void add_product(int point, const Vec3& impulse, Eigen::VectorXd& y) const;
  /// The submatrix of these rows and columns (ascending indices of unknowns).
  Eigen::MatrixXd dense(std::span<const Eigen::Index> rows) const;

 private:
  /// A block of a column.
  struct Entry {
    uint32_t row = 0;  ///< point
    Mat3 block;
  };
  size_t begin(int point) const { return first_[size_t(point)]; }
  size_t end(int point) const { return first_[size_t(point) + 1]; }
  void lay_out(std::span<const std::array<uint32_t, 2>> blocks_of,
               std::span<const std::vector<uint32_t>> points_at);
  void fill(std::span<const Row> rows, std::span<const DofBlock> blocks);
  void reduce(std::span<const Row> rows, std::span<const uint32_t> jointed,
              const Articulation& joints);

  std::vector<size_t> first_{0};  ///< by point: index of its column's first entry
  std::vector<Entry> entries_;    ///< column by column, rows ascending
  std::vector<size_t> own_;       ///< by point: index of its diagonal entry
};

}  // namespace tumble
