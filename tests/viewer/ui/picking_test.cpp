// Reference: marching along the ray through the signed distances of spheres and boxes, written here
// independently of the shapes' own ray casts; resolution of the march 1e-6 m.
#include "viewer/interact/picking.hpp"

#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

double signed_distance(const ShapeDef& shape, const Vec3& p) {
  if (shape.type == ShapeType::sphere) return p.norm() - shape.radius;
  const Vec3 q = p.cwiseAbs() - shape.half_extents;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

struct Marched {
  BodyId body;
  double t = 0;
};

std::optional<Marched> march(const Frame& frame, const Ray& ray, double t_max) {
  double t = 0;
  while (t < t_max) {
    double nearest = 1e9;
    BodyId id;
    for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
      if (frame.body(slot).id.is_null()) continue;
      for (const BodyShape& part : frame.info(slot).shapes) {
        const Pose pose = frame.body(slot).pose * part.pose;
        const double d =
            signed_distance(part.shape->def(), pose.inverse_point(ray.origin + t * ray.direction));
        if (d < nearest) {
          nearest = d;
          id = frame.body(slot).id;
        }
      }
    }
    if (nearest < 1e-6) return Marched{id, t};
    t += nearest;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("picking finds what a march along the ray finds") {
  TestWorld w;
  Random random(7);
  const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  for (int i = 0; i < 40; ++i) {
    const double x = draw(-4, 4), y = draw(-4, 4), z = draw(-4, 4);
    BodyDef def = i % 2 ? TestWorld::sphere_def({x, y, z}, draw(0.2, 0.7))
                        : TestWorld::box_def({x, y, z}, {draw(0.1, 0.6), draw(0.1, 0.6), 0.4});
    const double qx = draw(-1, 1), qy = draw(-1, 1), qz = draw(-1, 1);
    def.pose.q = Quat(0.6, qx, qy, qz).normalized();
    (void)w.add(def);
  }
  const auto frame = w->frame();
  const int rays = scaled(400);
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    const double ox = draw(-1, 1), oy = draw(-1, 1), oz = draw(-1, 1);
    const double tx = draw(-4, 4), ty = draw(-4, 4), tz = draw(-4, 4);
    Ray ray;
    ray.origin = 12 * Vec3(ox, oy, oz + 1e-3).normalized();
    ray.direction = (Vec3(tx, ty, tz) - ray.origin).normalized();
    const auto expected = march(*frame, ray, 30);
    const auto found = pick(*frame, *frame, 1, ray, 30);
    REQUIRE(found.has_value() == expected.has_value());
    if (!found) continue;
    ++hits;
    CHECK(found->body == expected->body);
    CHECK(std::abs(found->distance - expected->t) < 1e-4);
    // The point in the body's frame leads back to the point in the world.
    const auto slot = find_slot(*frame, found->body);
    REQUIRE(slot);
    const Vec3 back =
        frame->body(*slot).pose.point(found->point_body - frame->info(*slot).centre_body);
    CHECK((back - found->x_world).norm() < 1e-9);
    CHECK(found->normal.dot(ray.direction) < 1e-9);
  }
  CHECK(hits > rays / 5);
  CHECK(hits < rays * 19 / 20);
}

TEST_CASE("a body around the eye is looked through, and a lost body is not found") {
  TestWorld w;
  const BodyId around = w.add(TestWorld::sphere_def({0, 0, 0}, 3));
  const BodyId ahead = w.add(TestWorld::sphere_def({0, 0, -10}, 1));
  auto frame = w->frame();
  const Ray ray{Vec3::Zero(), Vec3(0, 0, -1)};
  auto found = pick(*frame, *frame, 1, ray);
  REQUIRE(found);
  CHECK(found->body == ahead);
  CHECK(found->distance == doctest::Approx(9));
  REQUIRE(w->destroy_body(ahead).ok());
  REQUIRE(w->apply_commands().ok());
  frame = w->frame();
  CHECK_FALSE(pick(*frame, *frame, 1, ray));
  CHECK_FALSE(find_slot(*frame, ahead));
  CHECK(find_slot(*frame, around));
}

TEST_CASE("a picker in a picture that stands still finds the same, and follows what moves again") {
  TestWorld w;
  Random random(8);
  const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  w.ground();
  for (int i = 0; i < 40; ++i) {
    BodyDef def = i % 2 ? TestWorld::sphere_def({draw(-4, 4), draw(1, 8), draw(-4, 4)}, 0.5)
                        : TestWorld::box_def({draw(-4, 4), draw(1, 8), draw(-4, 4)});
    def.look.visible = i % 5 != 0;
    def.shapes[0].pose.x = {0.1, 0.2, 0};
    (void)w.add(def);
  }
  Picker picker;
  auto from = w->frame();
  for (int tick = 0; tick < 4; ++tick) {
    const auto to = w->frame();
    for (int i = 0; i < scaled(100); ++i) {
      Ray ray;
      ray.origin = {draw(-9, 9), draw(-1, 9), draw(-9, 9)};
      ray.direction = (Vec3(draw(-4, 4), draw(0, 8), draw(-4, 4)) - ray.origin).normalized();
      const double s = draw(0, 1);
      const auto expected = pick(*from, *to, s, ray), found = picker(from, to, s, ray);
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      CHECK(found->body == expected->body);
      CHECK(found->slot == expected->slot);
      CHECK(found->shape == expected->shape);
      CHECK(found->type == expected->type);
      CHECK(found->distance == doctest::Approx(expected->distance).epsilon(1e-9));
      CHECK((found->point_body - expected->point_body).norm() < 1e-9);
      CHECK((found->normal - expected->normal).norm() < 1e-9);
    }
    w.step();
    from = tick % 2 == 0 ? to : w->frame();  // in motion, and paused
  }
}
