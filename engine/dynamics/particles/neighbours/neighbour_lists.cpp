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
  px_.resize(order_.size()), py_.resize(order_.size()), pz_.resize(order_.size());
  for_chunks(crew, order_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t p = first; p < last; ++p) {
      const Vec3& at = points[order_[p]];
      px_[p] = at[0], py_[p] = at[1], pz_[p] = at[2];
    }
  });
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

void NeighbourLists::list_cells(Crew* crew) {
  const std::span<const CellOrder::Cell> cells = cells_.cells();
  const auto filling = uint32_t(places() - 1);
  const double reach = request_.reach + request_.skin;
  const auto reach2 = float(reach * reach * (1 + tolerances::neighbour_rounding));
  lists_.resize(size());
  stores_.resize(chunk_count);
  candidates_.resize(chunk_count);
  for_chunks(
      crew, cells.size(),
      [&](size_t chunk, size_t first, size_t last) {
        std::vector<uint32_t>& store = stores_[chunk];
        size_t used = 0;
        Candidates& near = candidates_[chunk];
        for (size_t c = first; c < last; ++c) {
          near.collect(cells_, ghost_cells_, cells[c], px_, py_, pz_, uint32_t(size()), ordinals_);
          const NeighbourCandidates candidates = near.view();
          for (uint32_t p = cells[c].first; p < cells[c].end; ++p) {
            const size_t begin = used, room = begin + candidates.padded + batch;
            if (store.size() < room) store.resize(2 * room);
            const auto point = near.relative({px_[p], py_[p], pz_[p]});
            const size_t found =
                gather_near(candidates, point.data(), reach2, p, store.data() + begin);
            const size_t padded = (found + batch - 1) / batch * batch;
            std::fill_n(store.begin() + ptrdiff_t(begin + found), padded - found, filling);
            used += padded;
            lists_[p] = {uint32_t(chunk), uint32_t(begin), uint32_t(found), uint32_t(padded), 0};
            if (!request_.by_index) continue;
            const std::span<const uint32_t> list{store.data() + begin, found};
            lists_[p].before =
                uint32_t(std::ranges::lower_bound(list, ordinals_[p], {},
                                                  [this](uint32_t q) { return ordinals_[q]; }) -
                         list.begin());
          }
        }
      },
      16);
}

}  // namespace tumble
