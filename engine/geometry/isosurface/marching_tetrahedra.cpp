#include "engine/geometry/isosurface/marching_tetrahedra.hpp"

#include "engine/core/stop.hpp"

#include <algorithm>
#include <bit>

namespace tumble {
namespace {

constexpr int brick_edge = SparseField::edge;
constexpr int window_edge = brick_edge + 1;  ///< nodes of a brick and those that follow it

/// Corners of a cube are numbered by bits: 1 for x, 2 for y, 4 for z. An edge of a tetrahedron goes
/// from a corner to one with a superset of its bits; it belongs to the node where it starts, as
/// number (end without start) - 1 of seven.
using Tetrahedron = std::array<uint8_t, 4>;

/// Kuhn's triangulation: paths from corner 0 to corner 7 along the axes in each order. Second and
/// third corners are swapped for odd permutations, so that all have positive volume.
constexpr std::array<Tetrahedron, 6> tetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};

/// Even permutations that bring one corner, or two, to the front.
constexpr std::array<Tetrahedron, 4> lone_first = {
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
constexpr std::array<Tetrahedron, 6> pair_first = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// The vertices on a brick's edges: those of node n start at first[n], one for each bit set in
/// cut[n], in the order of the bits.
struct BrickVertices {
  GridIndex at{};
  std::array<uint32_t, brick_edge * brick_edge * brick_edge> first;
  std::array<uint8_t, brick_edge * brick_edge * brick_edge> cut;
};

constexpr size_t node_number(int x, int y, int z, int along) {
  return size_t((z * along + y) * along + x);
}

/// Values of a brick's nodes and of the nodes that follow it.
class Window {
 public:
  Window(const SparseField& field, const GridIndex& at) {
    for (int c = 0; c < 8; ++c) {
      const auto* brick = field.find({at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2 & 1)});
      const int ex = c & 1 ? 1 : brick_edge, ey = c & 2 ? 1 : brick_edge,
                ez = c & 4 ? 1 : brick_edge;
      for (int z = 0; z < ez; ++z)
        for (int y = 0; y < ey; ++y)
          for (int x = 0; x < ex; ++x)
            value_[node_number(x + brick_edge * (c & 1), y + brick_edge * (c >> 1 & 1),
                               z + brick_edge * (c >> 2 & 1), window_edge)] =
                brick ? brick->value[node_number(x, y, z, brick_edge)] : field.outside;
    }
  }
  /// The value at a corner of the cube at a node.
  double at(int x, int y, int z, int corner) const {
    return value_[node_number(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1),
                              window_edge)];
  }
  /// A bit for each corner of a cube that is inside.
  int inside(int x, int y, int z) const {
    int bits = 0;
    for (int c = 0; c < 8; ++c) bits |= int(at(x, y, z, c) < 0) << c;
    return bits;
  }

 private:
  std::array<double, window_edge * window_edge * window_edge> value_;
};

class Marching {
 public:
  explicit Marching(const SparseField& field) : field_(field) {}
  TriangleMesh run();

 private:
  void place_bricks();
  void make_vertices(const Window& window, BrickVertices& brick);
  void make_triangles(const Window& window, const BrickVertices& brick);
  void cut_tetrahedron(const Tetrahedron& corners, int inside);
  void add_triangle(int from0, int to0, int from1, int to1, int from2, int to2, bool turned);
  uint32_t vertex(int from, int to) const;

  const SparseField& field_;
  std::vector<BrickVertices> bricks_;
  /// The neighbouring bricks, numbered by bits like corners; null: none.
  std::array<const BrickVertices*, 8> near_{};
  std::array<int, 3> cube_{};
  TriangleMesh mesh_;
};

/// Cubes that touch a known node start in its brick or the one before.
void Marching::place_bricks() {
  std::vector<GridIndex> places;
  for (const auto& brick : field_.bricks)
    for (int c = 0; c < 8; ++c)
      places.push_back(
          {brick.at[0] - (c & 1), brick.at[1] - (c >> 1 & 1), brick.at[2] - (c >> 2 & 1)});
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const GridIndex& place : places) bricks_.emplace_back().at = place;
}

void Marching::make_vertices(const Window& window, BrickVertices& brick) {
  // Least distance of a vertex from a node, in lengths of the edge.
  constexpr double nearest = 1e-6;
  size_t n = 0;
  for (int z = 0; z < brick_edge; ++z)
    for (int y = 0; y < brick_edge; ++y)
      for (int x = 0; x < brick_edge; ++x, ++n) {
        brick.first[n] = uint32_t(mesh_.vertices.size());
        brick.cut[n] = 0;
        const double a = window.at(x, y, z, 0);
        for (int c = 1; c < 8; ++c) {
          const double b = window.at(x, y, z, c);
          if ((a < 0) == (b < 0)) continue;
          brick.cut[n] = uint8_t(brick.cut[n] | 1 << (c - 1));
          const double t = std::clamp(a / (a - b), nearest, 1 - nearest);
          const Vec3 node(double(brick_edge * brick.at[0] + x),
                          double(brick_edge * brick.at[1] + y),
                          double(brick_edge * brick.at[2] + z));
          mesh_.vertices.push_back(field_.spacing *
                                   (node + t * Vec3(c & 1, c >> 1 & 1, c >> 2 & 1)));
        }
      }
}

uint32_t Marching::vertex(int from, int to) const {
  if (from > to) std::swap(from, to);
  std::array<int, 3> node = cube_;
  int brick = 0;
  for (int k = 0; k < 3; ++k) {
    node[size_t(k)] += from >> k & 1;
    if (node[size_t(k)] < brick_edge) continue;
    node[size_t(k)] = 0;
    brick |= 1 << k;
  }
  const BrickVertices& owner = *near_[size_t(brick)];
  const size_t n = node_number(node[0], node[1], node[2], brick_edge);
  const unsigned before = owner.cut[n] & ((1u << ((to ^ from) - 1)) - 1);
  return owner.first[n] + uint32_t(std::popcount(before));
}

void Marching::add_triangle(int from0, int to0, int from1, int to1, int from2, int to2,
                            bool turned) {
  const uint32_t a = vertex(from0, to0), b = vertex(from1, to1), c = vertex(from2, to2);
  if (turned) {
    mesh_.triangles.push_back({a, c, b});
  } else {
    mesh_.triangles.push_back({a, b, c});
  }
}

void Marching::cut_tetrahedron(const Tetrahedron& corners, int inside) {
  int bits = 0;
  for (size_t k = 0; k < 4; ++k) bits |= (inside >> corners[k] & 1) << k;
  const int count = std::popcount(unsigned(bits));
  if (count == 0 || count == 4) return;
  if (count == 2) {
    for (const Tetrahedron& p : pair_first) {
      if (bits != (1 << p[0] | 1 << p[1])) continue;
      const int a = corners[p[0]], b = corners[p[1]], c = corners[p[2]], d = corners[p[3]];
      add_triangle(a, c, a, d, b, d, false);
      add_triangle(a, c, b, d, b, c, false);
    }
    return;
  }
  const bool turned = count == 3;  // the lone corner is outside
  const int lone = std::countr_zero(unsigned(turned ? ~bits & 15 : bits));
  const Tetrahedron& p = lone_first[size_t(lone)];
  const int a = corners[p[0]];
  add_triangle(a, corners[p[1]], a, corners[p[2]], a, corners[p[3]], turned);
}

void Marching::make_triangles(const Window& window, const BrickVertices& brick) {
  for (int c = 0; c < 8; ++c) {
    const GridIndex place = {brick.at[0] + (c & 1), brick.at[1] + (c >> 1 & 1),
                             brick.at[2] + (c >> 2 & 1)};
    const auto found =
        std::lower_bound(bricks_.begin(), bricks_.end(), place,
                         [](const BrickVertices& b, const GridIndex& to) { return b.at < to; });
    near_[size_t(c)] = found != bricks_.end() && found->at == place ? &*found : nullptr;
  }
  for (int z = 0; z < brick_edge; ++z)
    for (int y = 0; y < brick_edge; ++y)
      for (int x = 0; x < brick_edge; ++x) {
        const int inside = window.inside(x, y, z);
        if (inside == 0 || inside == 255) continue;
        cube_ = {x, y, z};
        for (const Tetrahedron& corners : tetrahedra) cut_tetrahedron(corners, inside);
      }
}

TriangleMesh Marching::run() {
  place_bricks();
  for (BrickVertices& brick : bricks_) {
    if (stop_requested()) return {};
    make_vertices(Window(field_, brick.at), brick);
  }
  for (const BrickVertices& brick : bricks_) {
    if (stop_requested()) return {};
    make_triangles(Window(field_, brick.at), brick);
  }
  return std::move(mesh_);
}

}  // namespace

TriangleMesh isosurface(const SparseField& field) {
  return Marching(field).run();
}

}  // namespace tumble
