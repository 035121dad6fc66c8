// Queries on a world. References: the same question put to every shape of the frame one by one by
// the functions of engine/collision (brute force), and closed forms written here: lines against
// balls, boxes and planes, triangles one by one (Moeller & Trumbore), distances to convex solids,
// and where a moving ball first comes that near, by bisection of a convex function.
#include "engine/collision/query.hpp"
#include "tests/world/query_worlds.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// What must answer, or the test fails.
template <class T>
T answer(Result<T> r) {
  REQUIRE_MESSAGE(r.ok(), (r.ok() ? "" : r.error().text()));
  return std::move(r).value();
}

std::vector<QueryTarget> targets_of(const auto& hits) {
  std::vector<QueryTarget> out;
  for (const auto& h : hits) out.push_back(h.target);
  return out;
}

Ray random_ray(Random& r, const Vec3& middle, double half) {
  const Vec3 from = middle + random_vec(r, -1.5 * half, 1.5 * half);
  const Vec3 to = middle + random_vec(r, -half, half);
  return {from, (to - from) * r.uniform(0.1, 3)};
}

/// Every shape's first hit by the shape's own function, nearest first.
std::vector<RayQueryHit> brute_rays(const Frame& frame, const RayQuery& q, bool particles) {
  std::vector<RayQueryHit> hits;
  const Ray ray{q.origin, q.direction.normalized()};
  for_all_shapes(frame, particles,
                 [&](const QueryTarget& target, const Shape& shape, const Pose& pose, BodyType) {
                   const auto hit = ray_cast(shape, pose, ray, q.max_distance);
                   if (!hit || (hit->t == 0 && !q.hit_inside)) return;
                   hits.push_back({target, hit->t, ray.at(hit->t), hit->normal, hit->feature});
                 });
  std::sort(hits.begin(), hits.end(), [](const RayQueryHit& a, const RayQueryHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.target < b.target;
  });
  return hits;
}

/// Rays, overlaps, points and nearest points of a scene against brute force.
void compare_with_brute_force(const QueryScene& scene, const Vec3& middle, double half, int count,
                              uint64_t seed) {
  Random r(seed);
  const Frame& frame = scene.frame();
  const auto shapes = every_shape();
  size_t ray_hits = 0, touching = 0, held = 0;
  QueryFilter with_particles;
  with_particles.particles = true;
  for (int i = 0; i < count; ++i) {
    const bool particles = i % 2 == 1;
    const QueryFilter filter = particles ? with_particles : QueryFilter{};
    const Ray ray = random_ray(r, middle, half);
    const RayQuery q{ray.origin, ray.direction, i % 3 == 0 ? r.uniform(0, 3 * half) : inf,
                     i % 5 != 0};
    const auto all = answer(scene.ray_all(q, filter));
    const auto expected = brute_rays(frame, q, particles);
    REQUIRE(targets_of(all) == targets_of(expected));
    for (size_t k = 0; k < all.size(); ++k) {
      CHECK(all[k].distance == doctest::Approx(expected[k].distance).epsilon(1e-12));
      CHECK((all[k].normal - expected[k].normal).norm() < 1e-9);
      CHECK((all[k].x_world - ray.at(all[k].distance / ray.direction.norm())).norm() < 1e-8);
    }
    const auto first = answer(scene.ray(q, filter));
    REQUIRE(first.has_value() == !all.empty());
    if (first) {
      CHECK(first->target == all[0].target);
      CHECK(first->distance == all[0].distance);
    }
    CHECK(answer(scene.ray_any(q, filter)) == first.has_value());
    ray_hits += all.size();

    const auto shape = must(shapes[r.below(uint32_t(shapes.size()))]);
    const Pose pose{middle + random_vec(r, -half, half), random_rotation(r)};
    std::vector<QueryTarget> overlapping, holding;
    std::vector<NearHit> near;
    for_all_shapes(
        frame, particles, [&](const QueryTarget& t, const Shape& s, const Pose& at, BodyType) {
          if (overlap(*shape, pose, s, at)) overlapping.push_back(t);
          if (holds_point(s, at, pose.x)) holding.push_back(t);
          auto c = closest_point(s, at, pose.x);
          if (!c) return;
          const bool open =
              s.def().mesh && s.type() == ShapeType::triangle_mesh && !s.mass_properties().ok();
          if (open) c->distance = std::abs(c->distance);
          near.push_back({t, c->distance, c->x_world, c->normal, c->triangle});
        });
    CHECK(answer(scene.overlaps(*shape, pose, filter)) == overlapping);
    CHECK(answer(scene.overlaps_any(*shape, pose, filter)) == !overlapping.empty());
    CHECK(answer(scene.holding(pose.x, filter)) == holding);
    touching += overlapping.size();
    held += holding.size();

    std::sort(near.begin(), near.end(), [](const NearHit& a, const NearHit& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.target < b.target;
    });
    const double reach = i % 2 == 0 ? inf : 0.5 * half;
    const auto found = answer(scene.nearest(pose.x, 4, reach, filter));
    size_t within = 0;
    while (within < near.size() && within < 4 && near[within].distance <= reach) ++within;
    REQUIRE(found.size() == within);
    for (size_t k = 0; k < within; ++k) {
      CHECK(std::abs(found[k].distance - near[k].distance) < 1e-8 * (1 + half));
      CHECK((pose.x - found[k].x_world - found[k].distance * found[k].normal).norm() < 1e-6);
    }
    if (within > 0)
      CHECK(answer(scene.nearest(pose.x, 1, reach, filter))[0].target == found[0].target);
  }
  if (count >= 50) {
    CHECK(ray_hits > size_t(count));
    CHECK(touching > size_t(count) / 4);
    CHECK(held > size_t(count) / 20);
  }
}

}  // namespace

TEST_CASE("rays, overlaps, held points and nearest points against every shape one by one") {
  for (const auto& [n, half, middle] : {std::tuple{30, 3.0, Vec3(0, 0, 0)},
                                        {200, 6.0, Vec3(3, 20, -5)},
                                        {60, 4.0, Vec3(10'000, -200, 10'000)}}) {
    const TestWorld w = crowd(n, half, middle, uint64_t(n));
    compare_with_brute_force(*w.world->queries(), middle, half, scaled(150), 5);
  }
}

TEST_CASE("queries see bodies where the last tick left them, asleep or awake") {
  TestWorld w = crowd(60, 4, Vec3(0, 0, 0), 3);
  const auto before = w->queries();
  CHECK(before == w->queries());
  for (int k = 0; k < 5; ++k) w.step();
  const auto after = w->queries();
  CHECK(after != before);
  CHECK(after->frame().tick == 5);
  compare_with_brute_force(*after, Vec3(0, 0, 0), 4, scaled(60), 6);
  CHECK(before->frame().tick == 0);  // what was asked for earlier stays as it was
  compare_with_brute_force(*before, Vec3(0, 0, 0), 4, scaled(30), 7);

  TestWorld resting;
  resting.ground();
  const BodyId box = resting.box({0, 0.5, 0});
  resting.run(2);
  REQUIRE(resting.body(box).asleep);
  const auto asleep = resting->queries();
  resting.step();
  CHECK(resting->queries() == asleep);  // nothing moved: nothing is built
  const auto hit = answer(asleep->ray({{0, 5, 0}, {0, -1, 0}}));
  REQUIRE(hit);
  CHECK(hit->target.body == box);
  CHECK(hit->distance == doctest::Approx(4).epsilon(1e-3));
  REQUIRE(resting->destroy_body(box).ok());
  resting.apply();
  CHECK(answer(resting->queries()->ray({{0, 5, 0}, {0, -1, 0}}))->distance == doctest::Approx(5));
}

namespace {

/// First t >= 0 at which origin + t direction (unit) is on the triangle; Moeller & Trumbore 1997.
double line_triangle(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b,
                     const Vec3& c) {
  const Vec3 u = b - a, v = c - a, p = direction.cross(v);
  const double det = u.dot(p);
  if (std::abs(det) < 1e-14) return inf;
  const Vec3 s = origin - a, q = s.cross(u);
  const double x = s.dot(p) / det, y = direction.dot(q) / det, t = v.dot(q) / det;
  return x >= 0 && y >= 0 && x + y <= 1 && t >= 0 ? t : inf;
}

/// Distance along the unit ray to a solid of this type, in its frame; the ray starts outside.
double exact_ray(const Shape& shape, const Vec3& o, const Vec3& d) {
  const ShapeDef& def = shape.def();
  const auto ball = [&](const Vec3& centre, double radius) {
    const Vec3 m = o - centre;
    const double b = m.dot(d), disc = b * b - (m.squaredNorm() - radius * radius);
    return disc >= 0 && -b - std::sqrt(disc) >= 0 ? -b - std::sqrt(disc) : inf;
  };
  // Side of an upright cylinder of half height h.
  const auto tube = [&](double radius, double h) {
    const double a = d.x() * d.x() + d.z() * d.z(), b = o.x() * d.x() + o.z() * d.z();
    const double disc = b * b - a * (o.x() * o.x() + o.z() * o.z() - radius * radius);
    if (disc < 0 || a < 1e-14) return inf;
    const double t = (-b - std::sqrt(disc)) / a;
    return t >= 0 && std::abs(o.y() + t * d.y()) <= h ? t : inf;
  };
  double best = inf;
  switch (def.type) {
    case ShapeType::sphere:
      return ball(Vec3::Zero(), def.radius);
    case ShapeType::half_space:
      return d.y() < 0 ? -o.y() / d.y() : inf;
    case ShapeType::capsule:
      return std::min({ball({0, def.height / 2, 0}, def.radius),
                       ball({0, -def.height / 2, 0}, def.radius),
                       tube(def.radius, def.height / 2)});
    case ShapeType::cylinder:
      best = tube(def.radius, def.height / 2);
      for (const double y : {-def.height / 2, def.height / 2}) {
        const double t = (y - o.y()) / d.y();
        const Vec3 x = o + t * d;
        if (t >= 0 && x.x() * x.x() + x.z() * x.z() <= def.radius * def.radius)
          best = std::min(best, t);
      }
      return best;
    case ShapeType::box:
      for (int k = 0; k < 3; ++k)
        for (const double side : {-def.half_extents[k], def.half_extents[k]}) {
          const double t = (side - o[k]) / d[k];
          const Vec3 x = o + t * d;
          bool on = t >= 0;
          for (int j = 0; j < 3; ++j) on &= j == k || std::abs(x[j]) <= def.half_extents[j];
          if (on) best = std::min(best, t);
        }
      return best;
    case ShapeType::triangle_mesh:
      for (const Triangle& t : def.mesh->triangles)
        best = std::min(best, line_triangle(o, d, def.mesh->vertices[t[0]],
                                            def.mesh->vertices[t[1]], def.mesh->vertices[t[2]]));
      return best;
    case ShapeType::convex_hull: {
      // Every triangle of three points that has all others on one side is of the surface.
      const auto& p = def.mesh->vertices;
      for (size_t i = 0; i < p.size(); ++i)
        for (size_t j = i + 1; j < p.size(); ++j)
          for (size_t k = j + 1; k < p.size(); ++k) {
            const Vec3 n = (p[j] - p[i]).cross(p[k] - p[i]);
            double low = 0, high = 0;
            for (const Vec3& x : p) {
              low = std::min(low, n.dot(x - p[i]));
              high = std::max(high, n.dot(x - p[i]));
            }
            if (low > -1e-12 || high < 1e-12)
              best = std::min(best, line_triangle(o, d, p[i], p[j], p[k]));
          }
      return best;
    }
  }
  return best;
}

}  // namespace

TEST_CASE("the nearest hit of a ray by closed forms") {
  const Vec3 middle(5, 1, 2);
  const double half = 4;
  const TestWorld w = crowd(40, half, middle, 9);
  const auto scene = w.world->queries();
  Random r(10);
  int hits = 0;
  const int count = scaled(200);
  for (int i = 0; i < count; ++i) {
    const Vec3 from = middle + 20 * half * random_direction(r).cwiseProduct(Vec3(1, 0.02, 1)) +
                      Vec3(0, 3 * half, 0);
    const Vec3 d = (middle + random_vec(r, -half, half) - from).normalized();
    double nearest = inf;
    bool close_call = false;
    for_all_shapes(
        scene->frame(), true, [&](const QueryTarget&, const Shape& s, const Pose& pose, BodyType) {
          const double t = exact_ray(s, pose.inverse_point(from), pose.inverse_direction(d));
          close_call |= std::abs(t - nearest) < 1e-9;
          nearest = std::min(nearest, t);
        });
    QueryFilter filter;
    filter.particles = true;
    const auto hit = answer(scene->ray({from, 3 * d}, filter));
    REQUIRE(hit.has_value() == (nearest < inf));
    if (!hit || close_call) continue;
    ++hits;
    CHECK(hit->distance == doctest::Approx(nearest).epsilon(1e-9));
  }
  if (count >= 100) CHECK(hits > count / 2);
}

namespace {

/// Signed distance to a convex solid of the types with a closed form, in its frame.
std::optional<double> exact_distance(const Shape& shape, const Vec3& p) {
  const ShapeDef& def = shape.def();
  switch (def.type) {
    case ShapeType::sphere:
      return p.norm() - def.radius;
    case ShapeType::half_space:
      return p.y();
    case ShapeType::capsule:
      return (p - Vec3(0, std::clamp(p.y(), -def.height / 2, def.height / 2), 0)).norm() -
             def.radius;
    case ShapeType::box: {
      const Vec3 out = p.cwiseAbs() - def.half_extents;
      return out.cwiseMax(0.0).norm() + std::min(0.0, out.maxCoeff());
    }
    case ShapeType::cylinder: {
      const double side = std::hypot(p.x(), p.z()) - def.radius;
      const double end = std::abs(p.y()) - def.height / 2;
      return std::hypot(std::max(side, 0.0), std::max(end, 0.0)) +
             std::min(0.0, std::max(side, end));
    }
    default:
      return std::nullopt;
  }
}

/// Particles, and shapes whose distance has a closed form.
QueryFilter only_closed_forms(std::shared_ptr<const QueryScene> scene) {
  QueryFilter filter;
  filter.particles = true;
  filter.accept = [scene = std::move(scene)](const QueryTarget& t) {
    if (t.is_particle()) return true;
    const ShapeDef& def = scene->frame().info(t.body.index).shapes[t.shape].shape->def();
    return def.type != ShapeType::triangle_mesh && def.type != ShapeType::convex_hull;
  };
  return filter;
}

}  // namespace

TEST_CASE("the nearest surface and what a ball touches by closed forms") {
  const TestWorld w = crowd(80, 4, Vec3::Zero(), 12);
  const auto scene = w.world->queries();
  Random r(13);
  const QueryFilter filter = only_closed_forms(scene);
  size_t touched = 0;
  const int count = scaled(300);
  for (int i = 0; i < count; ++i) {
    const Vec3 x = random_vec(r, -5, 5);
    const double radius = r.uniform(0.05, 1);
    double least = inf;
    std::vector<QueryTarget> touching;
    bool close_call = false;
    for_all_shapes(scene->frame(), true,
                   [&](const QueryTarget& t, const Shape& s, const Pose& pose, BodyType) {
                     const auto d = exact_distance(s, pose.inverse_point(x));
                     if (!d) return;
                     least = std::min(least, *d);
                     close_call |= std::abs(*d - radius) < 1e-9;
                     if (*d <= radius) touching.push_back(t);
                   });
    const auto near = answer(scene->nearest(x, 1, inf, filter));
    REQUIRE(near.size() == 1);
    CHECK(std::abs(near[0].distance - least) < 1e-7);
    if (!close_call)
      CHECK(answer(scene->overlaps(*sphere(radius), {x, random_rotation(r)}, filter)) == touching);
    touched += touching.size();
  }
  if (count >= 100) CHECK(touched > size_t(count) / 3);
}

TEST_CASE("a ball that is cast stops at the first of the solids, by bisection of the distance") {
  const TestWorld w = crowd(60, 4, Vec3::Zero(), 21);
  const auto scene = w.world->queries();
  Random r(22);
  const QueryFilter filter = only_closed_forms(scene);
  int hits = 0, free = 0;
  const int count = scaled(300);
  for (int i = 0; i < count; ++i) {
    const double radius = r.uniform(0.02, 0.3);
    const Vec3 from = random_vec(r, -5, 5), way = 8 * random_direction(r);
    double first = inf, least_gap = inf;
    for_all_shapes(scene->frame(), true,
                   [&](const QueryTarget&, const Shape& s, const Pose& pose, BodyType) {
                     if (!exact_distance(s, Vec3::UnitX())) return;
                     const auto gap = [&](double t) {
                       return *exact_distance(s, pose.inverse_point(from + t * way)) - radius;
                     };
                     if (gap(0) <= 0) {
                       first = 0;
                       return;
                     }
                     double a = 0, b = 1;  // where the convex function is least
                     for (int k = 0; k < 200; ++k) {
                       const double u = a + (b - a) / 3, v = b - (b - a) / 3;
                       (gap(u) < gap(v) ? b : a) = gap(u) < gap(v) ? v : u;
                     }
                     least_gap = std::min(least_gap, std::abs(gap(a)));
                     if (gap(a) > 0) return;
                     double lo = 0, hi = a;
                     for (int k = 0; k < 60; ++k)
                       (gap(0.5 * (lo + hi)) > 0 ? lo : hi) = 0.5 * (lo + hi);
                     first = std::min(first, lo);
                   });
    if (least_gap < 1e-4) continue;  // grazing within the tolerance
    CastQuery q;
    q.start.x = from;
    q.translation = way;
    q.tolerance = 1e-6;
    const auto hit = answer(scene->cast(*sphere(radius), q, filter));
    REQUIRE(hit.has_value() == (first < inf));
    first < inf ? ++hits : ++free;
    if (!hit) continue;
    CHECK(hit->fraction <= first + 1e-9);  // never past the contact
    CHECK(hit->fraction > first - 1e-3);   // grazing slopes stretch the tolerance
    if (hit->fraction == 0) continue;
    const Vec3 centre = from + hit->fraction * way;
    CHECK((hit->x_world - centre).norm() == doctest::Approx(radius).epsilon(1e-4));
    CHECK((centre - hit->x_world).normalized().dot(hit->normal) > 1 - 1e-6);
  }
  if (count >= 100) CHECK((hits > count / 4 && free > count / 20));
}

TEST_CASE("shapes of every kind that are cast: as against every shape alone") {
  const TestWorld w = crowd(40, 4, Vec3(0, 0, 0), 31);
  const auto scene = w.world->queries();
  Random r(32);
  int hits = 0, began = 0;
  const int count = scaled(120);
  for (int i = 0; i < count; ++i) {
    const auto shapes = every_shape();
    const auto shape = must(shapes[size_t(i) % shapes.size()]);
    CastQuery q;
    q.start = {random_vec(r, -8, 8), random_rotation(r)};
    q.translation = i % 9 == 0 ? Vec3(0, 0, 0) : random_vec(r, -8, 8);
    q.rotation = i % 2 == 0 ? Vec3(0, 0, 0) : random_vec(r, -2, 2);
    q.hit_at_start = i % 4 != 0;
    QueryFilter filter;
    filter.particles = i % 3 == 0;
    std::vector<CastHit> expected;
    const Motion motion{q.start, q.translation, q.rotation, 0, 1, {}};
    for_all_shapes(scene->frame(), filter.particles,
                   [&](const QueryTarget& t, const Shape& s, const Pose& pose, BodyType) {
                     CastHit h;
                     h.target = t;
                     h.status = TimeOfContactStatus::initially_overlapping;
                     if (!q.hit_at_start || !overlap(*shape, q.start, s, pose)) {
                       const auto toc = time_of_contact(*shape, motion, s,
                                                        Motion::at_rest(pose, 0, 1), q.tolerance);
                       if (toc.status == TimeOfContactStatus::separated) return;
                       h.status = toc.status;
                       if (!toc.hit() && !q.hit_at_start) return;
                       h.fraction = toc.hit() ? toc.time : 0;
                     }
                     expected.push_back(h);
                   });
    std::sort(expected.begin(), expected.end(), [](const CastHit& a, const CastHit& b) {
      return a.fraction != b.fraction ? a.fraction < b.fraction : a.target < b.target;
    });
    const auto all = answer(scene->cast_all(*shape, q, filter));
    REQUIRE(targets_of(all) == targets_of(expected));
    for (size_t k = 0; k < all.size(); ++k) {
      CHECK(std::abs(all[k].fraction - expected[k].fraction) < 1e-6);  // unit quaternions
      CHECK(all[k].status == expected[k].status);
      began += all[k].fraction == 0;
    }
    const auto first = answer(scene->cast(*shape, q, filter));
    REQUIRE(first.has_value() == !all.empty());
    if (!first) continue;
    ++hits;
    CHECK(std::abs(first->fraction - all[0].fraction) < 1e-4);
  }
  if (count >= 100) CHECK((hits > count / 3 && began > 10));
}

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

TEST_CASE("a closed mesh holds what is wholly within; an open one is a surface from either side") {
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

TEST_CASE("many threads ask a fresh scene at once") {
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
