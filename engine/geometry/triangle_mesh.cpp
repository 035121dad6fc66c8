#include "engine/geometry/triangle_mesh.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {

Status validate(const TriangleMesh& mesh, const MeshLimits& limits) {
  const auto fault = [](std::string message) {
    return Error{ErrorCode::invalid_argument, std::move(message), {}, {}};
  };
  if (mesh.triangles.empty()) return fault("the mesh has no triangles");
  if (mesh.vertices.size() > limits.max_vertices) {
    return fault(fmt::format("the mesh has {} vertices, at most {} are allowed",
                             mesh.vertices.size(), limits.max_vertices));
  }
  if (mesh.triangles.size() > limits.max_triangles) {
    return fault(fmt::format("the mesh has {} triangles, at most {} are allowed",
                             mesh.triangles.size(), limits.max_triangles));
  }
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& v = mesh.vertices[i];
    if (!v.allFinite()) {
      return fault(fmt::format("vertex {} is ({}, {}, {}), not finite", i, v.x(), v.y(), v.z()));
    }
    if (v.cwiseAbs().maxCoeff() > limits.max_coordinate) {
      Error far =
          fault(fmt::format("vertex {} is at ({:.6g}, {:.6g}, {:.6g}) m, further than {} m "
                            "from the origin",
                            i, v.x(), v.y(), v.z(), limits.max_coordinate));
      far.cure = "\"centre\": true of a mesh moves it there, \"scale\" makes it smaller";
      return far;
    }
  }
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        return fault(fmt::format("triangle {} refers to vertex {}, but there are only {}", t, v,
                                 mesh.vertices.size()));
      }
    }
  }
  return {};
}

Aabb bounds(const TriangleMesh& mesh) {
  Aabb box;
  for (const Vec3& v : mesh.vertices) box.include(v);
  return box;
}

Aabb triangle_bounds(const TriangleMesh& mesh, size_t triangle) {
  Aabb box;
  for (size_t k = 0; k < 3; ++k) box.include(mesh.corner(triangle, k));
  return box;
}

Vec3 face_area_vector(const TriangleMesh& mesh, size_t triangle) {
  const Vec3& a = mesh.corner(triangle, 0);
  const Vec3 u = mesh.corner(triangle, 1) - a, v = mesh.corner(triangle, 2) - a;
  return 0.5 * u.cross(v);
}

Vec3 face_normal(const TriangleMesh& mesh, size_t triangle) {
  const Vec3 n = face_area_vector(mesh, triangle);
  const double length = n.norm();
  if (!(length > 0)) return Vec3::Zero();
  return n / length;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) area += face_area_vector(mesh, t).norm();
  return area;
}

TriangleMesh transformed(const TriangleMesh& mesh, const Pose& pose) {
  TriangleMesh out = mesh;
  for (Vec3& v : out.vertices) v = pose.point(v);
  return out;
}

TriangleMesh scaled(const TriangleMesh& mesh, const Vec3& scale) {
  TriangleMesh out = mesh;
  for (Vec3& v : out.vertices) v = v.cwiseProduct(scale);
  const int negative = (scale.x() < 0) + (scale.y() < 0) + (scale.z() < 0);
  if (negative % 2 == 1) flip(out);
  return out;
}

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto base = uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Triangle& t : part.triangles) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

void flip(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace tumble
