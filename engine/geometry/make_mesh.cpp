#include "engine/geometry/make_mesh.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>
#include <map>

namespace tumble::make_mesh {
namespace {

double angle_of(int i, int n) {
  return 2 * det::pi * i / n;
}

/// Adds two triangles for the quadrilateral a b c d, counter-clockwise.
void quad(TriangleMesh& m, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  m.triangles.push_back({a, b, c});
  m.triangles.push_back({a, c, d});
}

/// A surface of revolution about Y: a bottom pole, circles (height, radius) from below, a top pole.
TriangleMesh revolve(double bottom, double top, const std::vector<Vec2>& circles, int segments) {
  TriangleMesh m;
  m.vertices.emplace_back(0, bottom, 0);
  for (const Vec2& circle : circles) {
    for (int s = 0; s < segments; ++s) {
      const double a = angle_of(s, segments);
      m.vertices.emplace_back(circle.y() * det::cos(a), circle.x(), circle.y() * det::sin(a));
    }
  }
  m.vertices.emplace_back(0, top, 0);
  const auto n = uint32_t(segments);
  const auto at = [&](size_t ring, uint32_t s) { return uint32_t(1 + ring * n + s % n); };
  const auto last = uint32_t(m.vertices.size() - 1);
  for (uint32_t s = 0; s < n; ++s) {
    m.triangles.push_back({0, at(0, s), at(0, s + 1)});
    for (size_t r = 0; r + 1 < circles.size(); ++r) {
      quad(m, at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1));
    }
    m.triangles.push_back({last, at(circles.size() - 1, s + 1), at(circles.size() - 1, s)});
  }
  return m;
}

}  // namespace

TriangleMesh box(const Vec3& half_extents) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1) ? 1.0 : -1.0, (i & 2) ? 1.0 : -1.0, (i & 4) ? 1.0 : -1.0);
    m.vertices.push_back(half_extents.cwiseProduct(sign));
  }
  quad(m, 0, 4, 6, 2);  // -x
  quad(m, 1, 3, 7, 5);  // +x
  quad(m, 0, 1, 5, 4);  // -y
  quad(m, 2, 6, 7, 3);  // +y
  quad(m, 0, 2, 3, 1);  // -z
  quad(m, 4, 5, 7, 6);  // +z
  return m;
}

TriangleMesh tetrahedron(double radius) {
  const double s = radius / std::sqrt(3.0);
  TriangleMesh m;
  m.vertices = {Vec3(s, s, s), Vec3(s, -s, -s), Vec3(-s, s, -s), Vec3(-s, -s, s)};
  m.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return m;
}

TriangleMesh icosphere(double radius, int levels) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  TriangleMesh m;
  m.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), uint32_t(m.vertices.size()));
      if (fresh) m.vertices.push_back((m.vertices[a] + m.vertices[b]).normalized());
      return it->second;
    };
    for (Vec3& v : m.vertices) v.normalize();
    std::vector<Triangle> finer;
    finer.reserve(4 * m.triangles.size());
    for (const Triangle& t : m.triangles) {
      const uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    m.triangles = std::move(finer);
  }
  for (Vec3& v : m.vertices) v *= radius / v.norm();
  return m;
}

TriangleMesh torus(double major, double minor, int major_segments, int minor_segments) {
  TriangleMesh m;
  for (int i = 0; i < major_segments; ++i) {
    const double a = angle_of(i, major_segments);
    for (int j = 0; j < minor_segments; ++j) {
      const double b = angle_of(j, minor_segments), r = major + minor * det::cos(b);
      m.vertices.emplace_back(r * det::cos(a), minor * det::sin(b), r * det::sin(a));
    }
  }
  const auto at = [&](int i, int j) {
    return uint32_t((i % major_segments) * minor_segments + j % minor_segments);
  };
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      quad(m, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return m;
}

TriangleMesh cylinder(double half_height, double radius, int segments) {
  return revolve(-half_height, half_height, {Vec2(-half_height, radius), Vec2(half_height, radius)},
                 segments);
}

TriangleMesh capsule(double half_height, double radius, int segments, int rings) {
  std::vector<Vec2> circles;
  for (int half = 0; half < 2; ++half) {
    const double centre = half == 0 ? -half_height : half_height;
    for (int r = 0; r < rings; ++r) {
      const double a =
          half == 0 ? -0.5 * det::pi * (rings - 1 - r) / rings : 0.5 * det::pi * r / rings;
      circles.emplace_back(centre + radius * det::sin(a), radius * det::cos(a));
    }
  }
  return revolve(-half_height - radius, half_height + radius, circles, segments);
}

TriangleMesh terrain(double size, int cells, const std::function<double(double, double)>& height) {
  TriangleMesh m;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = size * (double(i) / cells - 0.5), z = size * (double(j) / cells - 0.5);
      m.vertices.emplace_back(x, height(x, z), z);
    }
  }
  const auto at = [&](int i, int j) { return uint32_t(i * (cells + 1) + j); };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) quad(m, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  }
  return m;
}

double cylinder_volume(double half_height, double radius, int segments) {
  return radius * radius * segments * det::sin(2 * det::pi / segments) * half_height;
}

double torus_volume(double major, double minor, int major_segments, int minor_segments) {
  // Between two half-planes at an angle A, an area element of the section at radius r sweeps
  // triangles, not sectors: r sin(A) instead of r A. The centroid of the section is at radius
  // `major`.
  const double area = 0.5 * minor * minor * minor_segments * det::sin(2 * det::pi / minor_segments);
  return area * major * major_segments * det::sin(2 * det::pi / major_segments);
}

}  // namespace tumble::make_mesh
