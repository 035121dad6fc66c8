// Mass properties of meshes to 1e-14. Reference: the same integrals over integers of 512 bits
// (Boost.Multiprecision; coordinates lie on a lattice of 2^-40 m), divided with 100 digits: no
// resolution error.
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/moment_sums.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "tests/geometry/exact_reference.hpp"

#include <cstring>
#include <numbers>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

using exact::Int;
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>>;

constexpr double lattice = 0x1p-40;

/// On the lattice, where it is moved without rounding.
TriangleMesh on_lattice(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v = lattice * Vec3((v / lattice).array().round());
  return mesh;
}

TriangleMesh shifted(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

struct ExactMass {
  Real volume;
  std::array<Real, 3> centre;
  std::array<std::array<Real, 3>, 3> inertia;
};

Real real(const Int& x) {
  return Real(x);
}

ExactMass exact_mass(const TriangleMesh& mesh) {
  Int volume = 0;
  std::array<Int, 3> moment{0, 0, 0};
  std::array<std::array<Int, 3>, 3> second{};
  for (const Triangle& t : mesh.triangles) {
    std::array<exact::IntVec, 3> p;
    for (size_t k = 0; k < 3; ++k) {
      for (size_t c = 0; c < 3; ++c) p[k][c] = int64_t(mesh.vertices[t[k]][int(c)] / lattice);
    }
    const Int d = exact::dot(p[0], exact::cross(p[1], p[2]));
    exact::IntVec s;
    for (size_t c = 0; c < 3; ++c) s[c] = p[0][c] + p[1][c] + p[2][c];
    volume += d;
    for (size_t i = 0; i < 3; ++i) {
      moment[i] += d * s[i];
      for (size_t j = 0; j < 3; ++j) {
        second[i][j] +=
            d * (p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j] + s[i] * s[j]);
      }
    }
  }
  ExactMass out;
  const Real unit = lattice;
  out.volume = real(volume) / 6 * unit * unit * unit;
  std::array<std::array<Real, 3>, 3> about;
  for (size_t i = 0; i < 3; ++i) out.centre[i] = real(moment[i]) / (4 * real(volume)) * unit;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      about[i][j] = real(second[i][j]) / 120 * unit * unit * unit * unit * unit -
                    out.volume * out.centre[i] * out.centre[j];
    }
  }
  const Real trace = about[0][0] + about[1][1] + about[2][2];
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) out.inertia[i][j] = (i == j ? trace : Real(0)) - about[i][j];
  }
  return out;
}

/// Errors relative to volume, inertia's norm, and the size sqrt(I / m) of the solid.
struct MassErrors {
  double volume, inertia, centre;
};

MassErrors mass_errors(const MassProperties& m, const ExactMass& e) {
  Real inertia = 0, norm = 0, centre = 0;
  for (size_t i = 0; i < 3; ++i) {
    const Real away = Real(m.centre[int(i)]) - e.centre[i];
    centre += away * away;
    for (size_t j = 0; j < 3; ++j) {
      const Real off = Real(m.inertia(int(i), int(j))) - e.inertia[i][j];
      inertia += off * off;
      norm += e.inertia[i][j] * e.inertia[i][j];
    }
  }
  const Real size = sqrt(sqrt(norm) / abs(e.volume));
  return {double(Real(abs(Real(m.mass) / e.volume - 1))), double(Real(sqrt(inertia / norm))),
          double(Real(sqrt(centre) / size))};
}

/// A closed tube of `sides` around the curve of a (2,3) torus knot.
TriangleMesh knot(int n, int sides, double radius) {
  TriangleMesh mesh = make_mesh::torus(1, radius, n, sides);
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n, dt = 1e-4;
    const auto at = [](double s) {
      const double r = 1 + 0.4 * std::cos(3 * s);
      return Vec3(r * std::cos(2 * s), r * std::sin(2 * s), -0.4 * std::sin(3 * s));
    };
    const Vec3 along = (at(t + dt) - at(t - dt)).normalized();
    const Vec3 u = along.cross(Vec3(0.1, 0.2, 1)).normalized(), v = along.cross(u);
    for (int j = 0; j < sides; ++j) {
      const double a = 2 * std::numbers::pi * j / sides;
      mesh.vertices[size_t(i * sides + j)] = at(t) + radius * (std::cos(a) * u + std::sin(a) * v);
    }
  }
  if (mesh_integrals(mesh).mass < 0) flip(mesh);
  return mesh;
}

struct NamedSolid {
  const char* name;
  TriangleMesh mesh;
};

std::vector<NamedSolid> hard_solids() {
  using namespace make_mesh;
  Random random(410);
  std::vector<NamedSolid> out;
  const auto turned = [&](const TriangleMesh& m) {
    return transformed(m, {Vec3(0.3, 0.2, -0.1), draws::rotation(random)});
  };
  out.push_back({"box", turned(box(Vec3(1, 0.5, 0.25)))});
  out.push_back({"tetrahedron", turned(tetrahedron(1))});
  out.push_back({"ball", icosphere(1, 3)});
  out.push_back({"torus", turned(torus(1, 0.3, 60, 24))});
  out.push_back({"knot", knot(300, 8, 0.12)});
  out.push_back({"thin knot", knot(600, 6, 0.01)});
  out.push_back({"drum", turned(cylinder(0.05, 1, 200))});
  out.push_back({"needle", turned(box(Vec3(1e-4, 1, 1e-4)))});
  out.push_back({"plate", turned(box(Vec3(1, 1e-3, 1)))});
  out.push_back({"foil", turned(box(Vec3(1, 1e-6, 1)))});
  out.push_back({"skin", turned(box(Vec3(1, 1e-9, 1)))});
  TriangleMesh bubble = icosphere(1, 3), hollow = scaled(bubble, Vec3::Constant(1 - 1e-7));
  flip(hollow);
  append(bubble, hollow);
  out.push_back({"bubble", bubble});
  TriangleMesh pair = box(Vec3::Constant(1e-3));  // two small things far apart
  append(pair, transformed(icosphere(1e-3, 1), {Vec3(2, 1, 0), Quat::Identity()}));
  out.push_back({"pair", pair});
  out.push_back({"hull", to_mesh(convex_hull(draws::points(random, 300)).value().polyhedron)});
  for (NamedSolid& s : out) s.mesh = on_lattice(s.mesh);
  return out;
}

}  // namespace

TEST_CASE("mass properties are good to 1e-14 anywhere, for thick, thin, wound and hollow solids") {
  double worst = 0;
  for (const NamedSolid& solid : hard_solids()) {
    CAPTURE(solid.name);
    for (const Vec3& place :
         {Vec3(0, 0, 0), Vec3(1, -1, 2), Vec3(100, 100, -100), Vec3(0, 7000, -7000)}) {
      CAPTURE(place.x());
      const TriangleMesh mesh = shifted(solid.mesh, place);
      const ExactMass exact = exact_mass(mesh);
      const MassProperties m = mesh_integrals(mesh);
      const MassErrors e = mass_errors(m, exact);
      CHECK(e.volume <= 1e-14);
      CHECK(e.inertia <= 1e-14);
      // The centre is rounded to double where it lies.
      const double size = std::sqrt(m.inertia.norm() / std::fabs(m.mass));
      CHECK(e.centre <= 1e-14 + 2e-16 * m.centre.cwiseAbs().maxCoeff() / size);
      worst = std::max({worst, e.volume, e.inertia});
      const Status possible = check_physical(m, 1e-9);
      CHECK(possible.ok());
    }
  }
  MESSAGE("worst relative error of volume and inertia: ", worst);
}

TEST_CASE("which sums are done with twice the digits") {
  const auto rough = [](const TriangleMesh& mesh) {
    const Vec3 origin = bounds(mesh).centre();
    const MomentSums sums = sum_moments(mesh, origin);
    return too_rough(sums, moments_about_centre(sums, origin), origin);
  };
  CHECK_FALSE(rough(make_mesh::box(Vec3(1, 2, 3))));
  CHECK_FALSE(rough(make_mesh::torus(1, 0.3, 60, 24)));
  CHECK_FALSE(rough(knot(300, 8, 0.12)));
  CHECK_FALSE(rough(shifted(knot(300, 8, 0.12), Vec3(100, 200, 300))));
  CHECK(rough(transformed(make_mesh::box(Vec3(1, 1e-6, 1)), {Vec3::Zero(), Quat(0.6, 0.8, 0, 0)})));
  // Both ways agree where both will do.
  const TriangleMesh mesh = knot(300, 8, 0.12);
  const Vec3 origin = bounds(mesh).centre();
  const SolidMoments fast = moments_about_centre(sum_moments(mesh, origin), origin),
                     slow = precise_moments(mesh, origin);
  CHECK(std::fabs(fast.volume / slow.volume - 1) < 1e-14);
  CHECK((fast.inertia - slow.inertia).norm() < 1e-14 * slow.inertia.norm());
}

TEST_CASE("wide and narrow vector instructions give the same bits") {
  for (int n : {3, 7, 20, 64, 1500}) {
    const TriangleMesh mesh = make_mesh::torus(1, 0.3, n, 3);
    const Vec3 origin(0.1, 0.2, 0.3);
    const MomentSums wide = sum_moments(mesh, origin), narrow = sum_moments(mesh, origin, true);
    CHECK(std::memcmp(&wide, &narrow, sizeof(MomentSums)) == 0);
  }
}
