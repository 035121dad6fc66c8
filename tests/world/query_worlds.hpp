#pragma once
#include "engine/geometry/make_mesh.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

/// Worlds and brute force for the tests of queries.
namespace tumble::test {

/// One definition of every shape type, and a closed and an open mesh.
inline std::vector<ShapeDef> every_shape() {
  Random r(77);
  auto points = std::make_shared<TriangleMesh>();
  for (int i = 0; i < 20; ++i)
    points->vertices.push_back(random_direction(r).cwiseProduct(Vec3(0.5, 0.7, 0.4)));
  const auto torus = std::make_shared<const TriangleMesh>(make_mesh::torus(0.6, 0.25, 20, 10));
  const auto hills = std::make_shared<const TriangleMesh>(
      make_mesh::terrain(2, 6, [](double x, double z) { return 0.2 * x * x - 0.1 * z; }));
  std::vector<ShapeDef> out{{.type = ShapeType::convex_hull, .mesh = points},
                            {.type = ShapeType::triangle_mesh, .mesh = torus},
                            {.type = ShapeType::triangle_mesh, .mesh = hills}};
  for (const auto& solid : every_solid()) out.push_back(solid->def());
  return out;
}

/// `count` bodies of one or two random shapes in a cube of this half side about `middle`, above a
/// tilted half-space and with a system of particles; of every body type. Some were removed again.
inline TestWorld crowd(int count, double half, const Vec3& middle, uint64_t seed) {
  TestWorld w;
  Random r(seed);
  const auto shapes = every_shape();
  BodyDef ground = TestWorld::shape_def({.type = ShapeType::half_space}, middle - Vec3(0, half, 0),
                                        BodyType::fixed);
  ground.pose.q = Quat(1, 0.05, 0, 0.02).normalized();
  w.add(ground);
  std::vector<BodyId> gone;
  for (int i = 0; i < count; ++i) {
    BodyDef def;
    def.type = std::array{BodyType::fixed, BodyType::kinematic, BodyType::dynamic}[r.below(3)];
    def.hull_mass = true;
    def.pose = {middle + random_vec(r, -half, half), random_rotation(r)};
    def.velocity = def.type == BodyType::fixed ? Vec3(0, 0, 0) : random_vec(r, -2, 2);
    for (uint32_t k = 0; k < 1 + r.below(2); ++k) {
      const ShapeDef& shape = shapes[r.below(uint32_t(shapes.size()))];
      if (shape.mesh && !shape.mesh->triangles.empty() && def.type == BodyType::dynamic) continue;
      def.shapes.push_back({shape, {random_vec(r, -0.4, 0.4), random_rotation(r)}, {}});
    }
    if (def.shapes.empty()) def.shapes.push_back({shapes.back(), {}, {}});
    auto id = w->create_body(def);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    if (r.below(8) == 0) gone.push_back(*id);
  }
  ParticleSystemDef dust;
  for (int i = 0; i < count; ++i)
    dust.particles.push_back(
        {.x = middle + random_vec(r, -half, half), .radius = r.uniform(0.05, 0.3)});
  REQUIRE(w->create_particles(dust).ok());
  w.apply();
  for (const BodyId id : gone) REQUIRE(w->destroy_body(id).ok());
  w.apply();
  return w;
}

/// Calls f(target, shape, pose, type) for every shape of the frame, and for every particle as a
/// ball.
template <class F>
void for_all_shapes(const Frame& frame, bool particles, const F& f) {
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null()) continue;
    const BodyInfo& info = frame.info(slot);
    for (uint32_t k = 0; k < info.shapes.size(); ++k)
      f(QueryTarget{info.id, k, {}, 0}, *info.shapes[k].shape,
        frame.body(slot).pose * info.shapes[k].pose, info.type);
  }
  if (!particles) return;
  for (const auto& system : frame.particles)
    for (uint32_t i = 0; i < system->x.size(); ++i)
      f(QueryTarget{{}, 0, system->id, i}, *sphere(system->radius[i]),
        Pose{system->x[i], Quat::Identity()}, BodyType::dynamic);
}

/// What must answer, or the test fails.
template <class T>
T answer(Result<T> r) {
  REQUIRE_MESSAGE(r.ok(), test::why_not(r));
  return std::move(r).value();
}

inline Ray random_ray(Random& r, const Vec3& middle, double half) {
  const Vec3 from = middle + random_vec(r, -1.5 * half, 1.5 * half);
  const Vec3 to = middle + random_vec(r, -half, half);
  return {from, (to - from) * r.uniform(0.1, 3)};
}

}  // namespace tumble::test
