#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <tuple>

#include <fmt/format.h>

namespace tumble {
namespace {

Status check_points(std::span<const Vec3> x, const NeighbourLists::Request& r) {
  const double reach = r.reach + r.skin;
  if (!(r.reach > 0) || !(r.skin >= 0) || !std::isfinite(reach))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("a reach of {} m with a skin of {} m", r.reach, r.skin), "neighbours",
                 "give a positive reach"};
  for (int k = 0; k < 3; ++k)
    if (r.box.along(k) && r.box.size[k] < reach)
      return Error{ErrorCode::invalid_argument,
                   fmt::format("the periodic box is {} m along axis {}, shorter than the reach of "
                               "{} m",
                               r.box.size[k], k, reach),
                   "neighbours", "make the box larger or the cut-off shorter"};
  if (x.size() >= UINT32_MAX / 4)
    return Error{ErrorCode::invalid_argument, fmt::format("{} points", x.size()), "neighbours",
                 "use fewer"};
  for (size_t i = 0; i < x.size(); ++i)
    if (!(x[i].cwiseAbs().maxCoeff() < tolerances::most_cells * reach))
      return Error{ErrorCode::numeric,
                   fmt::format("a point is at ({}, {}, {}) m", x[i][0], x[i][1], x[i][2]),
                   fmt::format("point {}", i),
                   "no cells of the size of the reach can tell it apart"};
  return {};
}

using Edges = std::array<int8_t, 3>;

/// Number of edges of a box from a point to the copy of it that is nearest to another position, if
/// that is at most one along each axis.
Edges edges_between(const PeriodicBox& box, const Vec3& x, const Vec3& near) {
  Edges n{};
  for (int k = 0; k < 3; ++k) {
    const double d = near[k] - x[k], half = 0.5 * box.size[k];
    if (box.along(k)) n[size_t(k)] = int8_t(int(d > half) - int(d < -half));
  }
  return n;
}

/// PeriodicBox::wrapped() that avoids divisions where the point is inside.
Vec3 wrapped(const PeriodicBox& box, const Vec3& x) {
  for (int k = 0; k < 3; ++k)
    if (box.along(k) && !(x[k] - box.low[k] >= 0 && x[k] - box.low[k] < box.size[k]))
      return box.wrapped(x);
  return x;
}

Vec3 shifted(const PeriodicBox& box, const Vec3& x, const Edges& n) {
  return {x[0] + n[0] * box.size[0], x[1] + n[1] * box.size[1], x[2] + n[2] * box.size[2]};
}

}  // namespace

/// Lists of a chunk, one behind the other.
class NeighbourLists::ListWriter {
 public:
  ListWriter(std::vector<uint32_t>& store, uint32_t filling) : store_(store), filling_(filling) {}
  /// Room for so many places of the next list.
  uint32_t* room(size_t most) {
    if (store_.size() < used_ + most) store_.resize(2 * (used_ + most));
    return store_.data() + used_;
  }
  /// Keeps as many as were found, and fills them up to a multiple of `batch`.
  std::span<const uint32_t> keep(size_t found, size_t batch) {
    const size_t padded = (found + batch - 1) / batch * batch;
    uint32_t* list = store_.data() + used_;
    std::fill_n(list + found, padded - found, filling_);
    used_ += padded;
    return {list, padded};
  }
  size_t used() const { return used_; }

 private:
  std::vector<uint32_t>& store_;
  uint32_t filling_;
  size_t used_ = 0;
};

Result<bool> NeighbourLists::update(std::span<const Vec3> x, const Request& request, Crew* crew) {
  if (Status fine = check_points(x, request); !fine) return fine.error();
  if (hold(x, request, crew)) {
    move(x, crew);
    return false;
  }
  request_ = request;
  place_points(x, crew);
  add_ghosts();
  number_places();
  if (request_.by_group)
    list_groups(crew);
  else
    list_cells(crew);
  from_x_ = px_, from_y_ = py_, from_z_ = pz_;
  return true;
}

bool NeighbourLists::hold(std::span<const Vec3> x, const Request& request, Crew* crew) const {
  if (!(request == request_) || x.size() != size() || request.skin == 0) return false;
  const double most = 0.25 * request.skin * request.skin;
  std::atomic<bool> moved = false;
  for_chunks(crew, size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) {
      const Vec3 d = x[order_[p]] - Vec3(from_x_[p], from_y_[p], from_z_[p]);
      if (d.squaredNorm() <= most || request.box.shortest(d).squaredNorm() <= most) continue;
      moved.store(true, std::memory_order_relaxed);
      return;
    }
  });
  return !moved;
}

void NeighbourLists::move(std::span<const Vec3> x, Crew* crew) {
  const PeriodicBox& box = request_.box;
  for_chunks(crew, size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) {
      Vec3 to = x[order_[p]];
      if (box.any()) {
        const Vec3 in_box = wrapped_[order_[p]] = wrapped(box, to);
        edges_[p] = edges_between(box, in_box, {from_x_[p], from_y_[p], from_z_[p]});
        to = shifted(box, in_box, edges_[p]);
      }
      px_[p] = to[0], py_[p] = to[1], pz_[p] = to[2];
    }
  });
  for (size_t g = 0; g < ghost_owners_.size(); ++g) {
    const size_t p = size() + g, owner = ghost_owners_[g];
    for (size_t k = 0; k < 3; ++k) edges_[p][k] = int8_t(edges_[owner][k] + ghost_edges_[g][k]);
    const Vec3 at = shifted(box, wrapped_[order_[owner]], edges_[p]);
    px_[p] = at[0], py_[p] = at[1], pz_[p] = at[2];
  }
}

Vec3 NeighbourLists::beside(size_t place, size_t other) const {
  if (edges_.empty() || other + 1 == places()) return {px_[other], py_[other], pz_[other]};
  Edges apart;
  for (size_t k = 0; k < 3; ++k) apart[k] = int8_t(edges_[other][k] - edges_[place][k]);
  return shifted(request_.box, wrapped_[order_[owner(other)]], apart);
}

void NeighbourLists::place_points(std::span<const Vec3> x, Crew* crew) {
  std::span<const Vec3> points = x;
  wrapped_.clear();
  if (request_.box.any()) {
    wrapped_.resize(x.size());
    for (size_t i = 0; i < x.size(); ++i) wrapped_[i] = request_.box.wrapped(x[i]);
    points = wrapped_;
  }
  cells_.sort(points, request_.reach + request_.skin);
  order_.assign(cells_.order().begin(), cells_.order().end());
  if (request_.by_group) sort_octants(points);
  px_.resize(order_.size()), py_.resize(order_.size()), pz_.resize(order_.size());
  for_chunks(crew, order_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) {
      const Vec3& at = points[order_[p]];
      px_[p] = at[0], py_[p] = at[1], pz_[p] = at[2];
    }
  });
}

/// Sorts the points of a cell by its eighths, so that those of a group are near each other.
void NeighbourLists::sort_octants(std::span<const Vec3> points) {
  const double per_half = 2 / cells_.size();
  for (const CellOrder::Cell& cell : cells_.cells()) {
    const Vec3 middle(2 * double(cell.i) + 1, 2 * double(cell.j) + 1, 2 * double(cell.k) + 1);
    const auto octant = [&](uint32_t index) {
      const Vec3 x = per_half * points[index];
      return int(x[0] >= middle[0]) + 2 * int(x[1] >= middle[1]) + 4 * int(x[2] >= middle[2]);
    };
    octants_.clear();
    for (uint32_t p = cell.first; p < cell.end; ++p)
      octants_.push_back({octant(order_[p]), order_[p]});
    std::ranges::sort(octants_);
    for (uint32_t p = cell.first; p < cell.end; ++p) order_[p] = octants_[p - cell.first].second;
  }
}

void NeighbourLists::add_ghosts() {
  ghost_points_.clear();
  ghost_owners_.clear();
  ghost_edges_.clear();
  owners_.clear();
  copies_.clear();
  const PeriodicBox& box = request_.box;
  const double reach = request_.reach + request_.skin;
  for (size_t p = 0; p < size() && box.any(); ++p) {
    // The copies along each axis within reach of the box: the point itself, and adjacent ones.
    const Vec3 at(px_[p], py_[p], pz_[p]);
    Edges first{}, last{};
    for (int k = 0; k < 3; ++k) {
      if (!box.along(k)) continue;
      first[size_t(k)] = at[k] >= box.low[k] + box.size[k] - reach ? -1 : 0;
      last[size_t(k)] = at[k] < box.low[k] + reach ? 1 : 0;
    }
    for (int8_t k = first[2]; k <= last[2]; ++k)
      for (int8_t j = first[1]; j <= last[1]; ++j)
        for (int8_t i = first[0]; i <= last[0]; ++i) {
          if (i == 0 && j == 0 && k == 0) continue;
          copies_.push_back({i, j, k});
          ghost_points_.push_back(shifted(box, at, copies_.back()));
          owners_.push_back(uint32_t(p));
        }
  }
  ghost_cells_.sort(ghost_points_, reach);
  Aabb bounds;
  bounds.include(Vec3::Zero());
  for (size_t p = 0; p < size(); ++p) bounds.include({px_[p], py_[p], pz_[p]});
  for (const uint32_t g : ghost_cells_.order()) {
    ghost_owners_.push_back(owners_[g]);
    ghost_edges_.push_back(copies_[g]);
    px_.push_back(ghost_points_[g][0]);
    py_.push_back(ghost_points_[g][1]);
    pz_.push_back(ghost_points_[g][2]);
    bounds.include(ghost_points_[g]);
  }
  edges_.clear();
  if (box.any()) {
    edges_.resize(size());
    edges_.insert(edges_.end(), ghost_edges_.begin(), ghost_edges_.end());
  }
  const Vec3 far =
      bounds.max + Vec3::Constant(2 * bounds.extent().maxCoeff() + tolerances::far_reaches * reach);
  px_.push_back(far[0]), py_.push_back(far[1]), pz_.push_back(far[2]);
}

/// Numbers places by the caller's index; copies of one point by their edges along the last axis,
/// then the others, in the order of add_ghosts(), in which the point itself has the place of zero
/// edges.
void NeighbourLists::number_places() {
  ordinals_.clear();
  if (!request_.by_index) return;
  firsts_.assign(size() + 1, 0);
  for (size_t p = 0; p < size(); ++p) firsts_[order_[p] + 1] = 1;
  for (const uint32_t o : owners_) ++firsts_[order_[o] + 1];
  for (size_t i = 0; i < size(); ++i) firsts_[i + 1] += firsts_[i];
  std::vector<uint32_t> of_copies(owners_.size());
  ordinals_.resize(size() + owners_.size());
  size_t g = 0;
  for (size_t p = 0; p < size(); ++p) {
    uint32_t next = firsts_[order_[p]];
    const auto before_itself = [](const Edges& e) {
      return std::tie(e[2], e[1], e[0]) < std::tuple(int8_t{0}, int8_t{0}, int8_t{0});
    };
    for (; g < owners_.size() && owners_[g] == p && before_itself(copies_[g]); ++g)
      of_copies[g] = next++;
    ordinals_[p] = next++;
    for (; g < owners_.size() && owners_[g] == p; ++g) of_copies[g] = next++;
  }
  const std::span<const uint32_t> sorted = ghost_cells_.order();
  for (size_t k = 0; k < sorted.size(); ++k) ordinals_[size() + k] = of_copies[sorted[k]];
}

template <class F>
void NeighbourLists::each_cell(Crew* crew, const F& f) {
  const std::span<const CellOrder::Cell> cells = cells_.cells();
  stores_.resize(chunk_count);
  candidates_.resize(chunk_count);
  for_chunks(
      crew, cells.size(),
      [&](size_t chunk, size_t first, size_t last) {
        ListWriter writer(stores_[chunk], uint32_t(places() - 1));
        Candidates& near = candidates_[chunk];
        for (size_t c = first; c < last; ++c) {
          near.collect(cells_, ghost_cells_, cells[c], px_, py_, pz_, uint32_t(size()), ordinals_);
          f(chunk, c, near, writer);
        }
      },
      16);
}

void NeighbourLists::list_cells(Crew* crew) {
  const std::span<const CellOrder::Cell> cells = cells_.cells();
  const double reach = request_.reach + request_.skin;
  const auto reach2 = float(reach * reach * (1 + tolerances::neighbour_rounding));
  lists_.resize(size());
  each_cell(crew, [&](size_t chunk, size_t c, const Candidates& near, ListWriter& writer) {
    const NeighbourCandidates candidates = near.view();
    for (uint32_t p = cells[c].first; p < cells[c].end; ++p) {
      const auto point = near.relative({px_[p], py_[p], pz_[p]});
      const size_t found =
          gather_near(candidates, point.data(), reach2, p, writer.room(candidates.padded + batch));
      const std::span<const uint32_t> list = writer.keep(found, batch);
      lists_[p] = {uint32_t(chunk), uint32_t(writer.used() - list.size()), uint32_t(found),
                   uint32_t(list.size()), 0};
      if (!request_.by_index) continue;
      const auto real = list.first(found);
      lists_[p].before =
          uint32_t(std::ranges::lower_bound(real, ordinals_[p], {},
                                            [this](uint32_t q) { return ordinals_[q]; }) -
                   real.begin());
    }
  });
}

void NeighbourLists::list_groups(Crew* crew) {
  const std::span<const CellOrder::Cell> cells = cells_.cells();
  const double reach = request_.reach + request_.skin;
  const auto reach2 = float(reach * reach * (1 + tolerances::neighbour_rounding));
  first_group_.resize(cells.size());
  uint32_t count = 0;
  for (size_t c = 0; c < cells.size(); ++c) {
    first_group_[c] = count;
    count += uint32_t((cells[c].end - cells[c].first + group_size - 1) / group_size);
  }
  groups_.resize(count);
  each_cell(crew, [&](size_t chunk, size_t c, const Candidates& near, ListWriter& writer) {
    const NeighbourCandidates candidates = near.view();
    uint32_t g = first_group_[c];
    for (uint32_t first = cells[c].first; first < cells[c].end; first += group_size, ++g) {
      const uint32_t end = std::min(cells[c].end, first + uint32_t(group_size));
      float points[3][group_size];
      for (uint32_t n = 0; n < group_size; ++n) {
        const uint32_t p = std::min(first + n, end - 1);
        const auto point = near.relative({px_[p], py_[p], pz_[p]});
        for (size_t k = 0; k < 3; ++k) points[k][n] = point[k];
      }
      const size_t found = gather_near_four(candidates, points, reach2,
                                            writer.room(candidates.padded + batch + look_ahead));
      const size_t padded = writer.keep(found, group_size).size();
      groups_[g] = {first, end - first, uint32_t(chunk), uint32_t(writer.used() - padded),
                    uint32_t(padded)};
    }
  });
}

}  // namespace tumble
