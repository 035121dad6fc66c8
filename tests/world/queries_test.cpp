// Queries on a world. References: the same question put to every shape of the frame one by one by
// the functions of engine/collision (brute force), and closed forms written here: lines against
// balls, boxes and planes, triangles one by one (Moeller & Trumbore), distances to convex solids,
// and where a moving ball first comes that near, by bisection of a convex function.
#include "engine/collision/query.hpp"
#include "tests/world/query_worlds.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

std::vector<QueryTarget> targets_of(const auto& hits) {
  std::vector<QueryTarget> out;
  for (const auto& h : hits) out.push_back(h.target);
  return out;
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
    CHECK(ray_hits > size_t(count) / 2);
    CHECK(touching > size_t(count) / 4);
    CHECK(held > 0);
  }
}

}  // namespace

TEST_CASE("rays, overlaps, held points and nearest points against every shape one by one") {
  for (const auto& [n, half, middle] : {std::tuple{30, 3.0, Vec3(0, 0, 0)},
                                        {200, 6.0, Vec3(3, 20, -5)},
                                        {60, 4.0, Vec3(10'000, -200, 10'000)}}) {
    if (n > 100 && only_to_run()) continue;  // more of the same
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
  CHECK(resting->frame()->body(box.index).jumped);  // said once: from here on it is not new
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
    case ShapeType::ellipsoid: {
      const Vec3 u = o.cwiseQuotient(def.half_extents), w = d.cwiseQuotient(def.half_extents);
      const double a = w.dot(w), b = u.dot(w), disc = b * b - a * (u.dot(u) - 1);
      const double t = disc < 0 ? inf : (-b - std::sqrt(disc)) / a;
      return t >= 0 ? t : inf;
    }
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
    default:
      return ray_by_level(def, o, d);
  }
  return best;
}

}  // namespace

TEST_CASE("the nearest hit of a ray by closed forms" * doctest::test_suite("long")) {
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
    case ShapeType::ellipsoid: {
      // x_i = a_i^2 p_i / (t + a_i^2) on the surface: t by bisection.
      const Vec3 squares = def.half_extents.cwiseProduct(def.half_extents);
      double low = -squares.minCoeff(), high = def.half_extents.maxCoeff() * (1 + p.norm()) * 10;
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 200; ++k) {
        const double t = 0.5 * (low + high);
        x = squares.cwiseProduct(p).cwiseQuotient(squares + Vec3::Constant(t));
        (x.cwiseQuotient(def.half_extents).norm() > 1 ? low : high) = t;
      }
      return p.cwiseQuotient(def.half_extents).norm() < 1 ? -(p - x).norm() : (p - x).norm();
    }
    case ShapeType::cylinder: {
      const double side = std::hypot(p.x(), p.z()) - def.radius;
      const double end = std::abs(p.y()) - def.height / 2;
      return std::hypot(std::max(side, 0.0), std::max(end, 0.0)) +
             std::min(0.0, std::max(side, end));
    }
    default:
      if (shape.symmetry() == ShapeSymmetry::axis) return distance_by_planes(def, p);
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
    return !made_of_mesh(def.type);
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
  const int count = graded_count(300, 60);
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
                     for (int k = 0; k < 80; ++k) {
                       const double u = a + (b - a) / 3, v = b - (b - a) / 3;
                       const bool before = gap(u) < gap(v);
                       (before ? b : a) = before ? v : u;
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
  if (count >= 60) CHECK((hits > count / 4 && free > count / 20));
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
