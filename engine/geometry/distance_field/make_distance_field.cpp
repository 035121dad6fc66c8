#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/distance_field/narrow_band.hpp"
#include "engine/geometry/distance_field/scan_lines.hpp"
#include "engine/geometry/distance_field/tolerances.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Approximate share of the build time spent when the signs, and when the fine nodes, are done.
constexpr double signs_done = 0.1, blocks_done = 0.8;
constexpr int cells = FieldLayout::cells_along, nodes = FieldLayout::nodes_along;
const double sqrt3 = std::sqrt(3.0);
/// Bound of the error of trilinear interpolation in a cube, over its side: the weighted mean
/// distance from the corners is largest at the centre [-].
const double interpolation_bound = sqrt3 / 2;

Error bad_option(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

Status check_options(const DistanceFieldOptions& o) {
  for (const auto& [name, value] : {std::pair{"cell", o.cell}, {"error", o.error}})
    if (!(value >= 0) || !std::isfinite(value))
      return bad_option(fmt::format("{} of a distance field must be >= 0 m, got {}", name, value));
  if (!(o.band >= 1) || !(o.band <= 64))
    return bad_option(
        fmt::format("band of a distance field must be 1 to 64 cells, got {}", o.band));
  if (o.cell > 0 && o.error > 0 && field_error(o.cell) > o.error)
    return bad_option(
        fmt::format("cells of {} m may err by {:.3g} m, which is more than the {} m asked for",
                    o.cell, field_error(o.cell), o.error),
        fmt::format("cells of {:.3g} m would do", o.error / interpolation_bound));
  return {};
}

Status check_surface(const TriangleMesh& mesh) {
  if (Status s = validate(mesh); !s) return s.error();
  const MeshTopology topology = build_topology(mesh);
  if (topology.closed_and_oriented()) return {};
  std::string why;
  const auto add = [&](size_t n, const char* what) {
    if (n > 0) why += fmt::format("{}{} {}", why.empty() ? "" : ", ", n, what);
  };
  add(topology.open_edges, "open edges");
  add(topology.non_manifold_edges, "edges with more than two triangles");
  add(topology.misoriented_edges, "edges whose triangles disagree");
  return Error{
      ErrorCode::invalid_argument,
      "only a closed mesh has an inside; this one has " + why,
      {},
      "close it, or wrap it (\"wrap\": {} of a mesh, `tumble mesh FILE --wrap`); `tumble mesh "
      "FILE` lists the holes"};
}

}  // namespace

/// Makes one field, step by step.
class DistanceFieldBuilder {
 public:
  DistanceFieldBuilder(const Hierarchy& surface, const DistanceFieldOptions& options)
      : surface_(surface), mesh_(surface.mesh()), options_(options) {}

  Result<DistanceField> build() {
    if (Status s = check_options(options_); !s) return s.error();
    if (Status s = check_surface(mesh_); !s) return s.error();
    if (Status s = lay_out(); !s) return s.error();
    tell_progress(0);
    const ScanLines lines(mesh_, field_.layout_, options_.crew);
    if (stop_requested()) return stopped_error();
    const BlockTriangles near =
        triangles_near_blocks(mesh_, field_.layout_, field_.node_range_, options_.crew);
    if (stop_requested()) return stopped_error();
    if (Status s = fill_blocks(lines, near); !s) return s.error();
    fill_corners(lines);
    if (stop_requested()) return stopped_error();
    report();
    return std::move(field_);
  }

 private:
  Status lay_out() {
    const Aabb box = surface_.bounds();
    const double diagonal = box.extent().norm();
    const double cell = field_cell(options_, box);
    if (!(cell > 0)) return bad_option("a mesh without extent has no distance field");
    field_.mesh_box_ = box;
    field_.band_ = options_.band * cell;
    // The range includes all corners of every cell that contains a point of the band.
    field_.node_range_ = field_.band_ + sqrt3 * cell;
    FieldLayout& layout = field_.layout_;
    layout.cell = cell;
    const double margin = field_.node_range_ + cell;
    std::array<double, 3> counts;
    for (int k = 0; k < 3; ++k)
      counts[size_t(k)] = std::ceil((box.extent()[k] + 2 * margin) / layout.block_size());
    const double dense = counts[0] * counts[1] * counts[2] * (sizeof(uint32_t) + sizeof(float));
    if (!(dense <= double(options_.max_bytes)) || !(dense < double(size_t{1} << 33)))
      return too_large(dense);
    for (int k = 0; k < 3; ++k) {
      layout.blocks[size_t(k)] = int(counts[size_t(k)]);
      layout.origin[k] = box.centre()[k] - counts[size_t(k)] * layout.block_size() / 2;
    }
    field_.inverse_cell_ = 1 / cell;
    const double short_step = field_.node_range_ / (INT16_MAX - 1);
    is_short_ = short_step / 2 <= tolerances::node_error * diagonal;
    field_.step_ = is_short_ ? short_step : field_.node_range_ / (INT32_MAX - 1);
    return {};
  }

  Error too_large(double bytes) const {
    // The memory of the band grows with the square of the cells along an axis, that of the table of
    // blocks with the cube.
    const double factor = std::sqrt(bytes / double(options_.max_bytes));
    return bad_option(
        fmt::format(
            "a distance field of cells of {:.3g} m needs {:.3g} MB, which is more than {:.3g} MB",
            field_.layout_.cell, bytes / 1e6, double(options_.max_bytes) / 1e6),
        fmt::format("cells of {:.2g} m would do", 1.1 * factor * field_.layout_.cell));
  }

  Status fill_blocks(const ScanLines& lines, const BlockTriangles& near) {
    const FieldLayout& layout = field_.layout_;
    const size_t value_bytes = is_short_ ? sizeof(int16_t) : sizeof(int32_t);
    const double most =
        double(near.blocks.size()) * double(FieldLayout::nodes_of_block * value_bytes);
    if (most > double(options_.max_bytes)) return too_large(most);
    // All nodes are measured first; blocks to which no triangle is near are then left out.
    std::vector<int32_t> all(is_short_ ? 0 : near.blocks.size() * FieldLayout::nodes_of_block);
    std::vector<int16_t> all_short(is_short_ ? near.blocks.size() * FieldLayout::nodes_of_block
                                             : 0);
    std::vector<char> kept(near.blocks.size(), 0);
    each(near.blocks.size(), {signs_done, blocks_done}, [&](size_t n) {
      BlockDistances distances;
      measure_block(mesh_, layout, near.blocks[n], near.of(n), field_.node_range_, distances);
      const double least = *std::min_element(distances.begin(), distances.end());
      if (least > field_.band_ + interpolation_bound * layout.cell) return;
      kept[n] = 1;
      const size_t at = n * FieldLayout::nodes_of_block;
      if (is_short_) {
        store(lines, near.blocks[n], distances, all_short.data() + at);
      } else {
        store(lines, near.blocks[n], distances, all.data() + at);
      }
    });
    if (stop_requested()) return stopped_error();
    field_.block_of_.assign(layout.block_count(), no_index);
    uint32_t count = 0;
    for (size_t n = 0; n < near.blocks.size(); ++n)
      if (kept[n]) field_.block_of_[near.blocks[n]] = count++;
    if (is_short_) {
      keep(all_short, kept, count, field_.short_values_);
    } else {
      keep(all, kept, count, field_.long_values_);
    }
    field_.report_.blocks = count;
    return {};
  }

  template <class Stored>
  static void keep(const std::vector<Stored>& all, const std::vector<char>& kept, size_t count,
                   std::vector<Stored>& out) {
    constexpr size_t size = FieldLayout::nodes_of_block;
    out.reserve(count * size);
    for (size_t n = 0; n < kept.size(); ++n)
      if (kept[n])
        out.insert(out.end(), all.begin() + std::ptrdiff_t(n * size),
                   all.begin() + std::ptrdiff_t((n + 1) * size));
  }

  /// Stores magnitudes with their signs, in steps; values out of range become the largest number.
  template <class Stored>
  void store(const ScanLines& lines, size_t block, const BlockDistances& distances, Stored* out) {
    const auto place = field_.layout_.block_place(block);
    size_t overlapped = 0;
    std::array<int, nodes> turns;
    std::array<bool, nodes> odd;
    for (int z = 0; z < nodes; ++z)
      for (int y = 0; y < nodes; ++y) {
        const int row = cells * place[1] + y, layer = cells * place[2] + z;
        lines.winding(row, layer, cells * place[0], nodes, 1, turns.data());
        lines.parity(row, layer, cells * place[0], nodes, 1, odd.data());
        for (size_t x = 0; x < size_t(nodes); ++x) {
          const size_t n = FieldLayout::node_in_block(int(x), y, z);
          const double steps = std::isfinite(distances[n])
                                   ? std::round(distances[n] / field_.step_)
                                   : double(std::numeric_limits<Stored>::max());
          out[n] = Stored(turns[x] != 0 ? -steps : steps);
          overlapped += odd[x] != (turns[x] != 0) || turns[x] > 1 || turns[x] < -1;
        }
      }
    overlapped_ += overlapped;
  }

  /// The coarse level: exact distances at the corners of all blocks. The distance at a corner
  /// bounds that at the next in its row, which saves most of the search.
  void fill_corners(const ScanLines& lines) {
    const FieldLayout& layout = field_.layout_;
    field_.corners_.resize(layout.corner_count());
    const size_t rows = size_t(layout.blocks[1] + 1) * size_t(layout.blocks[2] + 1);
    each(rows, {blocks_done, 1}, [&](size_t row) {
      const int y = int(row % size_t(layout.blocks[1] + 1)),
                z = int(row / size_t(layout.blocks[1] + 1));
      std::vector<int> turns(size_t(layout.blocks[0]) + 1);
      lines.winding(cells * y, cells * z, 0, layout.blocks[0] + 1, cells, turns.data());
      double reach = std::numeric_limits<double>::infinity();
      for (int x = 0; x <= layout.blocks[0]; ++x) {
        const Vec3 p = layout.node(cells * x, cells * y, cells * z);
        auto near = surface_.closest(p, reach);
        if (!near) near = surface_.closest(p, std::numeric_limits<double>::infinity());
        const double d = std::sqrt(near->squared_distance);
        reach = (d + layout.block_size()) * (1 + tolerances::node_error);
        const bool inside = turns[size_t(x)] != 0;
        field_.corners_[layout.corner_index(x, y, z)] = float(inside ? -d : d);
      }
    });
  }

  void report() {
    FieldReport& r = field_.report_;
    r.bytes = field_.block_of_.size() * sizeof(uint32_t) +
              field_.short_values_.size() * sizeof(int16_t) +
              field_.long_values_.size() * sizeof(int32_t) + field_.corners_.size() * sizeof(float);
    const double area = surface_area(mesh_);
    r.bytes_per_area = area > 0 ? double(r.bytes) / area : 0;
    r.bits = is_short_ ? 16 : 32;
    const double rounding =
        tolerances::distance_rounding *
        (field_.mesh_box_.min.cwiseAbs().cwiseMax(field_.mesh_box_.max.cwiseAbs()).maxCoeff() +
         field_.mesh_box_.extent().norm());
    r.node_error = field_.step_ / 2 + rounding;
    r.band_error = field_error(field_.layout_.cell) + r.node_error;
    r.nodes = r.blocks * FieldLayout::nodes_of_block;
    r.overlapped_nodes = overlapped_;
  }

  /// The range of a loop's progress within that of the whole work.
  struct Part {
    double from, to;
  };

  template <class F>
  void each(size_t n, Part part, const F& f) const {
    std::atomic<size_t> done{0};
    const auto unless_stopped = [&](size_t i) {
      if (stop_requested()) return;
      f(i);
      tell_progress(part.from + (part.to - part.from) * double(++done) / double(n));
    };
    if (options_.crew) {
      options_.crew->each(n, unless_stopped);
    } else {
      for (size_t i = 0; i < n; ++i) unless_stopped(i);
    }
  }

  const Hierarchy& surface_;
  const TriangleMesh& mesh_;
  const DistanceFieldOptions& options_;
  DistanceField field_;
  bool is_short_ = true;
  std::atomic<size_t> overlapped_{0};
};

double field_cell(const DistanceFieldOptions& options, const Aabb& bounds) {
  if (options.cell > 0) return options.cell;
  if (!(options.error > 0)) return bounds.extent().maxCoeff() / 64;
  // Inverts the bound of the error in the band, from interpolation and from storage in 16 bits.
  return options.error / (interpolation_bound + (options.band + sqrt3) / INT16_MAX);
}

double field_error(double cell) {
  return interpolation_bound * cell;
}

Result<DistanceField> make_distance_field(const Hierarchy& surface,
                                          const DistanceFieldOptions& options) {
  return DistanceFieldBuilder(surface, options).build();
}

}  // namespace tumble
