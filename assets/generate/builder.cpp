#include "assets/generate/builder.hpp"

#include "assets/generate/triangulate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

constexpr double steps_per_metre = 1e6;

/// Twice the area vector of a loop (Newell), along its outward normal.
Vec3 newell(const Loop3& loop) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < loop.size(); ++i) sum += loop[i].cross(loop[(i + 1) % loop.size()]);
  return sum;
}

Loop2 project(const Loop3& loop, const Vec3& u, const Vec3& w) {
  Loop2 flat;
  for (const Vec3& point : loop) flat.push_back({u.dot(point), w.dot(point)});
  return flat;
}

}  // namespace

int Builder::vertex(const Vec3& point) {
  Key key;
  for (int i = 0; i < 3; ++i) {
    key[size_t(i)] = std::int64_t(std::floor(point[i] * steps_per_metre + 0.5));
  }
  const auto [at, is_new] = index_of_.emplace(key, int(vertices_.size()));
  if (is_new) {
    vertices_.push_back(key);
    points_.push_back(point);
  }
  return at->second;
}

void Builder::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<int, 3> t = {vertex(a), vertex(b), vertex(c)};
  if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles_.push_back(t);
}

void Builder::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // Rounding must not decide between equal diagonals: the second has to be clearly shorter.
  if ((b - d).squaredNorm() < 0.999 * (a - c).squaredNorm()) {
    triangle(a, b, d);
    triangle(b, c, d);
  } else {
    triangle(a, b, c);
    triangle(a, c, d);
  }
}

void Builder::polygon(const Loop3& outer, const std::vector<Loop3>& holes) {
  const Vec3 normal = newell(outer).normalized();
  const Vec3 u = (outer[1] - outer[0]).normalized();
  const Vec3 w = normal.cross(u);
  std::vector<Loop2> flat = {project(outer, u, w)};
  Loop3 points = outer;
  for (Loop3 hole : holes) {
    if (twice_area(project(hole, u, w)) > 0) std::reverse(hole.begin(), hole.end());
    flat.push_back(project(hole, u, w));
    points.insert(points.end(), hole.begin(), hole.end());
  }
  for (const auto& t : triangulate(flat)) {
    triangle(points[size_t(t[0])], points[size_t(t[1])], points[size_t(t[2])]);
  }
}

Mesh Builder::mesh(const Vec3& offset) const {
  Mesh result;
  result.triangles = triangles_;
  for (const Key& key : vertices_) {
    Vec3 point;
    for (int i = 0; i < 3; ++i) {
      const double um = double(key[size_t(i)]) + std::floor(offset[i] * steps_per_metre + 0.5);
      point[i] = um / steps_per_metre;
    }
    result.vertices.push_back(point);
  }
  return result;
}

Mesh Builder::centred_mesh() const {
  Key low = vertices_.front(), high = vertices_.front();
  for (const Key& key : vertices_) {
    for (size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], key[i]);
      high[i] = std::max(high[i], key[i]);
    }
  }
  Vec3 offset;
  for (int i = 0; i < 3; ++i) {
    offset[i] = -double(low[size_t(i)] + high[size_t(i)]) / 2 / steps_per_metre;
  }
  return mesh(offset);
}

}  // namespace tumble::assets
