#include "viewer/render/mesh.hpp"

#include "engine/core/hash.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>

namespace tumble {

MeshRef make_mesh(std::vector<Vec3f> positions, std::vector<Vec3f> normals,
                  std::vector<uint32_t> indices, bool two_sided) {
  if (normals.size() < positions.size()) return nullptr;
  for (const uint32_t i : indices)
    if (i >= positions.size()) return nullptr;
  auto mesh = std::make_shared<MeshData>();
  for (size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite()) return nullptr;
    mesh->min = i ? Vec3f(mesh->min.cwiseMin(positions[i])) : positions[i];
    mesh->max = i ? Vec3f(mesh->max.cwiseMax(positions[i])) : positions[i];
    mesh->reach = std::max(mesh->reach, positions[i].norm());
  }
  uint64_t h = hash_bytes(positions.data(), positions.size() * sizeof(Vec3f), two_sided ? 2 : 1);
  h = hash_bytes(normals.data(), normals.size() * sizeof(Vec3f), h);
  h = hash_bytes(indices.data(), indices.size() * sizeof(uint32_t), h);
  mesh->id = h ? h : 1;
  mesh->positions = std::move(positions);
  mesh->normals = std::move(normals);
  mesh->indices = std::move(indices);
  mesh->two_sided = two_sided;
  return mesh;
}

namespace {

struct Corner {
  uint32_t face;
  uint32_t slot;  ///< 0..2
  double angle;   ///< at this corner [rad]: the weight of the face in the smooth normal
};

/// Unit normal, or zero for a face without area.
Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double l = n.norm();
  return l > 0 ? Vec3(n / l) : Vec3::Zero();
}

double corner_angle(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 u = q - p, v = r - p;
  const double l = u.norm() * v.norm();
  return l > 0 ? det::acos(std::clamp(u.dot(v) / l, -1.0, 1.0)) : 0;
}

}  // namespace

MeshRef make_mesh_from_triangles(std::span<const Vec3> positions, std::span<const uint32_t> indices,
                                 double crease_deg, bool two_sided) {
  for (const uint32_t i : indices)
    if (i >= positions.size()) return nullptr;
  const size_t faces = indices.size() / 3;
  std::vector<Vec3> normal(faces);
  // Corners around each position; files such as STL repeat positions, so these are joined first.
  std::vector<uint32_t> order(positions.size()), joined(positions.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](uint32_t i) {
    return std::array<double, 3>{positions[i].x(), positions[i].y(), positions[i].z()};
  };
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (size_t i = 0; i < order.size(); ++i)
    joined[order[i]] = i && key(order[i]) == key(order[i - 1]) ? joined[order[i - 1]] : order[i];

  std::vector<std::vector<Corner>> around(positions.size());
  for (uint32_t f = 0; f < faces; ++f) {
    const Vec3& a = positions[indices[3 * f]];
    const Vec3& b = positions[indices[3 * f + 1]];
    const Vec3& c = positions[indices[3 * f + 2]];
    normal[f] = face_normal(a, b, c);
    const std::array<const Vec3*, 3> p = {&a, &b, &c};
    for (uint32_t k = 0; k < 3; ++k)
      around[joined[indices[3 * f + k]]].push_back(
          {f, k, corner_angle(*p[k], *p[(k + 1) % 3], *p[(k + 2) % 3])});
  }

  std::vector<Vec3f> out_positions, out_normals;
  std::vector<uint32_t> out_indices(3 * faces);
  const double cosine = det::cos(crease_deg * det::pi / 180);
  for (uint32_t v = 0; v < positions.size(); ++v) {
    const size_t first = out_positions.size();
    for (const Corner& corner : around[v]) {
      Vec3 sum = Vec3::Zero();
      for (const Corner& other : around[v])
        if (normal[corner.face].dot(normal[other.face]) >= cosine)
          sum += other.angle * normal[other.face];
      const double l = sum.norm();
      const Vec3f n = (l > 0 ? Vec3(sum / l) : normal[corner.face]).cast<float>();
      size_t at = first;
      while (at < out_normals.size() && (out_normals[at] - n).squaredNorm() > 1e-10f) ++at;
      if (at == out_normals.size()) {
        out_positions.push_back(positions[v].cast<float>());
        out_normals.push_back(n);
      }
      out_indices[3 * corner.face + corner.slot] = uint32_t(at);
    }
  }
  return make_mesh(std::move(out_positions), std::move(out_normals), std::move(out_indices),
                   two_sided);
}

}  // namespace tumble
