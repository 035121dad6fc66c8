// Heaps of triangle meshes at 60 Hz. References: overlap measured apart from the narrow phase, by
// rays and distances of points on the surfaces (tests/support/mesh_overlap.hpp; spacing 1/20 of the
// radius, so that a few tenths of a millimetre are missed); the speed of free fall from the highest
// start.
#include "engine/geometry/make_mesh.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/support/mesh_overlap.hpp"

#include <map>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Probes by shape, made once.
class Probes {
 public:
  /// Greatest overlap of any two bodies made of one triangulated shape each [m].
  double worst(const RigidWorld& w) {
    double deepest = 0;
    for (size_t i = 0; i < w.bodies.size(); ++i)
      for (size_t j = i + 1; j < w.bodies.size(); ++j) {
        const RigidBody &a = w.bodies[i], &b = w.bodies[j];
        if (!a.dynamic() && !b.dynamic()) continue;
        const OverlapProbe *pa = probe(a), *pb = probe(b);
        if (!pa || !pb) continue;
        if ((a.pose.x - b.pose.x).norm() > a.bounding_radius + b.bounding_radius) continue;
        deepest = std::max(deepest,
                           overlap(*pa, a.pose * a.shapes[0].pose, *pb, b.pose * b.shapes[0].pose));
      }
    return deepest;
  }

 private:
  const OverlapProbe* probe(const RigidBody& b) {
    const ShapeDef& def = b.shapes[0].shape->def();
    if (def.type != ShapeType::triangle_mesh || !def.mesh) return nullptr;
    auto& p = probes_[def.mesh.get()];
    if (!p) p = std::make_unique<OverlapProbe>(*def.mesh, 0.05 * b.bounding_radius);
    return p.get();
  }
  std::map<const TriangleMesh*, std::unique_ptr<OverlapProbe>> probes_;
};

ShapeDef shared_mesh(std::shared_ptr<const TriangleMesh> triangles) {
  ShapeDef s;
  s.type = ShapeType::triangle_mesh;
  s.mesh = std::move(triangles);
  return s;
}

Quat random_rotation(Random& r) {
  return axis_angle(Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1) + 1e-9),
                    r.uniform(0, 6));
}

/// Highest kinetic plus potential energy per mass of a body, as a speed of fall [m/s].
double fall_speed(const RigidWorld& w) {
  double height = 0;
  for (const RigidBody& b : w.bodies)
    if (b.dynamic()) height = std::max(height, b.pose.x.y());
  return std::sqrt(2 * w.gravity.norm() * height);
}

double greatest_speed(const RigidWorld& w) {
  double v = 0;
  for (const RigidBody& b : w.bodies)
    if (b.dynamic()) v = std::max(v, b.v.norm());
  return v;
}

/// A box without lid, open above, of half width `half`.
void add_bin(RigidWorld& w, double half, double height) {
  w.floor();
  for (const double side : {-1.0, 1.0}) {
    w.fixed(box(0.5, height, half + 1), {side * (half + 0.5), height, 0});
    w.fixed(box(half + 1, height, 0.5), {0, height, side * (half + 0.5)});
  }
}

void check_inside(const RigidWorld& w, double half) {
  for (const RigidBody& b : w.bodies) {
    if (!b.dynamic()) continue;
    CHECK(std::abs(b.pose.x.x()) < half);
    CHECK(std::abs(b.pose.x.z()) < half);
    CHECK(b.pose.x.y() > 0);
  }
}

}  // namespace

TEST_CASE("a heap of tori settles without overlap or locked pairs") {
  const int count = scaled(60, 12);
  RigidWorld w;
  add_bin(w, 2, 8);
  const auto torus = std::make_shared<const TriangleMesh>(make_mesh::torus(0.5, 0.2, 24, 12));
  Random r(99);
  for (int i = 0; i < count; ++i) {
    BodyDef d =
        body(shared_mesh(torus), {(i % 2 - 0.5) * 1.6, 1 + 1.6 * (i / 4), (i / 2 % 2 - 0.5) * 1.6});
    d.pose.q = random_rotation(r);
    w.add(d);
  }
  const double limit = 1.05 * fall_speed(w);
  Probes probes;
  for (int second = 0; second < 8; ++second) {
    w.run(1);
    CHECK(greatest_speed(w) < limit);
  }
  CHECK(probes.worst(w) < 0.004);
  CHECK(greatest_speed(w) < 0.3);
  check_inside(w, 2);
}
