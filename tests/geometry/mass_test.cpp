// Mass properties. References: closed forms of polyhedra (box, tetrahedron, prism, torus solid),
// limits of fine meshes, covariance under motion, and Eigen's eigen-solver for principal axes.
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/moment_sums.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/math/det/det.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/support/dense3.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

void check_near(const MassProperties& a, const MassProperties& b, double relative) {
  const double size = std::sqrt(b.inertia.norm() / b.mass);
  CHECK(std::fabs(a.mass - b.mass) <= relative * b.mass);
  CHECK((a.centre - b.centre).norm() <= relative * size);
  CHECK((a.inertia - b.inertia).norm() <= relative * b.inertia.norm());
}

void check_refused(const TriangleMesh& mesh, const char* why, const char* edge = "") {
  const auto m = mesh_mass(mesh);
  REQUIRE_FALSE(m.ok());
  CHECK_MESSAGE(m.error().message.find(why) != std::string::npos, m.error().text());
  CHECK_MESSAGE(m.error().message.find(edge) != std::string::npos, m.error().text());
}

}  // namespace

TEST_CASE("meshes with closed forms, moved and turned, to 1e-12") {
  Random random(80);
  for (int i = 0; i < draws::count(200); ++i) {
    const Pose pose{draws::in_box(random, 10), draws::rotation(random)};
    const Vec3 half{random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
    const double density = random.uniform(1, 8000);
    const auto box = mesh_mass(transformed(make_mesh::box(half), pose), density);
    REQUIRE(box.ok());
    check_near(*box, moved(box_mass(half, density), pose), 1e-13);

    // Regular tetrahedron of edge a: V = a^3 / (6 sqrt 2), I = m a^2 / 20.
    const double r = random.uniform(0.1, 2), a = r * std::sqrt(8.0 / 3.0);
    MassProperties tetrahedron{a * a * a / (6 * std::sqrt(2.0)), pose.x, Mat3::Identity()};
    tetrahedron.inertia *= tetrahedron.mass * a * a / 20;
    const auto t = mesh_mass(transformed(make_mesh::tetrahedron(r), pose));
    REQUIRE(t.ok());
    check_near(*t, tetrahedron, 1e-12);

    const int n = 3 + int(random.below(20)), k = 3 + int(random.below(20));
    const auto torus = mesh_mass(transformed(make_mesh::torus(2, 0.5, n, k), pose));
    REQUIRE(torus.ok());
    CHECK(torus->mass == doctest::Approx(make_mesh::torus_volume(2, 0.5, n, k)).epsilon(1e-12));
    CHECK((torus->centre - pose.x).norm() < 1e-12);
    const auto prism = mesh_mass(transformed(make_mesh::cylinder(0.7, 0.5, n), pose));
    REQUIRE(prism.ok());
    CHECK(prism->mass == doctest::Approx(make_mesh::cylinder_volume(0.7, 0.5, n)).epsilon(1e-12));
  }
}

TEST_CASE("a general tetrahedron against Tonon's closed form") {
  // F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor" (2004): the worked
  // example of the paper.
  TriangleMesh m;
  m.vertices = {Vec3(8.33220, -11.86875, 0.93355), Vec3(0.75523, 5.00000, 16.37072),
                Vec3(52.61236, 5.00000, -5.38580), Vec3(2.00000, 5.00000, 3.00000)};
  m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  if (mesh_integrals(m).mass < 0) flip(m);
  const auto p = mesh_mass(m);
  REQUIRE(p.ok());
  CHECK((p->centre - Vec3(15.92492, 0.78281, 3.72962)).norm() < 1e-4);
  CHECK(p->inertia(0, 0) / 43520.33257 == doctest::Approx(1).epsilon(1e-6));
  CHECK(p->inertia(1, 1) / 194711.28938 == doctest::Approx(1).epsilon(1e-6));
  CHECK(p->inertia(2, 2) / 191168.76173 == doctest::Approx(1).epsilon(1e-6));
  CHECK(std::fabs(p->inertia(1, 2)) == doctest::Approx(4417.66150).epsilon(1e-6));
  CHECK(std::fabs(p->inertia(0, 1)) == doctest::Approx(11996.20119).epsilon(1e-6));
  CHECK(std::fabs(p->inertia(0, 2)) == doctest::Approx(46343.16662).epsilon(1e-6));
}

TEST_CASE("a hundred metres from the origin costs a mesh no accuracy but its coordinates'") {
  const TriangleMesh mesh = make_mesh::icosphere(0.5, 3);
  const MassProperties here = mesh_integrals(mesh);
  const Vec3 far(128, -64, 256);  // exact for these coordinates up to 2^-46
  const auto there = mesh_mass(transformed(mesh, {far, Quat::Identity()}));
  REQUIRE(there.ok());
  check_near(*there, {here.mass, here.centre + far, here.inertia}, 3e-13);
}

TEST_CASE("a large thin pane among thousands of small triangles keeps its digits") {
  Random random(81);
  for (int i = 0; i < 12; ++i) {
    // Wherever its twelve triangles stand among those of the ball.
    TriangleMesh mesh =
        transformed(make_mesh::icosphere(0.02, 4), {Vec3(0.3, 1.5, 0), Quat::Identity()});
    const double half = std::pow(10, -3 - i % 4);
    append(mesh,
           transformed(make_mesh::box(Vec3(1, 1, half)), {Vec3::Zero(), draws::rotation(random)}));
    std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 7 * i, mesh.triangles.end());
    const SolidMoments expected = precise_moments(mesh, bounds(mesh).centre());
    const MassProperties got = mesh_integrals(mesh);
    CHECK(std::fabs(got.mass - expected.volume) <= 1e-14 * expected.volume);
    CHECK((got.inertia - expected.inertia).norm() <= 1e-14 * expected.inertia.norm());
  }
}

TEST_CASE("closed forms of round solids are the limits of fine meshes, at second order") {
  double last[3] = {0, 0, 0};
  for (int n = 16; n <= 128; n *= 2) {
    const auto error = [](const MassProperties& a, const MassProperties& b) {
      return std::max(std::fabs(a.mass / b.mass - 1),
                      (a.inertia - b.inertia).norm() / b.inertia.norm());
    };
    const double e[3] = {
        error(mesh_integrals(make_mesh::cylinder(0.6, 0.4, n)), cylinder_mass(0.6, 0.4)),
        error(mesh_integrals(make_mesh::capsule(0.6, 0.4, n, n / 4)), capsule_mass(0.6, 0.4)),
        error(mesh_integrals(make_mesh::capsule(0, 0.4, n, n / 4)), sphere_mass(0.4))};
    for (int k = 0; k < 3; ++k) {
      if (n > 16) CHECK(last[k] / e[k] == doctest::Approx(4).epsilon(0.1));
      last[k] = e[k];
    }
  }
}

TEST_CASE("closed forms of cone, ellipsoid, torus and tetrahedron against meshes") {
  Random random(82);
  double last[2] = {0, 0};
  for (int n = 16; n <= 128; n *= 2) {
    TriangleMesh cone = make_mesh::cylinder(0.6, 0.4, n);
    for (Vec3& v : cone.vertices) {
      if (v.y() > 0) v = Vec3(0, 0.6, 0);
    }
    const MassProperties fine_cone = mesh_integrals(cone),
                         fine_torus = mesh_integrals(make_mesh::torus(1, 0.3, n, n));
    const MassProperties c = cone_mass(0.6, 0.4), t = torus_mass(1, 0.3);
    CHECK(fine_cone.centre.y() == doctest::Approx(c.centre.y()).epsilon(1e-12));
    const double e[2] = {(fine_cone.inertia - c.inertia).norm() / c.inertia.norm(),
                         (fine_torus.inertia - t.inertia).norm() / t.inertia.norm()};
    for (int k = 0; k < 2; ++k) {
      if (n > 16) CHECK(last[k] / e[k] == doctest::Approx(4).epsilon(0.1));
      last[k] = e[k];
    }
  }
  // A stretched ball: an affine image, of which second moments are known from the ball's.
  const MassProperties e = ellipsoid_mass(Vec3(1, 2, 3)), ball = sphere_mass(1);
  CHECK(e.mass == doctest::Approx(6 * ball.mass));
  CHECK(e.inertia(0, 0) == doctest::Approx(6 * ball.inertia(0, 0) / 2 * (4 + 9)));
  CHECK(ellipsoid_mass(Vec3::Constant(0.7)).inertia.isApprox(sphere_mass(0.7).inertia));
  for (int i = 0; i < draws::count(200); ++i) {
    TriangleMesh m;
    for (int k = 0; k < 4; ++k) m.vertices.push_back(draws::in_box(random, 1));
    m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    if (mesh_integrals(m).mass < 0) flip(m);
    const MassProperties form =
        tetrahedron_mass(m.vertices[0], m.vertices[1], m.vertices[2], m.vertices[3]);
    const double aspect = std::cbrt(form.mass);  // flat ones lose digits in the closed form
    check_near(mesh_integrals(m), form, 1e-14 / (aspect * aspect * aspect));
  }
}

TEST_CASE("what no body can have is refused") {
  CHECK(check_physical(box_mass(Vec3(1, 2, 3))).ok());
  CHECK(check_physical(box_mass(Vec3(1, 2, 1e-9))).ok());  // a plate: I3 = I1 + I2
  const auto refused = [](const MassProperties& m, const char* why) {
    const Status s = check_physical(m);
    REQUIRE_FALSE(s.ok());
    CHECK_MESSAGE(s.error().message.find(why) != std::string::npos, s.error().text());
  };
  refused({0, Vec3::Zero(), Mat3::Identity()}, "mass must be > 0");
  refused({1, Vec3::Zero(), Vec3(1, 1, 2.1).asDiagonal()}, "sum of the other two");
  refused({1, Vec3::Zero(), Vec3(-1, 1, 1).asDiagonal()}, "negative");
  refused({1, Vec3(NAN, 0, 0), Mat3::Identity()}, "not finite");
  Mat3 skew = Mat3::Identity();
  skew(0, 1) = 0.1;
  refused({1, Vec3::Zero(), skew}, "not symmetric");
}

TEST_CASE("compounds equal the whole: a box cut into parts, about any point") {
  const Vec3 half(1, 0.5, 0.25);
  std::vector<MassProperties> parts;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
    parts.push_back(
        moved(box_mass(0.5 * half, 3), {0.5 * half.cwiseProduct(sign), Quat::Identity()}));
  }
  check_near(compound(parts), box_mass(half, 3), 1e-14);
  const MassProperties whole = box_mass(half, 3);
  // A rod about its end: m l^2 / 3.
  const MassProperties rod = box_mass(Vec3(1, 1e-9, 1e-9), 1);
  CHECK(inertia_about(rod, Vec3(1, 0, 0))(1, 1) == doctest::Approx(rod.mass * 4 / 3));
  CHECK(inertia_about(whole, whole.centre).isApprox(whole.inertia));
  CHECK(compound({}).mass == 0);
}

TEST_CASE("meshes without a defined inside are refused with their edges") {
  TriangleMesh open = make_mesh::box(Vec3::Ones());
  open.triangles.pop_back();
  check_refused(open, "not closed: 3 open edges", "(vertices 4-6 4-7 6-7)");
  TriangleMesh inside_out = make_mesh::box(Vec3::Ones());
  flip(inside_out);
  check_refused(inside_out, "inside-out");
  TriangleMesh turned = make_mesh::box(Vec3::Ones());
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  check_refused(turned, "not consistently oriented: 3 misoriented edges", "0-4");
  TriangleMesh fins = make_mesh::tetrahedron(1);
  fins.vertices.push_back(Vec3(2, 2, 2));
  fins.triangles.push_back({0, 1, 4});
  check_refused(fins, "1 non-manifold edge", "0-1");
  TriangleMesh sheet;  // both sides of one triangle
  sheet.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  check_refused(sheet, "no volume");
  check_refused({}, "no triangles");
}

TEST_CASE("principal axes against Eigen, with repeated moments and tiny differences") {
  Random random(81);
  for (int i = 0; i < draws::count(5000); ++i) {
    const double a = random.uniform(1, 2);
    Vec3 moments{a, a + random.uniform(), a + random.uniform()};
    if (i % 4 == 1) moments.y() = moments.x();
    if (i % 4 == 2) moments = Vec3::Constant(a);
    if (i % 4 == 3) moments.y() = moments.x() * (1 + 1e-10);
    moments *= std::pow(10.0, random.uniform(-8, 8));
    const Mat3 r = draws::rotation(random).toRotationMatrix();
    Mat3 inertia = r * moments.asDiagonal() * r.transpose();
    inertia = (0.5 * (inertia + inertia.transpose()));
    const PrincipalAxes p = principal_axes(inertia);
    const Vec3 expected = symmetric_eigenvalues(inertia);
    const double size = moments.maxCoeff();
    CHECK((p.moments - expected).norm() < 1e-14 * size);
    CHECK((p.axes * p.moments.asDiagonal() * p.axes.transpose() - inertia).norm() < 2e-14 * size);
    CHECK((p.axes.transpose() * p.axes - Mat3::Identity()).norm() < 1e-15 * 10);
    CHECK(p.axes.determinant() == doctest::Approx(1));
    CHECK((p.rotation.toRotationMatrix() - p.axes).norm() < 1e-14);
    CHECK(p.rotation.w() >= 0);
  }
  const PrincipalAxes diagonal = principal_axes(Vec3(3, 1, 2).asDiagonal());
  CHECK(diagonal.moments == Vec3(1, 2, 3));
  CHECK(diagonal.axes.col(0) == Vec3::UnitY());
  CHECK(principal_axes(Mat3::Zero()).moments == Vec3::Zero());
}
