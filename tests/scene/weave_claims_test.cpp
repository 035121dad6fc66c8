// The scenes cloth_over_sphere and rope_bridge. References: the ball's own radius, which no node
// may enter; the sum of the bridge's weights, which its ropes carry at the posts; rest.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>

using namespace tumble;

namespace {

const SpringMesh& mesh_of(const BuiltScene& s, const std::string& name) {
  return *std::get<SpringMeshDef>(*s.world->force(s.forces.at(name))).mesh;
}

/// Where the nodes of a mesh are now.
std::vector<Vec3> nodes_of(const BuiltScene& s, const std::string& name) {
  const auto frame = s.world->frame();
  const auto force = std::ranges::find(frame->forces, s.forces.at(name), &ForceFrame::id);
  REQUIRE(force != frame->forces.end());
  return force->points;
}

/// Most strain of the links of a mesh.
double most_strain(const BuiltScene& s, const std::string& name) {
  const std::vector<Vec3> x = nodes_of(s, name);
  double most = 0;
  for (const SpringMesh::Link& l : mesh_of(s, name).links)
    most = std::max(most, (x[l.b] - x[l.a]).norm() / l.rest_length - 1);
  return most;
}

}  // namespace

TEST_CASE(
    "cloth_over_sphere: it drapes over the ball, rests there, and no part of the ball shows") {
  BuiltScene s = shipped("cloth_over_sphere");
  run(s, 5);
  const ParticleSystem& cloth = *s.world->particles(s.particles.at("cloth"));
  const Vec3 centre = place(s, "ball");
  double speed = 0, nearest = 1, top = 0;
  for (size_t i = 0; i < cloth.size(); ++i) {
    speed = std::max(speed, cloth.v[i].norm());
    nearest = std::min(nearest, (cloth.x[i] - centre).norm() - 0.45);
    top = std::max(top, cloth.x[i].y());
  }
  CHECK(top == doctest::Approx(centre.y() + 0.45 + cloth.radius[0]).epsilon(0.005));
  CHECK(speed < 0.05);
  CHECK(nearest > 0.9 * cloth.radius[0]);
  // Nor do its triangles cut the ball between their nodes.
  const std::vector<Vec3> x = nodes_of(s, "cloth.cloth");
  for (const SpringMesh::Face& face : mesh_of(s, "cloth.cloth").faces) {
    const Vec3 middle = (x[face.node[0]] + x[face.node[1]] + x[face.node[2]]) / 3;
    REQUIRE((middle - centre).norm() > 0.45);
  }
  CHECK(most_strain(s, "cloth.cloth") < 0.15);
}

TEST_CASE("rope_bridge: it carries what falls on it, and hangs still") {
  BuiltScene s = shipped("rope_bridge");
  run(s, 12);
  double fastest = 0, weight = 0;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    CHECK_MESSAGE(b.pose.x.y() > -1.2, name);
    fastest = std::max(fastest, b.v.norm());
    weight += 9.81 * b.mass;
  });
  CHECK(fastest < 0.6);
  CHECK(weight > 1500);
  // The four ropes at their first and last links hold all of it, their own weight included.
  double held = 0;
  for (int k = 0; k < 4; ++k) {
    const std::string name = "ropes.rope[" + std::to_string(k) + "]";
    CHECK(most_strain(s, name) < 0.15);
    const std::vector<Vec3> x = nodes_of(s, name);
    const std::vector<SpringMesh::Link>& links = mesh_of(s, name).links;
    for (const auto& [link, end] : {std::pair{links.front(), 1}, {links.back(), -1}}) {
      const Vec3 along = end * (x[link.b] - x[link.a]);
      const double tension = link.stiffness * (along.norm() - link.rest_length);
      held -= tension * along.normalized().y();
    }
  }
  const ParticleSystem& ropes = *s.world->particles(s.particles.at("ropes"));
  for (const double m : ropes.mass) weight += 9.81 * m;
  CHECK(held == doctest::Approx(weight).epsilon(0.1));
}
