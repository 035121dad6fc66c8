// How grains flow and heap up, in lengths of their diameter. References: the run-out of columns
// (Lube, Huppert, Sparks, Hallworth, JFM 508, 2004), the discharge of bins through a hole
// (Beverloo, Leniger, van de Velde, Chem. Eng. Sci. 15, 1961), and what the angle of repose
// depends on (Zhou, Wright, Yang, Xu, Yu, Physica A 269, 1999).
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

constexpr double g = 9.81, pi = std::numbers::pi;
constexpr double d = 0.008;      ///< diameter of a grain [m]
constexpr double packing = 0.6;  ///< share of a heap that is grains [-]
constexpr double glass = 2500;   ///< density [kg/m3]
constexpr double grain_volume = pi / 6 * d * d * d;

WorldSettings realtime() {
  WorldSettings s;
  s.stepper = "realtime";
  return s;
}

/// Boxes side by side around the y axis, whose inner faces are `inner` from it.
BodyDef ring(double inner, double thickness, double low, double high, double friction) {
  constexpr int count = 32;
  BodyDef def;
  def.type = BodyType::fixed;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * pi * k / count;
    BodyShapeDef panel;
    panel.shape.type = ShapeType::box;
    panel.shape.half_extents = {0.5 * thickness, 0.5 * (high - low),
                                (inner + thickness) * std::tan(pi / count)};
    panel.pose.q = axis_angle(Vec3::UnitY(), angle);
    panel.pose.x = panel.pose.q * Vec3(inner + 0.5 * thickness, 0, 0);
    panel.pose.x.y() = 0.5 * (low + high);
    panel.material.friction = friction;
    def.shapes.push_back(panel);
  }
  return def;
}

/// A column of loose grains about the y axis, which will settle to `height`.
ParticleSystemDef column(double radius, double height, const GrainDef& grains, double friction,
                         double density = glass) {
  ParticleSystemDef def;
  def.name = "grains";
  def.grains = grains;
  def.friction = friction;
  def.restitution = 0.1;
  Random random(1);
  // Loose and in disorder, or it would stand as the lattice that it is.
  const double spacing = 1.2 * d, most = radius - 0.65 * d;
  const auto jitter = [&random] { return random.uniform(-0.09, 0.09) * d; };
  const auto wanted = size_t(packing * pi * radius * radius * height / grain_volume);
  for (int layer = 0; def.particles.size() < wanted; ++layer)
    for (double x = -most; x <= most; x += spacing)
      for (double z = -most; z <= most; z += spacing) {
        if (std::hypot(x, z) > most || def.particles.size() == wanted) continue;
        ParticleDef p;
        p.radius = 0.5 * d;
        p.mass = density * grain_volume;
        const double jx = jitter(), jy = jitter(), jz = jitter();
        p.x = {x + jx, 0.65 * d + spacing * layer + jy, z + jz};
        const double vx = random.uniform(-0.3, 0.3), vz = random.uniform(-0.3, 0.3);
        p.v = {vx, 0, vz};
        def.particles.push_back(p);
      }
  return def;
}

ParticleSystemId add(TestWorld& w, ParticleSystemDef def) {
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

/// Thickness of what lies in rings of one diameter's width about the y axis, above y = 0 [m].
std::vector<double> thickness(const ParticleSystem& p) {
  std::vector<double> out;
  for (const Vec3& x : p.x) {
    if (x.y() < 0) continue;
    const auto k = size_t(std::hypot(x.x(), x.z()) / d);
    if (k >= out.size()) out.resize(k + 1);
    out[k] += grain_volume / packing / (pi * d * d * double(2 * k + 1));
  }
  return out;
}

/// The straight line through the thicknesses of a heap from `first` [m] out, where it is thicker
/// than 0.6 diameters and thinner than 0.6 of its top.
struct Slope {
  double edge;   ///< distance from the axis at which it comes down to 0 [m]
  double angle;  ///< below the horizontal [rad]
};
Slope slope_of(const std::vector<double>& heap, double first) {
  double top = 0;
  for (size_t k = 1; k < heap.size(); ++k) top = std::max(top, heap[k]);
  double n = 0, sr = 0, sh = 0, srr = 0, srh = 0;
  for (size_t k = 0; k < heap.size(); ++k) {
    const double r = d * (double(k) + 0.5), h = heap[k];
    if (r < first || h < 0.6 * d || h > 0.6 * top) continue;
    n += 1, sr += r, sh += h, srr += r * r, srh += r * h;
  }
  REQUIRE(n >= 3);
  const double rise = (n * srh - sr * sh) / (n * srr - sr * sr);
  return {sr / n - sh / n / rise, std::atan(-rise)};
}

/// How far a column of the aspect ratio `aspect` runs out when its wall is gone, in its radii,
/// and the ratio that it really had.
struct RunOut {
  double aspect, way;
};
RunOut run_out(double aspect, double radius, int substeps) {
  TestWorld w(realtime());
  BodyDef floor = TestWorld::box_def({0, -0.05, 0}, {2, 0.05, 2});
  floor.type = BodyType::fixed;
  w.add(floor);
  const BodyId wall = w.add(ring(radius, 0.03, 0, 2.2 * aspect * radius + 0.1, 0));
  const auto grains = add(w, column(radius, aspect * radius, {0.05, 0.05, substeps}, 0.5));
  w.run(0.7);
  const auto& x = w->particles(grains)->x;
  double middle = 0;
  for (const Vec3& at : x) middle += at.y() / double(x.size());
  REQUIRE(w->destroy_body(wall).ok());
  w.apply();
  w.run(1.3);
  const Slope slope = slope_of(thickness(*w->particles(grains)), 0.5 * radius);
  return {2 * middle / radius, (slope.edge - radius) / radius};
}

/// Angle of what is left of a column on a disc of the same radius, when its wall is gone [deg].
double repose(double radius, double rolling, double density) {
  TestWorld w(realtime());
  ShapeDef plate;
  plate.type = ShapeType::cylinder;
  plate.radius = radius, plate.height = 0.04;
  BodyDef disc = TestWorld::shape_def(plate, {0, -0.02, 0}, BodyType::fixed);
  disc.shapes[0].material.friction = 1;
  w.add(disc);
  const BodyId wall = w.add(ring(radius, 0.03, 0, 3 * radius, 0));
  const auto grains = add(w, column(radius, radius, {rolling, 0.05, 8}, 0.5, density));
  w.run(0.5);
  REQUIRE(w->destroy_body(wall).ok());
  w.apply();
  w.run(1.2);
  std::vector<double> heap = thickness(*w->particles(grains));
  // What hangs at the edge and what falls beside it are no part of the slope.
  heap.resize(std::min(heap.size(), size_t(radius / d)));
  return slope_of(heap, 0.2 * radius).angle * 180 / pi;
}

/// Grains a second through a round hole of `hole` in the floor of a bin.
double discharge(double hole, double bin, double height) {
  TestWorld w(realtime());
  w.add(ring(0.5 * hole, bin + 0.03, -0.01, 0, 0.5));
  w.add(ring(bin, 0.03, 0, 3 * height, 0.5));
  BodyDef plug = TestWorld::box_def({0, -0.03, 0}, {bin, 0.02, bin});
  plug.type = BodyType::fixed;
  const BodyId stop = w.add(plug);
  const auto grains = add(w, column(bin, height, {0.05, 0.05, 16}, 0.5));
  w.run(0.5);
  REQUIRE(w->destroy_body(stop).ok());
  w.apply();
  const auto below = [&] {
    return double(std::ranges::count_if(w->particles(grains)->x,
                                        [](const Vec3& x) { return x.y() < -0.02; }));
  };
  w.run(0.15);
  const double first = below();
  w.run(0.25);
  return (below() - first) / 0.25;
}

}  // namespace

TEST_CASE("grains: columns run out as far as Lube and others measured") {
  if (test::only_to_run()) return;
  // Radii of 8 and 12 grains: what runs farthest is a layer of single grains, which no line through
  // the heap sees. The experiments had fifty and more.
  const bool all = test::all_counts();
  for (const double aspect : {0.6, 1.2, 3.0}) {
    if (!all && aspect != 1.2) continue;
    const RunOut run = run_out(aspect, (all ? 12 : 8) * d, all ? 32 : 16);
    const double wanted = run.aspect < 1.7 ? 1.24 * run.aspect : 1.6 * std::sqrt(run.aspect);
    MESSAGE("aspect ", run.aspect, " runs out ", run.way, " radii, measured ", wanted);
    CHECK(run.way == doctest::Approx(wanted).epsilon(all ? 0.2 : 0.3));
  }
}

TEST_CASE("grains: the angle of repose rises with rolling friction, whatever grains weigh") {
  const double radius = (test::all_counts() ? 12 : 8) * d;
  if (test::only_to_run()) return;
  const double low = repose(radius, 0.05, glass), high = repose(radius, 0.2, glass);
  MESSAGE("angles of repose ", low, " and ", high, " degrees");
  CHECK(high > low + 3);
  CHECK(std::abs(repose(radius, 0.2, 4 * glass) - high) < 1);
}

TEST_CASE("grains: bins empty by Beverloo's law") {
  if (test::only_to_run()) return;
  // Grains a second are 0.58 sqrt(g) (D - 1.4 d)^(5/2) over the volume that one takes. The factor
  // is of grains that are neither rough nor round and varies by a fifth; the exponent does not.
  const auto law = [](double hole) {
    return 0.58 * std::sqrt(g) * std::pow(hole - 1.4 * d, 2.5) * packing / grain_volume;
  };
  const bool all = test::all_counts();
  const double bin = (all ? 12 : 8) * d, height = (all ? 2 : 1.5) * bin;
  const double narrow = discharge(8 * d, bin, height);
  MESSAGE(narrow, " grains a second, by Beverloo's law ", law(8 * d));
  CHECK(narrow == doctest::Approx(law(8 * d)).epsilon(0.3));
  if (!all) return;
  // The slope of the straight line through the logarithms.
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const double hole : {6.0, 8.0, 10.0, 12.0}) {
    const double x = std::log(hole - 1.4), y = std::log(discharge(hole * d, bin, height));
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  MESSAGE("exponent ", exponent);
  CHECK(std::abs(exponent - 2.5) < 0.15);
}
