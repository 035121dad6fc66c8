#include "engine/geometry/wrap/outside_grid.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int edge = SparseField::edge;
/// Longest edge of a tetrahedron over the spacing: the diagonal of a cube [-].
const double longest_edge = std::sqrt(3.0);
/// Values, flags of what has been reached, and what isosurface() stores per node: six bytes each.
constexpr size_t nodes_of_brick = size_t{edge} * edge * edge;
constexpr size_t bytes_of_brick = sizeof(SparseField::Brick) + 6 * nodes_of_brick;

Error too_many(double bricks, double spacing, size_t max_bricks) {
  return {ErrorCode::invalid_argument,
          fmt::format("a wrap with cells of {:.3g} m needs {:.3g} MB, which is more than {:.3g} MB",
                      spacing, 1e-6 * bricks * bytes_of_brick,
                      1e-6 * double(max_bricks * bytes_of_brick)),
          {},
          fmt::format("cells of {:.2g} m would do",
                      1.1 * spacing * std::cbrt(bricks / double(max_bricks)))};
}

/// The square of a distance that no node has from outside: the least side of the room has at most
/// 512 nodes, as there are at most 2^27. Along rows alone distances may be longer and are cut off.
constexpr int64_t far_square = 1 << 28;

/// f(n) for every row, by any thread, until stopped.
template <class F>
void for_rows(Crew* crew, size_t rows, const F& f) {
  const auto row = [&](size_t n) {
    if (!stop_requested()) f(n);
  };
  if (crew) {
    crew->each(rows, row);
  } else {
    for (size_t n = 0; n < rows; ++n) row(n);
  }
}

/// One row of the distance transform: of parabolas over its nodes, with the values given at their
/// apices, the least at each node.
class LowerEnvelope {
 public:
  void run(int32_t* values, size_t step, int count) {
    parabolas_.clear();
    for (int q = 0; q < count; ++q) {
      const int32_t f = values[size_t(q) * step];
      if (f >= far_square) continue;
      // From where on this one is below the last.
      int from = 0;
      while (!parabolas_.empty()) {
        const Parabola& p = parabolas_.back();
        const int64_t above = int64_t(f) + int64_t(q) * q - p.f - int64_t(p.q) * p.q;
        from = above < 0 ? 0 : int(std::min<int64_t>(above / (2 * (q - p.q)) + 1, count));
        if (from > p.from) break;
        parabolas_.pop_back();
        from = 0;
      }
      if (from < count) parabolas_.push_back({q, f, from});
    }
    for (size_t i = 0; i < parabolas_.size(); ++i) {
      const Parabola& p = parabolas_[i];
      const int end = i + 1 < parabolas_.size() ? parabolas_[i + 1].from : count;
      for (int x = p.from; x < end; ++x)
        values[size_t(x) * step] =
            int32_t(std::min(p.f + int64_t(x - p.q) * (x - p.q), far_square));
    }
  }

 private:
  struct Parabola {
    int q;
    int32_t f;
    int from;
  };
  std::vector<Parabola> parabolas_;
};

}  // namespace

Result<OutsideGrid> OutsideGrid::make(const Aabb& box, double margin, double spacing,
                                      size_t max_bytes) {
  const Aabb room = box.inflated(margin + 2 * longest_edge * spacing);
  if (Status fine = check_spacing(spacing, room); !fine) return fine.error();
  OutsideGrid out;
  out.field_.spacing = spacing;
  const Array3<double> first = (room.min / (spacing * edge)).array().floor(),
                       last = (room.max / (spacing * edge)).array().floor();
  const double count = (last - first + 1).prod();
  const size_t most = std::min(most_bricks, max_bytes / bytes_of_brick);
  if (!(count <= double(most))) return too_many(count, spacing, most);
  const Array3<int> a = first.cast<int>(), b = last.cast<int>();
  for (int k = 0; k < 3; ++k) {
    out.bricks_[size_t(k)] = b[k] - a[k] + 1;
    out.nodes_[size_t(k)] = edge * out.bricks_[size_t(k)];
  }
  out.field_.bricks.resize(size_t(count));
  size_t n = 0;
  for (int i = a[0]; i <= b[0]; ++i)
    for (int j = a[1]; j <= b[1]; ++j)
      for (int k = a[2]; k <= b[2]; ++k) {
        out.field_.bricks[n].at = {i, j, k};
        out.field_.bricks[n++].value.fill(1);
      }
  return out;
}

void OutsideGrid::measure_row(const Hierarchy& surface, double radius, int y, int z) {
  const GridIndex& first = field_.bricks[0].at;
  const double h = field_.spacing;
  // The surface's distance from a node is at most that from the previous node plus the distance
  // between the two.
  double reach = std::numeric_limits<double>::infinity();
  for (int x = 0; x < nodes_[0];) {
    const Vec3 p = field_.position({edge * first[0] + x, edge * first[1] + y, edge * first[2] + z});
    auto near = surface.closest(p, reach);
    if (!near) near = surface.closest(p, std::numeric_limits<double>::infinity());
    const double d = std::sqrt(near->squared_distance);
    double value = d - radius;
    at({x, y, z}) = value;
    // The sign cannot change within the remaining distance, reduced by the length of an edge.
    const double left = std::fabs(value) / h - longest_edge;
    const int sure = std::min(nodes_[0] - x - 1, left > 1 ? int(std::min(left, 1e6)) : 0);
    const double step = value < 0 ? h : -h;
    for (int k = 1; k <= sure; ++k) at({x + k, y, z}) = value += step;
    x += sure + 1;
    reach = (d + (sure + 1) * h) * (1 + 1e-6);
  }
}

void OutsideGrid::measure(const Hierarchy& surface, double radius, Crew* crew) {
  for_rows(crew, size_t(nodes_[1]) * size_t(nodes_[2]), [&](size_t n) {
    measure_row(surface, radius, int(n % size_t(nodes_[1])), int(n / size_t(nodes_[1])));
  });
}

void OutsideGrid::fill_unreached() {
  std::vector<uint8_t> reached(field_.bricks.size() * nodes_of_brick, 0);
  std::vector<std::array<int, 3>> front{{0, 0, 0}}, next;
  reached[0] = 1;
  const auto visit = [&](const std::array<int, 3>& node) {
    for (size_t k = 0; k < 3; ++k)
      if (node[k] < 0 || node[k] >= nodes_[k]) return;
    uint8_t& mark = reached[number(node)];
    if (mark || at(node) < 0) return;
    mark = 1;
    next.push_back(node);
  };
  // Edges of Kuhn's tetrahedra go from a corner of a cube to one with a superset of its bits.
  while (!front.empty() && !stop_requested()) {
    for (const auto& [x, y, z] : front)
      for (int c = 1; c < 8; ++c) {
        const int i = c & 1, j = c >> 1 & 1, k = c >> 2 & 1;
        visit({x + i, y + j, z + k});
        visit({x - i, y - j, z - k});
      }
    front.swap(next);
    next.clear();
  }
  for (int z = 0; z < nodes_[2] && !stop_requested(); ++z)
    for (int y = 0; y < nodes_[1]; ++y)
      for (int x = 0; x < nodes_[0]; ++x)
        if (double& value = at({x, y, z}); !reached[number({x, y, z})] && !(value < 0))
          value = -field_.spacing;
}

void OutsideGrid::grow_outside(double way, Crew* crew) {
  // Squares of distances in steps of the grid, by one axis after the other.
  const std::array<size_t, 3> count{size_t(nodes_[0]), size_t(nodes_[1]), size_t(nodes_[2])};
  const std::array<size_t, 3> step{1, count[0], count[0] * count[1]};
  std::vector<int32_t> square(count[0] * count[1] * count[2]);
  for_rows(crew, count[1] * count[2], [&](size_t n) {
    const int y = int(n % count[1]), z = int(n / count[1]);
    for (int x = 0; x < nodes_[0]; ++x)
      square[number({x, y, z})] = inside({x, y, z}) ? int32_t(far_square) : 0;
  });
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    for_rows(crew, count[i] * count[j], [&](size_t n) {
      thread_local LowerEnvelope envelope;
      envelope.run(&square[n % count[i] * step[i] + n / count[i] * step[j]], step[k], nodes_[k]);
    });
  }
  for_rows(crew, count[1] * count[2], [&](size_t n) {
    const int y = int(n % count[1]), z = int(n / count[1]);
    for (int x = 0; x < nodes_[0]; ++x)
      at({x, y, z}) = way - field_.spacing * std::sqrt(double(square[number({x, y, z})]));
  });
}

void OutsideGrid::keep_off_nodes(double least) {
  for (SparseField::Brick& brick : field_.bricks)
    for (double& value : brick.value)
      if (std::fabs(value) < least) value = value < 0 ? -least : least;
}

size_t OutsideGrid::cut_edges() const {
  size_t out = 0;
  // The last nodes of the grid are outside, and so are all that would follow.
  for (int z = 0; z + 1 < nodes_[2] && !stop_requested(); ++z)
    for (int y = 0; y + 1 < nodes_[1]; ++y)
      for (int x = 0; x + 1 < nodes_[0]; ++x) {
        const bool here = inside({x, y, z});
        for (int c = 1; c < 8; ++c)
          out += inside({x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1)}) != here;
      }
  return out;
}

}  // namespace tumble
