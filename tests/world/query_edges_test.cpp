// Queries on a world at their edges: filters, ties, surfaces that are open or closed, questions
// that have no answer, many threads. References: answers known beforehand, and one thread's.
#include "tests/world/query_worlds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("filters: types of bodies, ids to leave out, the caller's last word") {
  TestWorld w;
  std::vector<BodyId> ids;
  for (int i = 0; i < 30; ++i) {
    BodyDef def = TestWorld::sphere_def({2.0 * i, 0, 0});
    def.type = std::array{BodyType::fixed, BodyType::kinematic, BodyType::dynamic}[size_t(i % 3)];
    ids.push_back(w.add(def));
  }
  ParticleSystemDef dust;
  dust.particles.push_back({.x = {-3, 0, 0}, .radius = 0.1});
  const auto system = w->create_particles(dust);
  w.apply();
  const auto scene = w->queries();
  const RayQuery along{{-5, 0, 0}, {1, 0, 0}};
  const auto hit = [&](const QueryFilter& f) {
    std::vector<uint32_t> slots;
    for (const auto& h : answer(scene->ray_all(along, f)))
      slots.push_back(h.target.is_particle() ? 1000 : h.target.body.index);
    return slots;
  };
  CHECK(hit({}).size() == 30);
  CHECK(hit({.kinematic = false, .dynamic = false}) ==
        std::vector<uint32_t>{0, 3, 6, 9, 12, 15, 18, 21, 24, 27});
  CHECK(hit({.fixed = false, .dynamic = false}).front() == 1);
  CHECK(hit({.fixed = false, .kinematic = false}).front() == 2);
  CHECK(hit({.particles = true}).front() == 1000);
  CHECK(hit({.fixed = false, .kinematic = false, .dynamic = false, .particles = true}) ==
        std::vector<uint32_t>{1000});
  CHECK(hit({.leave_out = {ids[0], ids[2]}}).front() == 1);
  CHECK(hit({.leave_out = ids}).empty());
  // An id of another generation names nobody.
  CHECK(hit({.leave_out = {{ids[0].index, ids[0].generation + 1}}}).front() == 0);
  CHECK(hit({.accept = [](const QueryTarget& t) { return t.body.index % 2 == 1; }}).front() == 1);
  const QueryTarget dot = answer(scene->ray(along, {.particles = true}))->target;
  CHECK(dot.particles == *system);
  CHECK(dot.particle == 0);
  // The same for the other questions.
  const QueryFilter odd{.leave_out = {ids[1]}};
  const auto big = sphere(2.2);
  CHECK(answer(scene->overlaps(*big, {{2, 0, 0}, Quat::Identity()}, odd)).size() == 2);
  CHECK(answer(scene->holding({2, 0, 0}, odd)).empty());
  CHECK(answer(scene->nearest({2, 0, 0}, 1, inf, odd))[0].target.body == ids[0]);
  CastQuery cast;
  cast.start.x = {2, 5, 0};
  cast.translation = {0, -10, 0};
  CHECK_FALSE(answer(scene->cast(*sphere(0.1), cast, odd)));
  CHECK(answer(scene->cast(*sphere(0.1), cast))->target.body == ids[1]);
}

TEST_CASE("what is equally far is ordered by id, whichever way the tree is searched") {
  TestWorld w;
  std::vector<BodyId> ids;
  for (int i = 0; i < 100; ++i) ids.push_back(w.box({0, double(i % 2), 0}, {1, 1, 1}));
  const auto scene = w->queries();
  const auto all = answer(scene->ray_all({{-5, 0.5, 0}, {1, 0, 0}}));
  REQUIRE(all.size() == 100);
  for (size_t k = 0; k < all.size(); ++k) CHECK(all[k].target.body == ids[k]);
  CHECK(answer(scene->ray({{-5, 0.5, 0}, {1, 0, 0}}))->target.body == ids[0]);
  CHECK(answer(scene->nearest({-5, 0.5, 0}, 3))[2].target.body == ids[2]);
}

TEST_CASE("a closed mesh holds what is wholly within, an open one is a surface from either side") {
  TestWorld w;
  const auto shell = std::make_shared<const TriangleMesh>(make_mesh::box({2, 2, 2}));
  const BodyId mesh_id = w.add(TestWorld::shape_def(
      {.type = ShapeType::triangle_mesh, .mesh = shell}, {0, 0, 0}, BodyType::fixed));
  const auto sheet = std::make_shared<const TriangleMesh>(
      make_mesh::terrain(4, 4, [](double, double) { return 0.0; }));
  const BodyId open_id = w.add(TestWorld::shape_def(
      {.type = ShapeType::triangle_mesh, .mesh = sheet}, {20, 0, 0}, BodyType::fixed));
  const auto scene = w->queries();
  for (const ShapeDef& def : every_shape()) {
    const auto shape = must(def);
    const auto inside = answer(scene->overlaps(*shape, {{0, 0.1, 0}, Quat::Identity()}));
    REQUIRE(inside.size() == 1);
    CHECK(inside[0].body == mesh_id);
    CHECK(answer(scene->overlaps(*shape, {{0, 9, 0}, Quat::Identity()})).empty());
    // Deep through the sheet from behind.
    const auto through = answer(scene->overlaps(*shape, {{20, -0.05, 0}, Quat(0, 1, 0, 0)}));
    REQUIRE(through.size() == 1);
    CHECK(through[0].body == open_id);
  }
  // The asking shape holds the mesh: a larger box, and a larger closed mesh.
  const auto around = make_mesh::box({5, 5, 5});
  CHECK(answer(scene->overlaps(*box({5, 5, 5}), {})).size() == 1);
  CHECK(answer(scene->overlaps(*mesh(around), {})).size() == 1);
  CHECK(answer(scene->holding({1.9, 0, 0})) == std::vector{QueryTarget{mesh_id, 0, {}, 0}});
  CHECK(answer(scene->holding({2.1, 0, 0})).empty());
  CHECK(answer(scene->holding({20, -0.1, 0})).empty());
  const auto below = answer(scene->nearest({20, -0.5, 0}));
  CHECK(below[0].distance == doctest::Approx(0.5));
  CHECK(below[0].normal.y() == doctest::Approx(-1));
}

TEST_CASE("rays without length, rays that start inside, rays along faces") {
  TestWorld w;
  const BodyId box_id = w.box({0, 0, 0}, {1, 1, 1});
  w.ground();
  const auto scene = w->queries();
  // No direction: the solids that hold the origin.
  const auto held = answer(scene->ray_all({{0.5, 0.5, 0}, {0, 0, 0}}));
  REQUIRE(held.size() == 1);
  CHECK(held[0].target.body == box_id);
  CHECK(held[0].distance == 0);
  CHECK(answer(scene->ray_all({{0.5, -0.5, 0}, {0, 0, 0}})).size() == 2);
  CHECK(answer(scene->ray_all({{0, 5, 0}, {0, 0, 0}})).empty());
  CHECK(answer(scene->ray_all({{0, 5, 0}, {0, -1, 0}, 0})).empty());
  // Started inside.
  CHECK(answer(scene->ray({{0, 0.5, 0}, {0, 1, 0}}))->distance == 0);
  CHECK_FALSE(answer(scene->ray({{0, 0.5, 0}, {0, 1, 0}, inf, false})));
  // In the plane of a face, and a hair beside it.
  CHECK(answer(scene->ray({{-5, 1, 0}, {1, 0, 0}}))->distance == doctest::Approx(4));
  CHECK_FALSE(answer(scene->ray({{-5, 1 + 1e-9, 0}, {1, 0, 0}})));
  // Of any length.
  CHECK(answer(scene->ray({{-5, 0.5, 0}, {1e-200, 0, 0}}))->distance == doctest::Approx(4));
  CHECK(answer(scene->ray({{-5, 0.5, 0}, {1e200, 0, 0}}))->distance == doctest::Approx(4));
  CHECK(answer(scene->ray({{0, 1e9, 0}, {0, -2, 0}}))->distance == doctest::Approx(1e9 - 1));
}

TEST_CASE("questions that are not finite are refused with the value") {
  TestWorld w;
  w.box({0, 0, 0});
  const auto scene = w->queries();
  const double nan = std::nan("");
  const auto ball = sphere(1);
  CHECK(scene->ray({{nan, 0, 0}, {1, 0, 0}}).error().text() == "origin is not finite: (nan, 0, 0)");
  CHECK_FALSE(scene->ray_all({{0, 0, 0}, {inf, 0, 0}}).ok());
  CHECK(scene->ray_any({{0, 0, 0}, {1, 0, 0}, -1}).error().text() ==
        "max_distance must be >= 0, got -1 m");
  CHECK_FALSE(scene->ray({{0, 0, 0}, {1, 0, 0}, nan}).ok());
  CHECK_FALSE(scene->nearest({0, inf, 0}).ok());
  CHECK_FALSE(scene->nearest({0, 0, 0}, 1, nan).ok());
  CHECK_FALSE(scene->holding({0, 0, nan}).ok());
  CHECK_FALSE(scene->overlaps(*ball, {{0, nan, 0}, Quat::Identity()}).ok());
  CHECK_FALSE(scene->overlaps_any(*ball, {{0, 0, 0}, Quat(0, 0, 0, 0)}).ok());
  CastQuery q;
  q.translation = {1, 0, nan};
  CHECK_FALSE(scene->cast(*ball, q).ok());
  q.translation = {1, 0, 0};
  q.tolerance = 0;
  CHECK(scene->cast_all(*ball, q).error().text() == "tolerance must be > 0, got 0 m");
  CHECK(answer(scene->nearest({0, 0, 0}, 0)).empty());
  CHECK_FALSE(w->ray_cast({nan, 0, 0}, {1, 0, 0}, 1));
}

TEST_CASE("an empty world, and half-spaces as the asking shape") {
  TestWorld w;
  CHECK_FALSE(answer(w->queries()->ray({})));
  CHECK(answer(w->queries()->nearest({0, 0, 0})).empty());
  w.ground();
  const BodyId low = w.sphere({100, 0.2, 0});
  w.sphere({0, 3, 0});
  const auto scene = w->queries();
  const auto plane = half_space();
  const auto met = answer(scene->overlaps(*plane, {}));
  REQUIRE(met.size() == 1);
  CHECK(met[0].body == low);
  CastQuery q;
  q.start.x = {0, -2, 0};
  q.translation = {0, 10, 0};
  const auto hit = answer(scene->cast(*plane, q));
  REQUIRE(hit);
  CHECK(hit->target.body == low);
  CHECK(hit->fraction == doctest::Approx(0.17).epsilon(1e-4));
}

TEST_CASE("many threads ask a fresh scene at once" * doctest::test_suite("long")) {
  const TestWorld w = crowd(100, 4, Vec3::Zero(), 41);
  const int count = scaled(200);
  const auto ask = [&] {
    Random r(42);
    double sum = 0;
    QueryFilter filter;
    filter.particles = true;
    for (int i = 0; i < count; ++i) {
      const auto scene = w.world->queries();
      const Ray ray = random_ray(r, Vec3::Zero(), 4);
      if (const auto hit = scene->ray({ray.origin, ray.direction}, filter); hit.ok() && *hit)
        sum += (*hit)->distance;
      if (const auto near = scene->nearest(ray.origin, 2, inf, filter); near.ok())
        for (const NearHit& n : *near) sum += n.distance;
    }
    return sum;
  };
  std::array<double, 4> sums{};
  {
    std::vector<std::jthread> threads;
    for (double& sum : sums) threads.emplace_back([&sum, &ask] { sum = ask(); });
  }
  for (const double sum : sums) CHECK(sum == sums[0]);
  CHECK(sums[0] > 0);
}
