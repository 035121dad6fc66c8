#include "engine/dynamics/event/impulses/point_mobility.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/rows/delassus.hpp"

#include <algorithm>

namespace tumble {
namespace {

bool answers(uint32_t block, std::span<const DofBlock> blocks) {
  return block != no_block &&
         (blocks[block].inverse_mass > 0 || !blocks[block].inverse_inertia.isZero(0));
}

/// By block: whether it moves and is held by joints.
std::vector<char> jointed_blocks(std::span<const DofBlock> blocks, const Articulation& joints) {
  std::vector<char> out(blocks.size(), 0);
  for (size_t row = 0; row < joints.size(); ++row)
    joints.for_sides(row, [&](const RowSide& s) { out[s.block] = answers(s.block, blocks); });
  return out;
}

}  // namespace

PointMobility::PointMobility(std::span<const Row> rows, std::span<const DofBlock> blocks,
                             const Articulation& joints) {
  // All jointed bodies together count as one more block.
  const auto all_jointed = uint32_t(blocks.size());
  const std::vector<char> is_jointed = jointed_blocks(blocks, joints);
  std::vector<std::array<uint32_t, 2>> blocks_of(rows.size() / 3, {no_block, no_block});
  std::vector<std::vector<uint32_t>> points_at(blocks.size() + 1);
  for (uint32_t point = 0; point < blocks_of.size(); ++point) {
    const Row& row = rows[3 * size_t(point)];
    size_t side = 0;
    for (const uint32_t block : {row.a.block, row.b.block}) {
      if (!answers(block, blocks)) continue;
      const uint32_t at = is_jointed[block] ? all_jointed : block;
      blocks_of[point][side++] = at;
      if (points_at[at].empty() || points_at[at].back() != point) points_at[at].push_back(point);
    }
  }
  lay_out(blocks_of, points_at);
  fill(rows, blocks);
  if (!points_at[all_jointed].empty()) reduce(rows, points_at[all_jointed], joints);
}

void PointMobility::lay_out(std::span<const std::array<uint32_t, 2>> blocks_of,
                            std::span<const std::vector<uint32_t>> points_at) {
  std::vector<uint32_t> column;
  for (uint32_t point = 0; point < blocks_of.size(); ++point) {
    column.assign(1, point);
    for (const uint32_t at : blocks_of[point])
      if (at != no_block) column.insert(column.end(), points_at[at].begin(), points_at[at].end());
    std::ranges::sort(column);
    column.erase(std::unique(column.begin(), column.end()), column.end());
    charge_work(column.size(), 20);
    if (stop_requested()) column.assign(1, point);
    for (const uint32_t row : column) {
      if (row == point) own_.push_back(entries_.size());
      entries_.push_back({row, Mat3::Zero()});
    }
    first_.push_back(entries_.size());
  }
}

/// Computes the entries above the diagonal; those below are their transposes. The entries of a
/// column below its diagonal are filled in ascending order by the later columns.
void PointMobility::fill(std::span<const Row> rows, std::span<const DofBlock> blocks) {
  std::vector<size_t> mirror;
  for (const size_t own : own_) mirror.push_back(own + 1);
  for (int point = 0; point < points(); ++point) {
    charge_work(degree(point), size_t{9 * 8});
    if (stop_requested()) return;
    std::array<Row, 3> moved;
    for (size_t c = 0; c < 3; ++c) moved[c] = response(rows[3 * size_t(point) + c], blocks);
    for (size_t at = begin(point); at < own_[size_t(point)]; ++at) {
      const size_t row = entries_[at].row;
      Mat3& block = entries_[at].block;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          block(r, c) = coupling(rows[3 * row + size_t(r)], moved[size_t(c)]);
      entries_[mirror[row]++].block = block.transpose();
    }
    Mat3& own = entries_[own_[size_t(point)]].block;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r <= c; ++r)
        own(r, c) = own(c, r) = coupling(rows[3 * size_t(point) + size_t(r)], moved[size_t(c)]);
  }
}

/// Reduces the entries of points on jointed bodies by their joints.
void PointMobility::reduce(std::span<const Row> rows, std::span<const uint32_t> jointed,
                           const Articulation& joints) {
  std::vector<Eigen::Index> which;
  std::vector<Row> of_jointed;
  for (const uint32_t point : jointed)
    for (size_t r = 3 * size_t(point); r < 3 * size_t(point) + 3; ++r) {
      which.push_back(Eigen::Index(r));
      of_jointed.push_back(rows[r]);
    }
  Eigen::MatrixXd A = dense(which);
  joints.reduce(of_jointed, A);
  for (size_t j = 0; j < jointed.size(); ++j) {
    size_t i = 0;
    for (size_t at = begin(int(jointed[j])); at < end(int(jointed[j])); ++at) {
      while (i < jointed.size() && jointed[i] < entries_[at].row) ++i;
      if (i == jointed.size() || jointed[i] != entries_[at].row) continue;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          entries_[at].block(r, c) = A(3 * Eigen::Index(i) + r, 3 * Eigen::Index(j) + c);
    }
  }
}

void PointMobility::add_product(int point, const Vec3& impulse, Eigen::VectorXd& y) const {
  charge_work(degree(point), 9);
  for_column(point, [&](int row, const Mat3& block) {
    for (int r = 0; r < 3; ++r) {
      double& sum = y[3 * row + r];
      for (int c = 0; c < 3; ++c) sum += block(r, c) * impulse[c];
    }
  });
}

void PointMobility::add_product(const Eigen::VectorXd& z, Eigen::VectorXd& y) const {
  for (int point = 0; point < points(); ++point) {
    const Vec3 impulse(z[3 * point], z[3 * point + 1], z[3 * point + 2]);
    if (!impulse.isZero(0)) add_product(point, impulse, y);
  }
}

Eigen::MatrixXd PointMobility::dense(std::span<const Eigen::Index> rows) const {
  const auto n = Eigen::Index(rows.size());
  std::vector<Eigen::Index> place(3 * size_t(points()), -1);
  for (Eigen::Index i = 0; i < n; ++i) place[size_t(rows[size_t(i)])] = i;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Index column = rows[size_t(j)];
    for (size_t at = begin(int(column / 3)); at < end(int(column / 3)); ++at)
      for (int r = 0; r < 3; ++r)
        if (const Eigen::Index i = place[3 * size_t(entries_[at].row) + size_t(r)]; i >= 0)
          A(i, j) = entries_[at].block(r, int(column % 3));
  }
  return A;
}

}  // namespace tumble
