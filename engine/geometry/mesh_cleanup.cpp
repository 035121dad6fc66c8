#include "engine/geometry/mesh_cleanup.hpp"

#include "engine/geometry/mesh_orientation.hpp"
#include "engine/geometry/mesh_sides.hpp"
#include "engine/geometry/mesh_slivers.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Union-find in which the lowest number is the representative.
struct Groups {
  std::vector<uint32_t> leader;
  explicit Groups(size_t n) : leader(n) { std::iota(leader.begin(), leader.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    leader[std::max(a, b)] = std::min(a, b);
  }
};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Vertices of which no other vertex is near enough to be joined.
struct Cluster {
  size_t begin, end;  // range of the order
  int axis;           // the axis to sort along next
  int compact;        // number of consecutive axes along which it has no gap
};

/// Joins the vertices of a cluster without gaps, by a sweep along its longest axis.
void join_cluster(const std::vector<Vec3>& v, double distance, std::span<uint32_t> order,
                  Groups& groups) {
  Aabb box;
  for (const uint32_t i : order) box.include(v[i]);
  int axis = 0;
  box.extent().maxCoeff(&axis);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return v[a][axis] != v[b][axis] ? v[a][axis] < v[b][axis] : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    for (size_t j = i + 1; j < order.size(); ++j) {
      const Vec3 d = v[order[j]] - v[order[i]];
      if (d[axis] > distance) break;
      if (d.squaredNorm() <= distance * distance) groups.join(order[i], order[j]);
    }
  }
}

/// Joins vertices whose distance is at most `distance`: sorted along one axis after the other,
/// clusters are divided at gaps, so that only vertices crowded along all three axes are compared in
/// pairs.
void join_near(const std::vector<Vec3>& v, double distance, Groups& groups) {
  std::vector<uint32_t> order(v.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Cluster> clusters{{0, order.size(), 0, 0}};
  while (!clusters.empty()) {
    const auto [begin, end, next_axis, compact] = clusters.back();
    const int axis = next_axis;
    clusters.pop_back();
    if (end - begin < 2) continue;
    const std::span<uint32_t> part(order.data() + begin, end - begin);
    const bool one_place =
        std::all_of(part.begin(), part.end(), [&](uint32_t i) { return v[i] == v[part[0]]; });
    if (one_place) {
      for (const uint32_t i : part) groups.join(part[0], i);
      continue;
    }
    if (compact == 3) {
      join_cluster(v, distance, part, groups);
      continue;
    }
    std::sort(part.begin(), part.end(), [&](uint32_t a, uint32_t b) {
      return v[a][axis] != v[b][axis] ? v[a][axis] < v[b][axis] : a < b;
    });
    size_t start = begin;
    for (size_t i = begin + 1; i <= end; ++i) {
      if (i < end && v[order[i]][axis] - v[order[i - 1]][axis] <= distance) continue;
      const bool whole = start == begin && i == end;
      clusters.push_back({start, i, (axis + 1) % 3, whole ? compact + 1 : 0});
      start = i;
    }
  }
}

}  // namespace

MeshOrigin::MeshOrigin(const TriangleMesh& mesh)
    : vertex(mesh.vertices.size()), triangle(mesh.triangles.size()) {
  std::iota(vertex.begin(), vertex.end(), 0u);
  std::iota(triangle.begin(), triangle.end(), 0u);
}

size_t weld(TriangleMesh& mesh, double distance, MeshOrigin* origin,
            std::vector<std::array<uint32_t, 2>>* welded) {
  if (distance < 0) return 0;
  Groups groups(mesh.vertices.size());
  join_near(mesh.vertices, distance, groups);
  const auto& v = mesh.vertices;
  size_t joined = 0;
  for (uint32_t i = 0; i < v.size(); ++i) {
    const uint32_t leader = groups.find(i);
    if (leader == i) continue;
    ++joined;
    if (welded && origin) welded->push_back({origin->vertex[i], origin->vertex[leader]});
  }
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& c : t) c = groups.find(c);
  }
  if (joined > 0) drop_unused_vertices(mesh, origin);
  return joined;
}

size_t drop_degenerate_triangles(TriangleMesh& mesh, MeshOrigin* origin,
                                 std::vector<uint32_t>* dropped) {
  size_t kept = 0;
  const size_t before = mesh.triangles.size();
  for (size_t i = 0; i < before; ++i) {
    const Triangle t = mesh.triangles[i];
    if (is_sliver(mesh, t)) {
      if (dropped) dropped->push_back(origin ? origin->triangle[i] : uint32_t(i));
      continue;
    }
    if (origin) origin->triangle[kept] = origin->triangle[i];
    mesh.triangles[kept++] = t;
  }
  mesh.triangles.resize(kept);
  if (origin) origin->triangle.resize(kept);
  return before - kept;
}

size_t drop_duplicate_triangles(TriangleMesh& mesh, MeshOrigin* origin,
                                std::vector<std::array<uint32_t, 2>>* dropped) {
  std::vector<uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Triangle> keys;
  keys.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) keys.push_back(sorted(t));
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  std::vector<uint32_t> first(mesh.triangles.size());  // the first triangle with the same corners
  for (size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && keys[order[i]] == keys[order[i - 1]];
    first[order[i]] = repeated ? first[order[i - 1]] : order[i];
  }
  const std::vector<uint32_t> before = origin ? origin->triangle : std::vector<uint32_t>{};
  const auto name = [&](uint32_t i) { return origin ? before[i] : i; };
  size_t kept = 0, count = mesh.triangles.size();
  for (uint32_t i = 0; i < count; ++i) {
    if (first[i] != i) {
      if (dropped) dropped->push_back({name(i), name(first[i])});
      continue;
    }
    if (origin) origin->triangle[kept] = origin->triangle[i];
    mesh.triangles[kept++] = mesh.triangles[i];
  }
  mesh.triangles.resize(kept);
  if (origin) origin->triangle.resize(kept);
  return count - kept;
}

size_t drop_unused_vertices(TriangleMesh& mesh, MeshOrigin* origin,
                            std::vector<uint32_t>* dropped) {
  std::vector<uint32_t> number(mesh.vertices.size(), no_index);
  for (const Triangle& t : mesh.triangles) {
    for (uint32_t v : t) number[v] = 0;
  }
  uint32_t kept = 0;
  for (uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    if (number[i] == no_index) {
      if (dropped) dropped->push_back(origin ? origin->vertex[i] : i);
      continue;
    }
    if (origin) origin->vertex[kept] = origin->vertex[i];
    mesh.vertices[kept] = mesh.vertices[i];
    number[i] = kept++;
  }
  const size_t count = mesh.vertices.size() - kept;
  mesh.vertices.resize(kept);
  if (origin) origin->vertex.resize(kept);
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) v = number[v];
  }
  return count;
}

std::vector<uint32_t> connected_parts(const TriangleMesh& mesh, size_t* count) {
  const std::vector<MeshSide> sides = sorted_sides(mesh);
  Groups groups(mesh.triangles.size());
  for (size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high) {
      groups.join(sides[i].face, sides[i - 1].face);
    }
  }
  std::vector<uint32_t> part(mesh.triangles.size(), no_index);
  uint32_t next = 0;
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const uint32_t leader = groups.find(f);
    if (leader == f) part[f] = next++;
    part[f] = part[leader];
  }
  if (count) *count = next;
  return part;
}

std::vector<TriangleMesh> split_parts(const TriangleMesh& mesh) {
  size_t count = 0;
  const std::vector<uint32_t> part = connected_parts(mesh, &count);
  std::vector<TriangleMesh> out(count);
  // The part that last used a vertex, and its number there, since parts may share vertices.
  std::vector<std::pair<uint32_t, uint32_t>> number(mesh.vertices.size(), {no_index, 0});
  std::vector<uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return part[a] < part[b]; });
  for (uint32_t f : order) {
    TriangleMesh& m = out[part[f]];
    Triangle t;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[f][k];
      if (number[v].first != part[f]) {
        number[v] = {part[f], uint32_t(m.vertices.size())};
        m.vertices.push_back(mesh.vertices[v]);
      }
      t[k] = number[v].second;
    }
    m.triangles.push_back(t);
  }
  return out;
}

std::vector<std::vector<uint32_t>> find_holes(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  // Open sides with the direction given by their faces, followed from each start until it is
  // reached again. Where the faces disagree, both directions are allowed.
  struct OpenSide {
    uint32_t from, to, edge;
    auto operator<=>(const OpenSide&) const = default;
  };
  const bool both_ways = topology.misoriented_edges > 0;
  std::vector<OpenSide> sides;
  for (uint32_t i = 0; i < topology.edges.size(); ++i) {
    const MeshEdge& e = topology.edges[i];
    if (e.face_count != 1) continue;
    const Triangle& t = mesh.triangles[e.faces[0]];
    bool forward = false;
    for (size_t k = 0; k < 3; ++k) {
      forward = forward || (t[k] == e.vertices[0] && t[(k + 1) % 3] == e.vertices[1]);
    }
    const auto [low, high] = e.vertices;
    if (forward || both_ways) sides.push_back({low, high, i});
    if (!forward || both_ways) sides.push_back({high, low, i});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<uint8_t> used(topology.edges.size(), 0);
  std::vector<uint32_t> place(mesh.vertices.size(), no_index);  // on the current path
  std::vector<std::vector<uint32_t>> holes;
  for (size_t start = 0; start < sides.size(); ++start) {
    std::vector<uint32_t> path;
    for (size_t s = start; s < sides.size() && !used[sides[s].edge];) {
      const auto [from, to, edge] = sides[s];
      used[edge] = 1;
      place[from] = uint32_t(path.size());
      path.push_back(from);
      if (place[to] != no_index) {  // a loop is complete; the path before it continues
        holes.emplace_back(path.begin() + place[to], path.end());
        for (size_t i = place[to]; i < path.size(); ++i) place[path[i]] = no_index;
        path.resize(path.size() - holes.back().size());
      }
      s = size_t(std::lower_bound(sides.begin(), sides.end(), OpenSide{to, 0, 0}) - sides.begin());
      while (s < sides.size() && sides[s].from == to && used[sides[s].edge]) ++s;
      if (s < sides.size() && sides[s].from != to) break;  // a chain that does not close
    }
    for (uint32_t v : path) place[v] = no_index;
  }
  return holes;
}

CleanupReport clean_up(TriangleMesh& mesh, const CleanupOptions& options) {
  CleanupReport report;
  MeshOrigin origin(mesh);
  report.unused_vertices = drop_unused_vertices(mesh, &origin, &report.unused);
  report.welded_vertices = weld(mesh, options.weld_distance, &origin, &report.welded);
  if (options.drop_degenerate) {
    const double on_a_side = std::max(0.0, options.weld_distance);
    for (const uint32_t beside : close_t_junctions(mesh, on_a_side))
      origin.triangle.push_back(origin.triangle[beside]);
    report.split_triangles = split_at_slivers(mesh, on_a_side);
    report.degenerate_triangles = drop_degenerate_triangles(mesh, &origin, &report.degenerate);
  }
  if (options.drop_duplicates) {
    report.duplicate_triangles = drop_duplicate_triangles(mesh, &origin, &report.duplicates);
  }
  drop_unused_vertices(mesh, &origin);
  if (options.orient) {
    OrientationReport turned = orient_consistently(mesh);
    report.flipped_triangles = turned.flipped_triangles;
    report.flipped_parts = turned.flipped_parts;
    report.unorientable_parts = turned.unorientable_parts;
    for (auto* list : {&turned.flipped, &turned.turned_parts, &turned.unorientable}) {
      for (uint32_t& t : *list) t = origin.triangle[t];
    }
    report.flipped = std::move(turned.flipped);
    report.turned_parts = std::move(turned.turned_parts);
    report.unorientable = std::move(turned.unorientable);
  }
  const MeshTopology topology = build_topology(mesh);
  report.open_edges = topology.open_edges;
  report.non_manifold_edges = topology.non_manifold_edges;
  if (report.open_edges > 0) report.hole_loops = find_holes(mesh);
  report.holes = report.hole_loops.size();
  connected_parts(mesh, &report.parts);
  report.triangle_origin = std::move(origin.triangle);
  return report;
}

std::string CleanupReport::text() const {
  std::string done, left;
  const auto add = [](std::string& to, size_t n, const char* before, const char* what,
                      const char* plural = nullptr) {
    if (n == 0) return;
    const std::string many = plural ? std::string(plural) : fmt::format("{}s", what);
    to += fmt::format("{}{}{} {}", to.empty() ? "" : ", ", before, n, n == 1 ? what : many);
  };
  add(done, welded_vertices, "welded ", "vertex position");
  add(done, unused_vertices, "dropped ", "unused point");
  add(done, split_triangles, "split ", "triangle at a point in its side",
      "triangles at points in their sides");
  add(done, degenerate_triangles, "dropped ", "degenerate triangle");
  add(done, duplicate_triangles, "dropped ", "duplicate triangle");
  add(done, flipped_triangles, "turned ", "triangle");
  add(done, flipped_parts, "turned ", "inside-out part");
  add(left, open_edges, "", "open edge");
  add(left, holes, "", "hole");
  add(left, non_manifold_edges, "", "non-manifold edge");
  add(left, unorientable_parts, "", "unorientable part");
  return done + (done.empty() || left.empty() ? "" : "; ") + left;
}

}  // namespace tumble
