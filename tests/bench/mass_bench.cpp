// Mass properties per triangle beside plain signed tetrahedra (about the world's origin, in the
// order of the triangles, the same ten integrals), and what each is worth: the relative error of
// the volume against twice the digits, at the origin and 100 m from it.
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/moment_sums.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "tests/bench/contest.hpp"

#include <cmath>

using namespace tumble;

namespace {

/// The ten integrals by tetrahedra with their apex at the origin, one triangle after the other.
MassProperties plain_tetrahedra(const TriangleMesh& mesh) {
  double volume6 = 0, m[3] = {0, 0, 0}, own[3] = {0, 0, 0}, mixed[3] = {0, 0, 0};
  for (const Triangle& t : mesh.triangles) {
    const double *a = mesh.vertices[t[0]].data(), *b = mesh.vertices[t[1]].data(),
                 *c = mesh.vertices[t[2]].data();
    const double d = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0]);
    const double s[3] = {a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]};
    volume6 += d;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      m[k] += d * s[k];
      own[k] += d * (a[k] * a[k] + b[k] * b[k] + c[k] * c[k] + s[k] * s[k]);
      mixed[k] += d * (a[k] * a[l] + b[k] * b[l] + c[k] * c[l] + s[k] * s[l]);
    }
  }
  MassProperties out;
  out.mass = volume6 / 6;
  out.centre = Vec3(m[0], m[1], m[2]) / (4 * volume6);
  Mat3 second;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    second(k, k) = own[k] / 120;
    second(k, l) = second(l, k) = mixed[k] / 120;
  }
  second -= out.mass * out.centre * out.centre.transpose();
  out.inertia = second.trace() * Mat3::Identity() - second;
  return out;
}

void compare(const char* name, const TriangleMesh& mesh) {
  const double n = double(mesh.triangles.size());
  const SolidMoments exact = precise_moments(mesh, bounds(mesh).centre());
  const auto error = [&](const MassProperties& m) {
    return std::max(std::fabs(m.mass / exact.volume - 1),
                    (m.inertia - exact.inertia).norm() / exact.inertia.norm());
  };
  const int times = std::max(1, int(2e5 / n));
  double sink = 0;
  const auto repeated = [&](auto f) {
    return [&mesh, &sink, times, f] {
      for (int i = 0; i < times; ++i) sink += f(mesh).mass;
      return f(mesh).mass;
    };
  };
  const std::vector<bench::Candidate> candidates = {
      {"plain signed tetrahedra",
       repeated([](const TriangleMesh& m) { return plain_tetrahedra(m); })},
      {"mesh_integrals", repeated([](const TriangleMesh& m) { return mesh_integrals(m); })},
      {"sum_moments, baseline width", repeated([](const TriangleMesh& m) {
         const Vec3 o = bounds(m).centre();
         return MassProperties{sum_moments(m, o, true).volume6 / 6, o, Mat3::Zero()};
       })}};
  const auto timings = bench::contest(candidates, 15);
  const double errors[] = {error(plain_tetrahedra(mesh)), error(mesh_integrals(mesh)), 0};
  std::printf("%s, %.0f triangles\n", name, n);
  for (size_t i = 0; i < candidates.size(); ++i) {
    std::printf("  %-28s %7.2f ns a triangle, %5.2f x", candidates[i].name.c_str(),
                1e6 * timings[i].milliseconds / n / (times + 1),
                timings[i].milliseconds / timings[0].milliseconds);
    i < 2 ? std::printf(", error %.1e\n", errors[i]) : std::printf("\n");
  }
  const auto whole =
      bench::contest({{"", [&] { return double(check_solid(mesh).faults.size()); }}}, 3);
  std::printf("  %-28s %7.0f ns a triangle\n", "check_solid", 1e6 * whole[0].milliseconds / n);
}

}  // namespace

int main() {
  const TriangleMesh ball = make_mesh::icosphere(0.5, 3),
                     torus = make_mesh::torus(1, 0.3, 350, 100);
  compare("ball at the origin", ball);
  compare("ball 100 m off", transformed(ball, {Vec3(60, -50, 62), Quat::Identity()}));
  compare("torus at the origin", torus);
  compare("torus 100 m off", transformed(torus, {Vec3(60, -50, 62), Quat::Identity()}));
  compare("torus of a million", make_mesh::torus(1, 0.3, 1000, 500));
}
