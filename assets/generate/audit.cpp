#include "assets/generate/audit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace tumble::assets {
namespace {

constexpr double least_allowed_altitude = 50e-6;  // [m]

double signed_volume(const Mesh& mesh, const std::array<int, 3>& t) {
  return mesh.vertices[size_t(t[0])].dot(
             mesh.vertices[size_t(t[1])].cross(mesh.vertices[size_t(t[2])])) /
         6;
}

double altitude(const Mesh& mesh, const std::array<int, 3>& t) {
  const Vec3 &a = mesh.vertices[size_t(t[0])], &b = mesh.vertices[size_t(t[1])],
             &c = mesh.vertices[size_t(t[2])];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() / longest;
}

/// Union-find over small integers.
class Sets {
 public:
  explicit Sets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), size_t(0)); }
  size_t find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t a, size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<size_t> parent_;
};

using EdgeMap = std::map<std::pair<int, int>, size_t>;  // directed edge -> its triangle

EdgeMap check_edges(const Mesh& mesh, std::vector<std::string>& faults) {
  EdgeMap edges;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const std::pair edge{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]};
      if (!edges.emplace(edge, i).second) {
        faults.push_back(fmt::format("edge {}-{} is used twice", edge.first, edge.second));
      }
    }
  }
  for (const auto& [edge, triangle] : edges) {
    if (edges.count({edge.second, edge.first}) == 0) {
      const Vec3& p = mesh.vertices[size_t(edge.first)];
      faults.push_back(fmt::format("edge {}-{} of triangle {} is open, near ({}, {}, {})",
                                   edge.first, edge.second, triangle, p.x(), p.y(), p.z()));
    }
  }
  return edges;
}

/// Around a vertex of a 2-manifold, walking from triangle to triangle over the shared edges visits
/// all of its triangles: one fan.
void check_fans(const Mesh& mesh, const EdgeMap& edges, std::vector<std::string>& faults) {
  std::vector<int> degree(mesh.vertices.size(), 0), walked(mesh.vertices.size(), 0);
  std::vector<std::pair<int, int>> start(mesh.vertices.size(), {-1, -1});
  for (const auto& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      ++degree[size_t(t[k])];
      start[size_t(t[k])] = {t[k], t[(k + 1) % 3]};
    }
  }
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::pair<int, int> edge = start[v];
    do {
      const auto at = edges.find(edge);
      if (at == edges.end()) break;
      ++walked[v];
      const auto& t = mesh.triangles[at->second];
      const size_t k = size_t(std::find(t.begin(), t.end(), int(v)) - t.begin());
      edge = {int(v), t[(k + 2) % 3]};
    } while (edge != start[v] && walked[v] <= degree[v]);
    if (walked[v] != degree[v] || degree[v] == 0) {
      faults.push_back(fmt::format("vertex {} has {} triangles, {} of them in one fan", v,
                                   degree[v], walked[v]));
    }
  }
}

}  // namespace

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) sum += signed_volume(mesh, t);
  return sum;
}

Audit audit(const Mesh& mesh) {
  Audit result;
  const EdgeMap edges = check_edges(mesh, result.faults);
  if (result.faults.empty()) check_fans(mesh, edges, result.faults);

  Sets sets(mesh.vertices.size());
  result.least_altitude = 1e300;
  for (const auto& t : mesh.triangles) {
    sets.join(size_t(t[0]), size_t(t[1]));
    sets.join(size_t(t[0]), size_t(t[2]));
    const double height = altitude(mesh, t);
    result.least_altitude = std::min(result.least_altitude, height);
    if (height < least_allowed_altitude) {
      const Vec3& p = mesh.vertices[size_t(t[0])];
      result.faults.push_back(fmt::format("triangle {}-{}-{} is only {} m high, near ({}, {}, {})",
                                          t[0], t[1], t[2], height, p.x(), p.y(), p.z()));
    }
  }
  std::map<size_t, double> volume_of_piece;
  for (const auto& t : mesh.triangles) {
    volume_of_piece[sets.find(size_t(t[0]))] += signed_volume(mesh, t);
  }
  result.pieces = int(volume_of_piece.size());
  for (const auto& [piece, enclosed] : volume_of_piece) {
    if (!(enclosed > 0)) result.faults.push_back(fmt::format("encloses {} m^3", enclosed));
    result.volume += enclosed;
  }
  result.low = result.high = mesh.vertices.front();
  for (const Vec3& p : mesh.vertices) {
    result.low = result.low.cwiseMin(p);
    result.high = result.high.cwiseMax(p);
  }
  return result;
}

}  // namespace tumble::assets
