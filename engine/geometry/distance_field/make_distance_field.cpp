#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/distance_field/narrow_band.hpp"
#include "engine/geometry/distance_field/scan_lines.hpp"
#include "engine/geometry/distance_field/tolerances.hpp"
#include "engine/geometry/mesh_sides.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Approximate share of the build time spent when the signs, the tiles and the blocks are done.
constexpr double signs_done = 0.2, tiles_done = 0.7, blocks_done = 0.8;
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
  const EdgeFaults faults = edge_faults(mesh);
  if (!faults.any()) return {};
  std::string why;
  const auto add = [&](size_t n, const char* what) {
    if (n > 0) why += fmt::format("{}{} {}", why.empty() ? "" : ", ", n, what);
  };
  add(faults.open, "open edges");
  add(faults.non_manifold, "edges with more than two triangles");
  add(faults.misoriented, "edges whose triangles disagree");
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
    const NearTriangles near =
        triangles_near_tiles(mesh_, field_.layout_, field_.node_range_, options_.crew);
    if (stop_requested()) return stopped_error();
    if (Status s = is_short_ ? fill<int16_t>(lines, near) : fill<int32_t>(lines, near); !s)
      return s.error();
    fill_corners(lines, near);
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

  /// Measures the tiles and makes the blocks of them.
  template <class Stored>
  Status fill(const ScanLines& lines, const NearTriangles& near) {
    if (Status s = check_size(near.tiles.size(), sizeof(Stored)); !s) return s;
    Tiles<Stored> tiles;
    measure_tiles(near, tiles);
    if (stop_requested()) return stopped_error();
    const std::vector<size_t> kept = blocks_in_band(tiles);
    if (Status s = check_size(kept.size(), sizeof(Stored)); !s) return s;
    field_.block_of_.assign(field_.layout_.block_count(), no_index);
    for (size_t n = 0; n < kept.size(); ++n) field_.block_of_[kept[n]] = uint32_t(n);
    field_.report_.blocks = kept.size();
    auto& values = stored(Stored{});
    values.resize(kept.size() * FieldLayout::nodes_of_block);
    each(kept.size(), {tiles_done, blocks_done}, [&](size_t n) {
      store(lines, tiles, kept[n], values.data() + n * FieldLayout::nodes_of_block);
    });
    if (stop_requested()) return stopped_error();
    return {};
  }

  Status check_size(size_t blocks, size_t value_bytes) const {
    const double bytes = double(blocks) * double(FieldLayout::nodes_of_block * value_bytes);
    if (bytes > double(options_.max_bytes)) return too_large(bytes);
    return {};
  }

  std::vector<int16_t>& stored(int16_t) { return field_.short_values_; }
  std::vector<int32_t>& stored(int32_t) { return field_.long_values_; }

  /// Magnitudes at the nodes of tiles in steps of storage; out of range they are the largest
  /// number, which is also what a tile without triangles has.
  template <class Stored>
  struct Tiles {
    using Values = std::array<Stored, nodes_of_tile>;
    static constexpr Stored beyond = std::numeric_limits<Stored>::max();

    std::vector<Values> values;
    std::vector<Stored> least;  ///< of each tile
    std::vector<uint32_t> at;   ///< index of the tile by place, or no_index

    Stored of(const FieldLayout& layout, std::array<int, 3> place, int x, int y, int z) const {
      const uint32_t n = index(layout, place);
      return n == no_index ? beyond : values[n][node_in_tile(x, y, z)];
    }
    /// Index of a tile that may be past the last along an axis.
    uint32_t index(const FieldLayout& layout, std::array<int, 3> place) const {
      for (size_t k = 0; k < 3; ++k)
        if (place[k] >= layout.blocks[k]) return no_index;
      return at[layout.block_index(place[0], place[1], place[2])];
    }
  };

  template <class Stored>
  void measure_tiles(const NearTriangles& near, Tiles<Stored>& tiles) {
    const size_t count = near.tiles.size();
    tiles.values.resize(count);
    tiles.least.resize(count);
    tiles.at.assign(field_.layout_.block_count(), no_index);
    for (size_t n = 0; n < count; ++n) tiles.at[near.tiles[n]] = uint32_t(n);
    first_squares_.resize(count);
    const double square = field_.node_range_ * field_.node_range_;
    each(count, {signs_done, tiles_done}, [&](size_t n) {
      static thread_local TileMeasure measure;
      const TileDistances& squares =
          measure.squares(mesh_, field_.layout_, field_.node_range_, near, n);
      auto& out = tiles.values[n];
      for (size_t i = 0; i < nodes_of_tile; ++i)
        out[i] = squares[i] < square ? Stored(std::sqrt(squares[i]) / field_.step_ + 0.5)
                                     : Tiles<Stored>::beyond;
      tiles.least[n] = *std::min_element(out.begin(), out.end());
      first_squares_[n] = squares[0];
    });
  }

  /// The blocks with a cell that a point of the band may be in, ascending.
  template <class Stored>
  std::vector<size_t> blocks_in_band(const Tiles<Stored>& tiles) const {
    const FieldLayout& layout = field_.layout_;
    const double limit = (field_.band_ + interpolation_bound * layout.cell) / field_.step_ + 1;
    std::vector<size_t> out;
    for (size_t b = 0; b < layout.block_count(); ++b)
      if (double(least_of_block(tiles, layout.block_place(b))) <= limit) out.push_back(b);
    return out;
  }

  /// Least magnitude of a block's nodes: of its own tile and of the faces of those after it.
  template <class Stored>
  Stored least_of_block(const Tiles<Stored>& tiles, std::array<int, 3> place) const {
    Stored least = Tiles<Stored>::beyond;
    for (int part = 0; part < 8; ++part) {
      const std::array<int, 3> after{part & 1, part >> 1 & 1, part >> 2};
      const uint32_t n = tiles.index(
          field_.layout_, {place[0] + after[0], place[1] + after[1], place[2] + after[2]});
      if (n == no_index || tiles.least[n] >= least) continue;
      const auto last = [&](size_t k) { return after[k] ? 1 : tile_nodes; };
      for (int z = 0; z < last(2); ++z)
        for (int y = 0; y < last(1); ++y)
          for (int x = 0; x < last(0); ++x)
            least = std::min(least, tiles.values[n][node_in_tile(x, y, z)]);
    }
    return least;
  }

  /// A block's magnitudes with their signs.
  template <class Stored>
  void store(const ScanLines& lines, const Tiles<Stored>& tiles, size_t block, Stored* out) {
    const auto place = field_.layout_.block_place(block);
    size_t overlapped = 0;
    std::array<int, nodes> turns;
    std::array<bool, nodes> odd;
    for (int z = 0; z < nodes; ++z)
      for (int y = 0; y < nodes; ++y) {
        Stored* const row = out + FieldLayout::node_in_block(0, y, z);
        copy_row(tiles, place, y, z, row);
        const int along_y = cells * place[1] + y, along_z = cells * place[2] + z;
        if (lines.row(along_y, along_z).empty()) continue;
        lines.winding(along_y, along_z, cells * place[0], nodes, 1, turns.data());
        lines.parity(along_y, along_z, cells * place[0], nodes, 1, odd.data());
        for (size_t x = 0; x < size_t(nodes); ++x) {
          if (turns[x] != 0) row[x] = Stored(-row[x]);
          overlapped += odd[x] != (turns[x] != 0) || turns[x] > 1 || turns[x] < -1;
        }
      }
    overlapped_ += overlapped;
  }

  /// Copies the magnitudes of a row of a block from its tile and the next one.
  template <class Stored>
  void copy_row(const Tiles<Stored>& tiles, std::array<int, 3> place, int y, int z,
                Stored* row) const {
    place[1] += y / tile_nodes;
    place[2] += z / tile_nodes;
    const size_t first = node_in_tile(0, y % tile_nodes, z % tile_nodes);
    const uint32_t own = tiles.index(field_.layout_, place);
    if (own == no_index) {
      std::fill_n(row, tile_nodes, Tiles<Stored>::beyond);
    } else {
      std::copy_n(tiles.values[own].data() + first, tile_nodes, row);
    }
    ++place[0];
    const uint32_t next = tiles.index(field_.layout_, place);
    row[tile_nodes] = next == no_index ? Tiles<Stored>::beyond : tiles.values[next][first];
  }

  /// The coarse level: exact distances at the corners of all blocks, which are the first nodes of
  /// tiles. Where none is measured there, the triangle nearest to the corner before bounds the
  /// distance, which saves most of the search.
  void fill_corners(const ScanLines& lines, const NearTriangles& near) {
    const FieldLayout& layout = field_.layout_;
    field_.corners_.assign(layout.corner_count(), 0);
    const double range_square = field_.node_range_ * field_.node_range_;
    for (size_t n = 0; n < near.tiles.size(); ++n) {
      const auto [x, y, z] = layout.block_place(near.tiles[n]);
      if (first_squares_[n] < range_square)
        field_.corners_[layout.corner_index(x, y, z)] = float(std::sqrt(first_squares_[n]));
    }
    const size_t rows = size_t(layout.blocks[1] + 1) * size_t(layout.blocks[2] + 1);
    each(rows, {blocks_done, 1}, [&](size_t row) {
      const int y = int(row % size_t(layout.blocks[1] + 1)),
                z = int(row / size_t(layout.blocks[1] + 1));
      std::vector<int> turns(size_t(layout.blocks[0]) + 1);
      lines.winding(cells * y, cells * z, 0, layout.blocks[0] + 1, cells, turns.data());
      uint32_t triangle = 0;
      for (int x = 0; x <= layout.blocks[0]; ++x) {
        float& corner = field_.corners_[layout.corner_index(x, y, z)];
        if (corner == 0) {
          const Vec3 p = layout.node(cells * x, cells * y, cells * z);
          const MeshPoint found = nearest(p, triangle);
          triangle = found.triangle;
          corner = float(std::sqrt(found.squared_distance));
        }
        if (turns[size_t(x)] != 0) corner = -corner;
      }
    });
  }

  /// The nearest point of the surface, which is sought no farther away than a triangle is.
  MeshPoint nearest(const Vec3& p, uint32_t triangle) const {
    const double square = closest_on_triangle(p, mesh_.corner(triangle, 0),
                                              mesh_.corner(triangle, 1), mesh_.corner(triangle, 2))
                              .squared_distance;
    const auto near = surface_.closest(p, std::sqrt(square) * (1 + tolerances::prune_slack));
    return near ? *near : *surface_.closest(p, std::numeric_limits<double>::infinity());
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
  std::vector<double> first_squares_;  ///< squared distance at the first node of each near tile
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
