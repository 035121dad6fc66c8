#include "viewer/render/builtin_meshes.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace tumble {
namespace {

/// Links a mesh to its coarser version and sets when that is used. Coarse versions are made first,
/// so that each finer one can point at them.
MeshRef with_coarser(const MeshRef& mesh, const MeshRef& coarser, float below_pixels,
                     float below_inflate = 0) {
  auto copy = std::make_shared<MeshData>(*mesh);
  copy->coarser = coarser;
  copy->coarser_below_pixels = below_pixels;
  copy->coarser_below_inflate = below_inflate;
  return copy;
}

MeshRef taking_scale(const MeshRef& mesh) {
  auto copy = std::make_shared<MeshData>(*mesh);
  copy->takes_scale = true;
  return copy;
}

MeshRef icosphere(int splits) {
  const float g = 1.618033988749895f;
  std::vector<Vec3f> p = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                          {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                          {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<uint32_t> t = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                             4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                             6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (Vec3f& v : p) v.normalize();
  for (int s = 0; s < splits; ++s) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middle;
    const auto mid = [&](uint32_t a, uint32_t b) {
      const auto [it, fresh] = middle.try_emplace(std::minmax(a, b), uint32_t(p.size()));
      if (fresh) p.push_back((p[a] + p[b]).normalized());
      return it->second;
    };
    std::vector<uint32_t> next;
    next.reserve(t.size() * 4);
    for (size_t i = 0; i < t.size(); i += 3) {
      const uint32_t a = t[i], b = t[i + 1], c = t[i + 2];
      const uint32_t ab = mid(a, b), bc = mid(b, c), ca = mid(c, a);
      for (const uint32_t k : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) next.push_back(k);
    }
    t = std::move(next);
  }
  // Inscribed facets look thin: push vertices out until the mean radius is one.
  const float grow = splits == 1 ? 1.045f : splits == 2 ? 1.012f : 1.003f;
  std::vector<Vec3f> n = p;
  for (Vec3f& v : p) v *= splits == 0 ? 1.12f : grow;
  return make_mesh(std::move(p), std::move(n), std::move(t), false);
}

/// For spheres of a pixel or two, and their shadows.
MeshRef octahedron() {
  std::vector<Vec3f> p, n;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.f, -1.f}) n.push_back(Vec3f::Unit(axis) * side);
  for (const Vec3f& v : n) p.push_back(1.3f * v);
  return make_mesh(std::move(p), std::move(n),
                   {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}, false);
}

void quad(std::vector<uint32_t>& t, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  for (const uint32_t k : {a, b, c, a, c, d}) t.push_back(k);
}

/// Three vertices per corner, one for each adjacent face. Triangles of faces come first, then of
/// chamfers, then of corners.
MeshRef box(bool chamfered) {
  std::vector<Vec3f> p, n;
  const auto index = [](int sx, int sy, int sz, int axis) {
    return uint32_t(((sx > 0) * 4 + (sy > 0) * 2 + (sz > 0)) * 3 + axis);
  };
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3f s(corner & 4 ? 1.f : -1.f, corner & 2 ? 1.f : -1.f, corner & 1 ? 1.f : -1.f);
      p.push_back(s);
      n.push_back(Vec3f::Unit(axis) * s[axis]);
    }
  std::vector<uint32_t> t;
  const auto at = [&](std::array<int, 3> s, int axis) { return index(s[0], s[1], s[2], axis); };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {-1, 1}) {
      std::array<int, 3> c{};
      c[size_t(axis)] = side;
      const auto k = [&](int su, int sv) {
        c[size_t(u)] = su * side;
        c[size_t(v)] = sv;
        return at(c, axis);
      };
      quad(t, k(-1, -1), k(1, -1), k(1, 1), k(-1, 1));
    }
    if (!chamfered) continue;
    // The strip between faces u and v along this axis.
    for (const int su : {-1, 1})
      for (const int sv : {-1, 1}) {
        std::array<int, 3> a{}, b{};
        a[size_t(u)] = b[size_t(u)] = su;
        a[size_t(v)] = b[size_t(v)] = sv;
        a[size_t(axis)] = su * sv;
        b[size_t(axis)] = -su * sv;
        quad(t, at(a, v), at(a, u), at(b, u), at(b, v));
      }
  }
  if (chamfered)
    for (const int x : {-1, 1})
      for (const int y : {-1, 1})
        for (const int z : {-1, 1}) {
          const bool even = x * y * z > 0;
          for (const int axis : {0, even ? 1 : 2, even ? 2 : 1}) t.push_back(index(x, y, z, axis));
        }
  return make_mesh(std::move(p), std::move(n), std::move(t), false);
}

struct Ring {
  float y, radius;    ///< of the core
  float ny, nradial;  ///< normal
};

/// A surface of revolution about y; rings from the bottom to the top.
MeshRef lathe(const std::vector<Ring>& rings, uint32_t around) {
  std::vector<Vec3f> p, n;
  std::vector<uint32_t> t;
  for (const Ring& r : rings)
    for (uint32_t i = 0; i < around; ++i) {
      const double a = 2 * det::pi * i / around;
      const float c = float(det::cos(a)), s = float(det::sin(a));
      p.push_back({r.radius * c, r.y, r.radius * s});
      n.push_back(Vec3f(r.nradial * c, r.ny, r.nradial * s));
    }
  for (uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (uint32_t i = 0; i < around; ++i) {
      const uint32_t j = (i + 1) % around, lower = r * around, upper = lower + around;
      quad(t, lower + i, upper + i, upper + j, lower + j);
    }
  return make_mesh(std::move(p), std::move(n), std::move(t), false);
}

MeshRef cylinder(uint32_t around, bool rounded) {
  const float d = 0.70710678f;
  std::vector<Ring> rings = {{-1, 0, -1, 0}, {-1, 1, -1, 0}};
  if (rounded) rings.push_back({-1, 1, -d, d});
  rings.push_back({-1, 1, 0, 1});
  rings.push_back({1, 1, 0, 1});
  if (rounded) rings.push_back({1, 1, d, d});
  rings.push_back({1, 1, 1, 0});
  rings.push_back({1, 0, 1, 0});
  return lathe(rings, around);
}

MeshRef capsule(uint32_t around, int half_rings) {
  std::vector<Ring> rings;
  for (int end : {-1, 1})
    for (int i = 0; i <= half_rings; ++i) {
      const double a = 0.5 * det::pi * (end < 0 ? i - half_rings : i) / half_rings;
      rings.push_back({float(end), 0, float(det::sin(a)), float(det::cos(a))});
    }
  return lathe(rings, around);
}

/// Radius of the edges of a box or cylinder [m]: small roundings catch the light at edges and are
/// otherwise invisible.
float edge_round(double smallest_half) {
  return float(std::min(0.06 * smallest_half, 0.02));
}

}  // namespace

MeshRef sphere_mesh() {
  static const MeshRef mesh = with_coarser(
      icosphere(3),
      with_coarser(icosphere(2),
                   with_coarser(icosphere(1), with_coarser(icosphere(0), octahedron(), 2.5f), 6),
                   16),
      55);
  return mesh;
}

MeshRef ball_card() {
  static const MeshRef card = [] {
    const float s = 0.8660254f;  // circumscribes the circle of radius 1/2
    const MeshRef triangle = make_mesh({{0, 1, 0}, {-s, -0.5f, 0}, {s, -0.5f, 0}},
                                       std::vector<Vec3f>(3, Vec3f::UnitZ()), {0, 1, 2}, true);
    auto copy = std::make_shared<MeshData>(*triangle);
    copy->ball = true;
    return MeshRef(copy);
  }();
  return card;
}

MeshRef box_mesh() {
  static const MeshRef mesh = with_coarser(box(true), taking_scale(box(false)), 25, 0.2f);
  return mesh;
}

MeshRef cylinder_mesh() {
  static const MeshRef mesh =
      with_coarser(cylinder(48, true),
                   with_coarser(cylinder(24, true), taking_scale(cylinder(12, false)), 14), 60);
  return mesh;
}

MeshRef capsule_mesh() {
  static const MeshRef mesh =
      with_coarser(capsule(40, 10), with_coarser(capsule(20, 5), capsule(10, 2), 12), 60);
  return mesh;
}

MeshRef plane_mesh() {
  static const MeshRef mesh =
      make_mesh({{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}},
                std::vector<Vec3f>(4, Vec3f::UnitY()), {0, 1, 2, 0, 2, 3}, true);
  return mesh;
}

MeshRef cone_mesh() {
  static const MeshRef mesh = lathe({{0, 0, -1, 0},
                                     {0, 1, -1, 0},
                                     {0, 1, 0.70710678f, 0.70710678f},
                                     {1, 0, 0.70710678f, 0.70710678f}},
                                    20);
  return mesh;
}

MeshInstance sphere_instance(const Pose& pose, double radius, const Paint& paint) {
  return mesh_instance(sphere_mesh(), pose, Vec3::Constant(radius), paint);
}

MeshInstance ellipsoid_instance(const Pose& pose, const Vec3& semi_axes, const Paint& paint) {
  return mesh_instance(sphere_mesh(), pose, semi_axes, paint);
}

MeshInstance box_instance(const Pose& pose, const Vec3& half_extents, const Paint& paint) {
  const float r = edge_round(half_extents.minCoeff());
  MeshInstance i = mesh_instance(box_mesh(), pose, half_extents - Vec3::Constant(double(r)), paint);
  i.inflate = r;
  return i;
}

MeshInstance cylinder_instance(const Pose& pose, double radius, double half_height,
                               const Paint& paint) {
  const float r = edge_round(std::min(radius, half_height));
  const double core = radius - double(r);
  MeshInstance i =
      mesh_instance(cylinder_mesh(), pose, Vec3(core, half_height - double(r), core), paint);
  i.inflate = r;
  return i;
}

MeshInstance capsule_instance(const Pose& pose, double radius, double half_height,
                              const Paint& paint) {
  // The core has no width: x and z of the scale only carry the rotation.
  MeshInstance i =
      mesh_instance(capsule_mesh(), pose, Vec3(radius, std::max(half_height, 1e-6), radius), paint);
  i.inflate = float(radius);
  return i;
}

void add_arrow(RenderScene& scene, const Vec3& a, const Vec3& b, double radius,
               const Paint& paint) {
  const Vec3 d = b - a;
  const double length = d.norm();
  if (!(length > 0)) return;
  const Quat q = rotation_between(Vec3::UnitY(), d / length);
  const double head = std::min(5 * radius, 0.5 * length), shaft = length - head;
  const Vec3 u = d / length;
  MeshInstance rod = mesh_instance(cylinder_mesh(), {a + 0.5 * shaft * u, q},
                                   Vec3(radius, 0.5 * shaft, radius), paint);
  MeshInstance tip =
      mesh_instance(cone_mesh(), {a + shaft * u, q}, Vec3(0.45 * head, head, 0.45 * head), paint);
  rod.casts_shadow = tip.casts_shadow = false;
  scene.instances.push_back(std::move(rod));
  scene.instances.push_back(std::move(tip));
}

MeshInstance mesh_instance(const MeshRef& mesh, const Pose& pose, const Vec3& scale,
                           const Paint& paint) {
  MeshInstance i;
  i.mesh = mesh;
  i.transform = transform_of(pose, scale);
  i.paint = paint;
  return i;
}

}  // namespace tumble
