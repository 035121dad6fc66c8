// Built-in meshes. Reference: Euler's formula on joined vertices, the divergence theorem (volume of
// the closed surface against the solid's own), and that every face looks outwards.
#include "viewer/render/builtin_meshes.hpp"

#include <array>
#include <map>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Solid {
  std::vector<Vec3> corners;  ///< three a triangle, in the world
  double volume = 0;
};

/// The triangles as surface.vert places them.
Solid placed(const MeshInstance& i) {
  Solid s;
  const Mat3 m = i.transform.linear.cast<double>();
  for (const uint32_t k : i.mesh->indices) {
    const Vec3 n = i.mesh->normals[k].cast<double>();
    Vec3 moved = Vec3::Zero();
    for (int c = 0; c < 3; ++c) moved += n[c] * m.col(c).normalized();
    s.corners.push_back(m * i.mesh->positions[k].cast<double>() + double(i.inflate) * moved +
                        i.transform.offset.cast<double>());
  }
  for (size_t t = 0; t < s.corners.size(); t += 3)
    s.volume += s.corners[t].dot(s.corners[t + 1].cross(s.corners[t + 2])) / 6;
  return s;
}

/// V - E + F with vertices joined where they coincide, faces without area left out.
int euler(const Solid& s) {
  std::map<std::array<long, 3>, int> ids;
  std::set<std::array<int, 2>> edges;
  int faces = 0;
  for (size_t t = 0; t < s.corners.size(); t += 3) {
    std::array<int, 3> v{};
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = s.corners[t + k];
      const std::array<long, 3> key = {std::lround(p.x() * 1e5), std::lround(p.y() * 1e5),
                                       std::lround(p.z() * 1e5)};
      v[k] = ids.try_emplace(key, int(ids.size())).first->second;
    }
    if (v[0] == v[1] || v[1] == v[2] || v[0] == v[2]) continue;
    ++faces;
    for (size_t k = 0; k < 3; ++k)
      edges.insert({std::min(v[k], v[(k + 1) % 3]), std::max(v[k], v[(k + 1) % 3])});
  }
  return int(ids.size()) - int(edges.size()) + faces;
}

void check_closed(const MeshInstance& i, double volume, double tolerance) {
  const Solid s = placed(i);
  CHECK(euler(s) == 2);
  CHECK(s.volume == doctest::Approx(volume).epsilon(tolerance));
}

const Pose somewhere = {Vec3(3, -2, 5), Quat(0.5, 0.5, -0.5, 0.5)};

}  // namespace

TEST_CASE("built-in solids are closed, look outwards and have their size") {
  const double pi = 3.14159265358979;
  check_closed(sphere_instance(somewhere, 2, {}), 4 / 3. * pi * 8, 0.02);
  check_closed(ellipsoid_instance(somewhere, Vec3(1, 2, 3), {}), 4 / 3. * pi * 6, 0.02);
  check_closed(box_instance(somewhere, Vec3(1, 2, 3), {}), 48, 0.01);
  check_closed(box_instance(somewhere, Vec3(0.01, 0.02, 0.03), {}), 48e-6, 0.01);
  check_closed(cylinder_instance(somewhere, 2, 1, {}), 8 * pi, 0.02);
  check_closed(capsule_instance(somewhere, 1, 2, {}), 4 * pi + 4 / 3. * pi, 0.03);
}

TEST_CASE("normals have unit length and agree with the faces") {
  for (const MeshRef& top : {sphere_mesh(), box_mesh(), cylinder_mesh(), cone_mesh()})
    for (MeshRef m = top; m; m = m->coarser) {
      for (const Vec3f& n : m->normals) CHECK(n.norm() == doctest::Approx(1).epsilon(1e-5));
      for (size_t t = 0; t < m->indices.size(); t += 3) {
        const auto p = [&](size_t k) { return m->positions[m->indices[t + k]]; };
        const Vec3f face = (p(1) - p(0)).cross(p(2) - p(0));
        if (face.norm() < 1e-6f) continue;
        Vec3f mean = Vec3f::Zero();
        for (size_t k = 0; k < 3; ++k) mean += m->normals[m->indices[t + k]];
        CHECK(face.dot(mean) > 0);
      }
    }
}

TEST_CASE("coarser versions are cheaper and come at smaller sizes") {
  for (const MeshRef& top : {sphere_mesh(), box_mesh(), cylinder_mesh(), capsule_mesh()})
    for (MeshRef m = top; m->coarser; m = m->coarser) {
      CHECK(m->coarser->indices.size() < m->indices.size());
      CHECK(m->coarser->id != m->id);
      if (m->coarser->coarser) CHECK(m->coarser->coarser_below_pixels < m->coarser_below_pixels);
    }
}

TEST_CASE("meshes: equal content has equal id, malformed ones are refused") {
  const std::vector<Vec3f> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Vec3f> n(3, Vec3f::UnitZ());
  const MeshRef a = make_mesh(p, n, {0, 1, 2}), b = make_mesh(p, n, {0, 1, 2});
  REQUIRE(a);
  CHECK(a->id == b->id);
  CHECK(a->id != make_mesh(p, n, {0, 2, 1})->id);
  CHECK(make_mesh(p, n, {0, 1, 3}) == nullptr);
  CHECK(make_mesh(p, {}, {0, 1, 2}) == nullptr);
  CHECK(make_mesh({{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}, n, {0, 1, 2}) == nullptr);
}

TEST_CASE("creases stay sharp and smooth edges become smooth") {
  // Two faces that meet at an angle of 60 degrees, then of 6.
  for (const double degrees : {60.0, 6.0}) {
    const double a = degrees * 3.14159265358979 / 180;
    const std::vector<Vec3> p = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-std::cos(a), -std::sin(a), 0}};
    const std::vector<uint32_t> t = {0, 1, 2, 0, 3, 1};
    const MeshRef m = make_mesh_from_triangles(p, t, 35);
    REQUIRE(m);
    CHECK(m->positions.size() == (degrees > 35 ? 6 : 4));
  }
}
