#include "engine/dynamics/grains/grain_cells.hpp"

#include "engine/core/chunks.hpp"
#include "engine/dynamics/grains/tolerances.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace tumble {
namespace {

Status check_places(const GrainField& grains, double size) {
  for (const GrainPoint& p : grains.points)
    if (!(p.x.cwiseAbs().maxCoeff() < tolerances::most_cells * size))
      return Error{ErrorCode::numeric,
                   fmt::format("a grain is at ({}, {}, {}) m", p.x[0], p.x[1], p.x[2]), "grains",
                   "no cells of the size of the grains can tell it apart"};
  return {};
}

}  // namespace

Status GrainCells::sort(const GrainField& grains, std::span<const Vec3> ways, double reach,
                        Crew* crew) {
  const double size = tolerances::grain_cell * grains.largest_radius;
  if (Status fine = check_places(grains, size); !fine) return fine;
  const size_t n = grains.size();
  reach_ = reach;
  points_.resize(n);
  for_chunks(crew, n, [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) points_[i] = grains.points[i].x;
  });
  cells_.sort(points_, size, crew);
  for (std::vector<double>* c : {&x_, &y_, &z_}) c->resize(n + grain_batch);
  for (std::vector<float>* c : {&extent_, &radius_, &way_x_, &way_y_, &way_z_})
    c->resize(n + grain_batch);
  place_.resize(n + grain_batch);
  ordinal_.resize(n + grain_batch);
  for_chunks(crew, n, [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = cells_.order()[k];
      const GrainPoint& p = grains.points[i];
      x_[k] = p.x[0], y_[k] = p.x[1], z_[k] = p.x[2];
      extent_[k] = float(p.radius + ways[i].norm());
      radius_[k] = float(p.radius);
      way_x_[k] = float(ways[i][0]), way_y_[k] = float(ways[i][1]), way_z_[k] = float(ways[i][2]);
      place_[k] = i;
      ordinal_[k] = int32_t(grains.ordinal[i]);
    }
  });
  return {};
}

void GrainCells::find_awake(const GrainField& grains, Crew* crew) {
  awake_.resize(cells().size());
  for_chunks(crew, cells().size(), [&](size_t, size_t first, size_t last) {
    for (size_t c = first; c < last; ++c) {
      awake_[c] = 0;
      for (uint32_t k = cells()[c].first; k < cells()[c].end; ++k)
        awake_[c] = awake_[c] || !grains.asleep[place_[k]];
    }
  });
}

template <class F>
void GrainCells::about(const CellOrder::Cell& cell, const F& f) const {
  std::array<const CellOrder::Cell*, 27> near;
  const size_t count = cells_.about(cell, near);
  for (size_t n = 0; n < count; ++n) f(*near[n]);
}

bool GrainCells::stirs(size_t cell) const {
  if (awake_[cell]) return true;
  bool any = false;
  about(cells()[cell],
        [&](const CellOrder::Cell& at) { any = any || awake_[size_t(&at - cells().data())]; });
  return any;
}

void GrainCells::Near::make_room(size_t size) {
  if (size <= x_.size()) return;
  for (std::vector<float>* c : {&x_, &y_, &z_, &extent_, &radius_, &way_x_, &way_y_, &way_z_})
    c->resize(2 * size);
  for (std::vector<uint32_t>* c : {&place_, &found_}) c->resize(2 * size);
  ordinal_.resize(2 * size);
}

void GrainCells::Near::collect(const GrainCells& in, const CellOrder::Cell& cell) {
  const double edge = in.cells_.size();
  centre_ = edge * Vec3(double(cell.i) + 0.5, double(cell.j) + 0.5, double(cell.k) + 0.5);
  const auto half = float((0.5 * edge + in.reach_) * (1 + tolerances::neighbour_rounding));
  size_t size = 0;
  in.about(cell, [&](const CellOrder::Cell& at) {
    make_room(size + (at.end - at.first) + 2 * grain_batch);
    size = add_near_cell(in.columns(), at.first, at.end, centre_.data(), half, view(), size);
  });
  padded_ = (size + grain_batch - 1) / grain_batch * grain_batch;
  for (; size < padded_; ++size) {
    x_[size] = y_[size] = z_[size] = tolerances::far_coordinate;
    extent_[size] = radius_[size] = way_x_[size] = way_y_[size] = way_z_[size] = 0;
    ordinal_[size] = 0;
  }
}

std::span<const uint32_t> GrainCells::Near::of(const GrainCells& in, uint32_t k, double more,
                                               int32_t after) {
  const double margin = tolerances::grain_margin * double(in.radius_[k]);
  const NearGrain grain{
      float(in.x_[k] - centre_[0]),
      float(in.y_[k] - centre_[1]),
      float(in.z_[k] - centre_[2]),
      float((double(in.extent_[k]) + more + margin) * (1 + tolerances::neighbour_rounding)),
      in.radius_[k],
      in.way_x_[k],
      in.way_y_[k],
      in.way_z_[k],
      float(more),
      after};
  return {found_.data(), find_near(view(), padded_, grain, found_.data())};
}

}  // namespace tumble
