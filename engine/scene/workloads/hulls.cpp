#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/workloads/definitions.hpp"
#include "engine/scene/workloads/draws.hpp"
#include "engine/scene/workloads/parts.hpp"

namespace tumble {
namespace {

/// Principal axes of an inertia tensor as columns: cyclic Jacobi rotations, each by half of
/// atan2(2 A_ab, A_aa - A_bb). The order and the signs that it leaves are part of the definition,
/// since a body's orientation is drawn for this frame.
Mat3 principal_frame(Mat3 A) {
  Mat3 axes = Mat3::Identity();
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (std::abs(A(a, b)) < 1e-15) continue;
      const double turn = 0.5 * det::atan2(2 * A(a, b), A(a, a) - A(b, b));
      Mat3 J = Mat3::Identity();
      J(a, a) = J(b, b) = det::cos(turn);
      J(b, a) = det::sin(turn);
      J(a, b) = -J(b, a);
      A = (J.transpose() * A * J);
      axes = (axes * J);
    }
  }
  return axes;
}

std::vector<Vec3> drawn_points(WorkloadDraws& draws) {
  std::vector<Vec3> points(size_t(8 + int(draws.unit() * 17)));
  for (Vec3& p : points) {
    p = draws.direction();
    p *= draws.between(0.42, 0.5);
  }
  return points;
}

/// The hull's vertices in the frame of its centre of mass and principal axes.
std::shared_ptr<const TriangleMesh> in_principal_frame(const ConvexPolyhedron& hull) {
  const MassProperties mass = polyhedron_mass(hull, 1000);
  const Mat3 axes = principal_frame(mass.inertia);
  auto out = std::make_shared<TriangleMesh>();
  for (const Vec3& v : hull.vertices) out->vertices.push_back(axes.transpose() * (v - mass.centre));
  return out;
}

}  // namespace

/// W3: hulls of 8 to 24 points between two spheres fall into a bin.
Workload hulls_workload(bool small) {
  const int side = small ? 4 : 10, count = small ? 100 : 2000;
  Workload w;
  w.steps = 600;
  add_bin(w, 0.6 * side, 3.0 * side + 10);
  WorkloadDraws draws(12345);
  for (int i = 0; i < count; ++i) {
    ShapeDef shape;
    shape.type = ShapeType::convex_hull;
    shape.mesh = in_principal_frame(convex_hull(drawn_points(draws)).value().polyhedron);
    BodyDef body;
    body.shapes.push_back({std::move(shape), {}, {}});
    body.pose = {layered_place(i, side, 1.15, 1), draws.orientation()};
    w.bodies.push_back(std::move(body));
  }
  return w;
}

}  // namespace tumble
