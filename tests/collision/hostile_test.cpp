// Reference: the contract alone. Whatever the mesh (soup, slivers, single triangles, doubled faces,
// inside-out, non-manifold), contacts are finite, normals are unit, gaps lie within the margin, and
// the same call gives the same answer.
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<std::shared_ptr<const Shape>> hostile_meshes(Random& r) {
  std::vector<std::shared_ptr<const Shape>> list;
  TriangleMesh soup;
  for (int i = 0; i < 60; ++i) soup.vertices.push_back(random_vec(r, -0.6, 0.6));
  for (int i = 0; i < 80; ++i) soup.triangles.push_back({r.below(60), r.below(60), r.below(60)});
  list.push_back(mesh(soup));
  TriangleMesh one;
  one.vertices = {{-0.5, 0, -0.5}, {0, 0, 0.5}, {0.5, 0, -0.5}};
  one.triangles = {{0, 1, 2}};
  list.push_back(mesh(one));
  TriangleMesh needle = one;
  needle.vertices = {{-0.5, 0, 0}, {0.5, 1e-9, 0}, {0, 0, 1e-7}, {0, 0, 0}};
  needle.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 0, 1}, {2, 2, 2}};
  list.push_back(mesh(needle));
  TriangleMesh doubled = make_mesh::box({0.5, 0.3, 0.4});
  append(doubled, make_mesh::box({0.5, 0.3, 0.4}));
  list.push_back(mesh(doubled));
  TriangleMesh inside_out = make_mesh::torus(0.4, 0.1, 12, 8);
  flip(inside_out);
  list.push_back(mesh(inside_out));
  TriangleMesh fins = make_mesh::box({0.3, 0.3, 0.3});  // a third face on an edge
  fins.vertices.push_back({0.9, 0.9, 0});
  fins.triangles.push_back({fins.triangles[0][0], fins.triangles[0][1], 8});
  list.push_back(mesh(fins));
  list.push_back(mesh(scaled(make_mesh::icosphere(0.5, 1), {1, 1e-7, 1})));
  list.push_back(mesh(make_mesh::torus(0.5, 0.2, 12, 8)));
  return list;
}

void check(const std::vector<Manifold>& list, double margin) {
  for (const Manifold& m : list) {
    CHECK(std::abs(m.normal.norm() - 1) < 1e-6);
    CHECK(m.count >= 1);
    CHECK(m.count <= 4);
    for (int i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[size_t(i)];
      CHECK(p.x_world.allFinite());
      CHECK(std::isfinite(p.gap));
      CHECK(p.gap <= margin + 1e-9);
      CHECK(p.gap > -10);
    }
  }
}

}  // namespace

TEST_CASE("hostile meshes against everything") {
  Random r(61);
  const auto meshes = hostile_meshes(r);
  auto others = meshes;
  for (const auto& s :
       {sphere(0.3), capsule(0.2, 0.5), box({0.3, 0.2, 0.4}), cylinder(0.3, 0.5),
        ellipsoid({0.3, 0.2, 1e-4}), cone(0.3, 0.4), tapered_capsule(0.3, 1e-4, 0.4),
        random_hull(r, 14, {0.4, 0.4, 0.3}), half_space(), random_hull(r, 12, {0.5, 1e-4, 1e-4})})
    others.push_back(s);
  const int n = cases(12);
  for (const auto& a : meshes)
    for (const auto& b : others)
      for (int i = 0; i < n; ++i) {
        // axis-aligned and coincident poses too, where everything is degenerate
        const Quat qa = i % 3 ? random_rotation(r) : Quat::Identity();
        const Pose pa{{1, 2, 3}, qa};
        const Pose pb{i % 5 ? Vec3(pa.x + random_vec(r, -0.6, 0.6)) : pa.x,
                      i % 4 ? random_rotation(r) : qa};
        std::vector<Manifold> x, y;
        collide(*a, pa, *b, pb, 0.02, x);
        check(x, 0.02);
        collide(*b, pb, *a, pa, 0.02, y);
        check(y, 0.02);
        std::vector<Manifold> again;
        collide(*a, pa, *b, pb, 0.02, again);
        REQUIRE(again.size() == x.size());
        for (size_t k = 0; k < x.size(); ++k) CHECK(again[k].normal == x[k].normal);
        const auto c = closest_point(*a, pa, pb.x);
        if (c) CHECK(c->x_world.allFinite());
        if (i % 8) continue;
        Motion m = Motion::at_rest({pb.x + Vec3(0, 3, 0), pb.q}, 0, 0.1);
        m.velocity = {0, -60, 0};
        m.omega = random_vec(r, -30, 30);
        const auto toc = time_of_contact(*a, Motion::at_rest(pa, 0, 0.1), *b, m, 1e-4);
        CHECK(std::isfinite(toc.time));
        CHECK(toc.time >= 0);
        CHECK(toc.time <= 0.1);
      }
}

TEST_CASE("needles and plates against each other, deep and coincident") {
  Random r(62);
  std::vector<std::shared_ptr<const Shape>> thin{box({1, 1e-4, 1e-4}),
                                                 box({1, 1e-4, 1}),
                                                 cylinder(1, 1e-4),
                                                 cylinder(1e-4, 2),
                                                 capsule(1e-4, 2),
                                                 ellipsoid({1, 1e-4, 1e-4}),
                                                 ellipsoid({1, 1e-4, 1}),
                                                 cone(1, 1e-4),
                                                 cone(1e-4, 2),
                                                 tapered_capsule(2e-4, 1e-4, 2),
                                                 random_hull(r, 20, {1, 1e-4, 1e-4}),
                                                 random_hull(r, 20, {1, 1e-4, 1})};
  const int n = cases(30);
  for (const auto& a : thin)
    for (const auto& b : thin)
      for (int i = 0; i < n; ++i) {
        const Pose pa{Vec3::Zero(), i % 3 ? random_rotation(r) : Quat::Identity()};
        const Pose pb{i % 4 ? random_vec(r, -1e-3, 1e-3) : Vec3::Zero(),
                      i % 5 ? random_rotation(r) : pa.q};
        std::vector<Manifold> out;
        collide(*a, pa, *b, pb, 0.001, out);
        check(out, 0.001);
      }
}
