#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tumble {

/// How points answer to each other's impulses: the Delassus matrix of three rows for each point, of
/// which the first names its bodies. Only the 3 x 3 blocks of two points that act on the same
/// body are kept: memory and products grow with the points times those of one body. Points of
/// jointed bodies, which pass everything on, all answer to each other.
class PointMobility {
 public:
  PointMobility() = default;
  /// Entries are zero where a stop is requested.
  PointMobility(std::span<const Row> rows, std::span<const DofBlock> blocks,
                const Articulation& joints);

  int points() const { return int(first_.size()) - 1; }
  /// How many points answer to one, itself among them.
  size_t degree(int point) const { return end(point) - begin(point); }
  /// How many blocks are kept.
  size_t size() const { return entries_.size(); }
  /// The block of a point by itself.
  const Mat3& own(int point) const { return entries_[own_[size_t(point)]].block; }
  /// Calls f(row, block) for the blocks in the column of a point.
  template <class F>
  void for_column(int point, const F& f) const {
    for (size_t at = begin(point); at < end(point); ++at)
      f(int(entries_[at].row), entries_[at].block);
  }
  /// y += A z, summed in the order of the points.
  void add_product(const Eigen::VectorXd& z, Eigen::VectorXd& y) const;
  /// The same for an impulse at one point.
  void add_product(int point, const Vec3& impulse, Eigen::VectorXd& y) const;
  /// All of the matrix that is in these rows and columns, which ascend.
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

  std::vector<size_t> first_{0};  ///< by point: of its column
  std::vector<Entry> entries_;    ///< column by column, rows ascending
  std::vector<size_t> own_;       ///< by point: its entry on the diagonal
};

}  // namespace tumble
