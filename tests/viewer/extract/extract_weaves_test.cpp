// Cloths and ropes in the picture. References: counts by hand; the normal of a flat sheet; the
// distance of a tube's surface from its line.
#include "viewer/render/extract_weaves.hpp"

#include "engine/dynamics/forces/weave.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

ForceFrame frame_of(const Weave& weave, ParticleSystemId system) {
  ForceFrame out;
  for (const ParticleDef& p : weave.particles) out.points.push_back(p.x);
  out.def = tie(weave, system, 1);
  return out;
}

Weave cloth() {
  ClothDef d;
  d.sheet.corner = Vec3(100, 2, 0);
  d.sheet.columns = 5, d.sheet.rows = 4;
  d.sheet.down = Vec3(0, 0, 0.75);
  d.sheet.stripe = 2;
  auto made = weave_cloth(d);
  REQUIRE(made.ok());
  return *made;
}

}  // namespace

TEST_CASE("a cloth is drawn as a surface seen from both sides, in two colours, without balls") {
  Frame frame;
  frame.forces.push_back(frame_of(cloth(), ParticleSystemId{3, 1}));
  RenderScene scene;
  add_weaves(frame, frame, 1, scene);
  REQUIRE(scene.instances.size() == 2);
  size_t corners = 0;
  for (const MeshInstance& i : scene.instances) {
    CHECK(i.mesh->two_sided);
    corners += i.mesh->indices.size();
    for (const Vec3f& n : i.mesh->normals) CHECK(std::fabs(n.y()) == doctest::Approx(1));
  }
  CHECK(corners == 3 * 2 * 4 * 3);
  const WovenParticles woven(frame);
  CHECK(woven.holds(ParticleSystemId{3, 1}, 1));
  CHECK(woven.holds(ParticleSystemId{3, 1}, 20));
  CHECK_FALSE(woven.holds(ParticleSystemId{3, 1}, 21));
  CHECK_FALSE(woven.holds(ParticleSystemId{2, 1}, 1));
}

TEST_CASE("faces of a cloth go with nodes that are gone, and nodes move between frames") {
  Frame from, to;
  from.forces.push_back(frame_of(cloth(), ParticleSystemId{3, 1}));
  to.forces.push_back(from.forces[0]);
  for (Vec3& x : to.forces[0].points) x.y() += 1;
  to.forces[0].points[0] = Vec3::Constant(std::nan(""));
  RenderScene scene;
  add_weaves(from, to, 0.25, scene);
  size_t corners = 0;
  for (const MeshInstance& i : scene.instances) {
    corners += i.mesh->indices.size();
    CHECK(bounds_of(i).max.y() == doctest::Approx(2.25).epsilon(1e-5));
  }
  CHECK(corners == 3 * (2 * 4 * 3 - 2));
}

TEST_CASE("a rope is a tube of its radius") {
  RopeDef d;
  d.places = {{false, {}, Vec3(0, 1, 0)}, {true, {}, Vec3(2, 1, 0)}};
  d.slack = 1.3;
  d.radius = 0.02;
  auto made = weave_rope(d);
  REQUIRE(made.ok());
  Frame frame;
  ForceFrame force;
  force.points.push_back(Vec3(0, 1, 0));
  for (const ParticleDef& p : made->particles) force.points.push_back(p.x);
  force.def = tie(*made, ParticleSystemId{0, 1}, 1);
  frame.forces.push_back(force);
  RenderScene scene;
  add_weaves(frame, frame, 1, scene);
  REQUIRE(scene.instances.size() == 1);
  const MeshInstance& tube = scene.instances[0];
  CHECK(tube.mesh->positions.size() == 8 * force.points.size());
  for (size_t i = 0; i < tube.mesh->positions.size(); ++i) {
    const Vec3f x = tube.transform.linear * tube.mesh->positions[i] + tube.transform.offset;
    CHECK((x.cast<double>() - force.points[i / 8]).norm() == doctest::Approx(0.02).epsilon(1e-4));
  }
}
