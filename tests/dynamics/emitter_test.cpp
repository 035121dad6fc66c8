// Emitters without a world. References: mean and variance of uniform distributions over segments,
// discs, balls, boxes and tori in closed form; chi-square at the 99.9 % quantile with fixed seeds;
// counts by integer arithmetic; integrals of curves by sums of a million rectangles.
#include "engine/dynamics/particles/emitter.hpp"

#include "engine/dynamics/particles/emission_bounds.hpp"
#include "engine/dynamics/particles/sink.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr int draws = 40000;

struct Moments {
  Vec3 mean = Vec3::Zero(), square = Vec3::Zero();  ///< square: of the distance from the origin
};

Moments moments_of(const EmissionShapeDef& def) {
  const auto shape = EmissionShape::make(def);
  REQUIRE_MESSAGE(shape.ok(), test::why_not(shape));
  Moments m;
  for (uint64_t n = 0; n < draws; ++n) {
    Random random = numbered_random(11, n);
    const Vec3 x = shape->draw(random).x;
    m.mean += x / draws;
    m.square += x.cwiseProduct(x) / draws;
  }
  return m;
}

/// Means are zero and mean squares as given, within four standard errors and `slack` for meshes
/// that are not quite the body.
void check_moments(const EmissionShapeDef& def, const Vec3& square, double slack = 0) {
  const Moments m = moments_of(def);
  for (int k = 0; k < 3; ++k) {
    CAPTURE(k);
    CHECK(std::fabs(m.mean[k]) <= 4 * std::sqrt(square[k] / draws) + slack * std::sqrt(square[k]));
    // The fourth moment of none of these is above three times the square of the second.
    CHECK(std::fabs(m.square[k] - square[k]) <= (4 * std::sqrt(2.0 / draws) + slack) * square[k]);
  }
}

double chi_square(const std::vector<int>& counts, const std::vector<double>& expected) {
  double sum = 0;
  for (size_t i = 0; i < counts.size(); ++i)
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  return sum;
}

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

EmitterDef into_particles() {
  EmitterDef def;
  def.name = "test";
  def.particles = {0, 1};
  def.life = {1};
  return def;
}

Emitter live(const EmitterDef& def) {
  Emitter e;
  e.def = std::make_shared<const EmitterDef>(def);
  auto shape = EmissionShape::make(def.shape);
  REQUIRE(shape.ok());
  e.shape = std::make_shared<const EmissionShape>(std::move(*shape));
  return e;
}

}  // namespace

TEST_CASE("points are uniform over every shape: means and mean squares") {
  check_moments(PointEmission{}, Vec3::Zero());
  check_moments(LineEmission{3}, Vec3(9.0 / 12, 0, 0));
  check_moments(DiscEmission{2, 0}, Vec3(1, 0, 1));
  check_moments(DiscEmission{2, 1}, Vec3(1.25, 0, 1.25));
  check_moments(SphereEmission{2, false}, Vec3::Constant(4.0 / 5));
  check_moments(SphereEmission{2, true}, Vec3::Constant(4.0 / 3));
  const Vec3 size(1, 2, 3), square = size.cwiseProduct(size);
  check_moments(BoxEmission{size, false}, square / 12);
  Vec3 of_surface;  // a face across k at half the size, with its share of the area
  const Vec3 faces(6, 3, 2);
  for (int k = 0; k < 3; ++k) {
    const double share = faces[k] / faces.sum();
    of_surface[k] = square[k] * (share / 4 + (1 - share) / 12);
  }
  check_moments(BoxEmission{size, true}, of_surface);
  const auto box = shared(make_mesh::box(0.5 * size));
  check_moments(MeshSurfaceEmission{box}, of_surface);
  check_moments(MeshVolumeEmission{box}, square / 12);
}

TEST_CASE("the inside of a torus: its mean square, and nothing in its hole") {
  const double R = 1, r = 0.4;
  const auto torus = shared(make_mesh::torus(R, r, 64, 32));
  const auto shape = EmissionShape::make(MeshVolumeEmission{torus});
  REQUIRE(shape.ok());
  int axis = 0;  // the one that it is thinnest along
  bounds(*torus).extent().minCoeff(&axis);
  double across = 0;
  for (uint64_t n = 0; n < draws; ++n) {
    Random random = numbered_random(3, n);
    Vec3 x = shape->draw(random).x;
    const double along = x[axis];
    x[axis] = 0;
    REQUIRE(std::hypot(x.norm() - R, along) <= r);
    across += x.squaredNorm() / draws;
  }
  CHECK(across == doctest::Approx(R * R + 0.75 * r * r).epsilon(0.01));
}

TEST_CASE("triangles of a mesh are met by their area: chi-square") {
  const auto mesh = shared(make_mesh::box(Vec3(0.5, 1, 2)));
  const auto shape = EmissionShape::make(MeshSurfaceEmission{mesh});
  REQUIRE(shape.ok());
  std::vector<int> counts(6, 0);  // by side
  std::vector<double> expected(6, 0);
  const auto side = [](const Vec3& n) {
    int k = 0;
    n.cwiseAbs().maxCoeff(&k);
    return size_t(2 * k + (n[k] > 0));
  };
  for (size_t t = 0; t < mesh->triangles.size(); ++t)
    expected[side(face_normal(*mesh, t))] +=
        draws * face_area_vector(*mesh, t).norm() / surface_area(*mesh);
  for (uint64_t n = 0; n < draws; ++n) {
    Random random = numbered_random(5, n);
    const EmissionPoint p = shape->draw(random);
    ++counts[side(p.outward)];
    CHECK(p.outward.dot(p.x) > 0.49);  // outward, on the side
  }
  CHECK(chi_square(counts, expected) < 20.5);  // 5 degrees of freedom
}

TEST_CASE("directions are uniform over the cone: chi-square of the height of the cap") {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  for (const double angle : {0.1, 1.0, det::pi}) {
    CAPTURE(angle);
    const double least = det::cos(angle);
    std::vector<int> counts(20, 0);
    for (uint64_t n = 0; n < draws; ++n) {
      Random random = numbered_random(7, n);
      const Vec3 d = direction_in_cone(random, axis, least);
      CHECK(d.norm() == doctest::Approx(1).epsilon(1e-12));
      const double u = (d.dot(axis) - least) / (1 - least);
      CHECK(u >= -1e-9);
      ++counts[std::min(size_t(std::max(u, 0.0) * 20), size_t(19))];
    }
    CHECK(chi_square(counts, std::vector<double>(20, draws / 20.0)) < 43.8);
  }
}

TEST_CASE("random numbers: uniform and normal by chi-square, constants draw nothing") {
  std::vector<int> even(20, 0), bell(8, 0);
  // Of the normal distribution between whole standard deviations, within four.
  const double inside[4] = {0.341345, 0.135905, 0.021400, 0.001318};
  std::vector<double> expected;
  for (const int k : {3, 2, 1, 0, 0, 1, 2, 3}) expected.push_back(draws * inside[k] / 0.999937 * 1);
  for (uint64_t n = 0; n < draws; ++n) {
    Random random = numbered_random(9, n);
    const double u = RandomNumber{5, 2}.draw(random);
    REQUIRE((u >= 3 && u < 7));
    ++even[size_t((u - 3) * 5)];
    const double z = RandomNumber{-1, 0.5, RandomNumber::Kind::normal}.draw(random);
    REQUIRE((z >= -3 && z <= 1));
    ++bell[size_t(std::min((z + 3) * 2, 7.0))];
  }
  CHECK(chi_square(even, std::vector<double>(20, draws / 20.0)) < 43.8);
  CHECK(chi_square(bell, expected) < 24.3);  // 7 degrees of freedom
  Random a(1), b(1);
  CHECK(RandomNumber{3}.draw(a) == 3);
  CHECK(a.next() == b.next());
}

TEST_CASE("the count is the whole part of rate times time, however long the ticks are") {
  for (const int64_t hertz : {60, 50, 240, 7}) {
    for (int64_t rate = 1; rate < 400; rate += 3) {
      EmitterDef def = into_particles();
      def.rate = double(rate);
      Emitter e = live(def);
      std::vector<double> births;
      for (int64_t n = 1; n <= 3 * hertz; ++n) {
        take_due(e, double(n) / double(hertz), births);
        REQUIRE(births.size() == size_t(rate * n / hertz));
      }
      REQUIRE(e.scheduled == births.size());
      for (size_t k = 0; k < births.size(); ++k)
        REQUIRE(births[k] == doctest::Approx(double(k + 1) / double(rate)));
    }
  }
}

TEST_CASE("ticks of any length, changed on the way, neither lose nor repeat a birth") {
  EmitterDef def = into_particles();
  def.rate = 123.456;
  def.start = 0.3;
  def.end = 7.1;
  def.bursts = {{0, 2}, {1.5, 10, 4, 0.25}, {6.9, 3}};
  Emitter e = live(def);
  Random random(2);
  std::vector<double> births;
  double t = 0;
  while (t < 8) {
    t += random.uniform(1e-4, 0.2);
    const size_t before = births.size();
    const double from = e.emitted_to;
    take_due(e, t, births);
    for (size_t k = before; k < births.size(); ++k) CHECK((births[k] >= from && births[k] <= t));
  }
  CHECK(std::ranges::is_sorted(births));
  CHECK(births.size() == size_t(123.456 * 6.8) + 2 + 40 + 3);
  CHECK(spent(e));
}

TEST_CASE("bursts are in the tick that reaches their time") {
  EmitterDef def = into_particles();
  def.bursts = {{10.0 / 60, 7, 3, 5.0 / 60}};
  Emitter e = live(def);
  std::vector<double> births;
  std::vector<size_t> after;
  for (int n = 1; n <= 30; ++n) {
    CHECK(spent(e) == (n > 20));
    take_due(e, n / 60.0, births);
    after.push_back(births.size());
  }
  CHECK(after[8] == 0);
  CHECK(after[9] == 7);
  CHECK(after[13] == 7);
  CHECK(after[14] == 14);
  CHECK(after[18] == 14);
  CHECK(after[19] == 21);
  CHECK(after[29] == 21);
}

TEST_CASE("count ends rate and bursts together") {
  EmitterDef def = into_particles();
  def.rate = 10;
  def.count = 25;
  def.bursts = {{1.05, 10}};
  Emitter e = live(def);
  std::vector<double> births;
  for (int n = 1; n <= 600; ++n) take_due(e, n / 60.0, births);
  CHECK(births.size() == 25);
  CHECK(births.back() == doctest::Approx(1.5));
  CHECK(spent(e));
}

TEST_CASE("a particle depends on its number alone") {
  EmitterDef def = into_particles();
  def.shape = SphereEmission{1};
  def.spread = 0.4;
  def.speed = {3, 1};
  def.life = {2, 0.5, RandomNumber::Kind::normal};
  def.colours = {Vec3f(1, 0, 0), Vec3f(0, 1, 0)};
  Emitter all = live(def), late = live(def);
  std::vector<ParticleDef> made;
  for (int n = 0; n < 50; ++n) made.push_back(next_particle(all, {}));
  late.made = 30;
  const ParticleDef p = next_particle(late, {});
  CHECK(p.x == made[30].x);
  CHECK(p.v == made[30].v);
  CHECK(p.life == made[30].life);
  CHECK(p.colour == made[30].colour);
  CHECK(made[0].x != made[1].x);
}

TEST_CASE("values over a life are linear between their places") {
  const std::vector<double> size{1, 3, 2};
  CHECK(over_life(size, 0) == 1);
  CHECK(over_life(size, 0.25) == 2);
  CHECK(over_life(size, 0.5) == 3);
  CHECK(over_life(size, 0.75) == 2.5);
  CHECK(over_life(size, 1) == 2);
  CHECK(over_life(std::vector<double>{4}, 0.3) == 4);
  const std::vector<Vec3f> colour{Vec3f(1, 0, 0), Vec3f(0, 0, 1)};
  CHECK((over_life(colour, 0.5) - Vec3f(0.5f, 0, 0.5f)).norm() < 1e-6f);
}

TEST_CASE("how many may be alive: by rate, bursts, life and events") {
  const double h = 1.0 / 60;
  const EmitterId a{0, 1}, b{1, 1};
  EmitterDef rocket = into_particles(), spark = into_particles();
  rocket.rate = 2;
  rocket.life = {3};
  rocket.events = {{SpawnRule::On::death, b, 100, 0, false}};
  const std::vector<NamedEmitter> both{{b, &spark}, {a, &rocket}};
  std::vector<double> most = most_alive(both, h);
  CHECK(most[1] == std::floor(2 * (3 + h)) + 1);
  CHECK(most[0] == 100 * (std::floor(2 * (1 + h)) + 1));
  rocket.life = {3, 1};  // deaths may come closer together than births
  most = most_alive(both, h);
  CHECK(most[0] == 100 * (std::floor(2 * (1 + h + 2)) + 1));
  rocket.events = {{SpawnRule::On::collision, b, 1, 0, false}};
  CHECK(std::isinf(most_alive(both, h)[0]));
  spark.at_most = 40;
  CHECK(most_alive(both, h)[0] == 40);
  rocket.events = {{SpawnRule::On::collision, b, 5, 0, true}};
  spark.at_most = ~uint64_t{0};
  CHECK(most_alive(both, h)[0] == 5 * (std::floor(2 * (1 + h + 4)) + 1));
  rocket.life = {EmitterDef::for_ever};
  CHECK(std::isinf(most_alive(both, h)[1]));
  rocket.end = 10;
  CHECK(most_alive(both, h)[1] == 21);
  // A rate that fades ends as well, and at most the greatest factor applies until then.
  rocket.end = EmitterDef::for_ever;
  rocket.start = 1;
  rocket.over_time.rate.points = {{0, 3}, {5, 0.5}, {6, 0}};
  CHECK(most_alive(both, h)[1] == 2 * 3 * (6 - 1) + 1);
  rocket.start = 9;
  CHECK(most_alive(both, h)[1] == 1);
  rocket.over_time.rate.points.back().value = 0.1;
  CHECK(std::isinf(most_alive(both, h)[1]));
}

TEST_CASE("definitions that cannot be are refused, with the value") {
  const auto refused = [](EmitterDef def, const char* part) {
    const Status status = validate(def);
    REQUIRE(!status.ok());
    const bool told = status.error().text().find(part) != std::string::npos;
    CHECK_MESSAGE(told, status.error().text());
  };
  CHECK(validate(into_particles()).ok());
  EmitterDef def = into_particles();
  def.rate = -1;
  refused(def, "rate must be >= 0, got -1");
  def = into_particles();
  def.life = {0};
  refused(def, "life must be > 0");
  def.life = {1, 2};
  refused(def, "life must be > 0, but it may be -1");
  def.life = {EmitterDef::for_ever};
  def.rate = 10;
  refused(def, "without end");
  def.at_most = 100;
  CHECK(validate(def).ok());
  def.size_over_life = {1, 2};
  refused(def, "need a life that ends");
  def = into_particles();
  def.particles = {};
  refused(def, "either particles or a body");
  def = into_particles();
  def.bursts = {{1, 5, 3, 0}};
  refused(def, "time between");
  def = into_particles();
  def.shape = SphereEmission{-2};
  refused(def, "radius must be > 0, got -2");
  def.shape = MeshVolumeEmission{};
  refused(def, "no mesh");
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}};
  def.shape = MeshSurfaceEmission{shared(flat)};
  refused(def, "no surface");
  flat.triangles = {{0, 1, 3}};
  def.shape = MeshSurfaceEmission{shared(flat)};
  CHECK(validate(def).ok());
  def.shape = MeshVolumeEmission{shared(flat)};
  refused(def, "encloses no volume");
  def = into_particles();
  def.events = {{SpawnRule::On::death, {}, 1, 0, false}};
  refused(def, "needs an emitter");
}

TEST_CASE("sinks hold what is in them") {
  SinkDef sink;
  sink.pose.x = {0, 2, 0};
  CHECK(holds(sink, {5, 1.9, -3}));
  CHECK(!holds(sink, {5, 2.1, -3}));
  sink.region = BoxSink{{2, 4, 6}};
  CHECK(holds(sink, {0.9, 3.9, -2.9}));
  CHECK(!holds(sink, {1.1, 2, 0}));
  sink.pose.q = axis_angle(Vec3::UnitY(), det::pi / 2);
  CHECK(holds(sink, {2.9, 2, 0.9}));
  sink.region = SphereSink{1};
  sink.outside = true;
  CHECK(!holds(sink, {0.5, 2.5, 0}));
  CHECK(holds(sink, {0, 3.1, 0}));
  CHECK(validate(sink).ok());
  sink.region = SphereSink{0};
  CHECK(!validate(sink).ok());
}

TEST_CASE("a curve over time: its values, its integral and the inverse of that") {
  FactorCurve curve;
  CHECK(curve.at(3) == 1);
  CHECK(curve.integral(1, 4) == 3);
  curve.points = {{1, 0.5}, {2, 2}, {4, 0}, {5, 1}};
  CHECK(curve.at(0) == 0.5);
  CHECK(curve.at(1.5) == doctest::Approx(1.25));
  CHECK(curve.at(3) == doctest::Approx(1));
  CHECK(curve.at(9) == 1);
  for (const auto& [from, to] : {std::pair{0.0, 0.7}, {0.0, 6.0}, {1.3, 1.9}, {1.7, 4.4}}) {
    constexpr int parts = 1'000'000;
    double sum = 0;
    for (int i = 0; i < parts; ++i) sum += curve.at(from + (to - from) * (i + 0.5) / parts);
    const double expected = sum * (to - from) / parts;
    CHECK(curve.integral(from, to) == doctest::Approx(expected).epsilon(1e-9));
    CHECK(curve.time_of_integral(from, expected) == doctest::Approx(to).epsilon(1e-7));
  }
  curve.points = {{0, 1}, {2, 0}};
  CHECK(curve.integral(0, EmitterDef::for_ever) == doctest::Approx(1));
  CHECK(curve.time_of_integral(0, 1.5) == EmitterDef::for_ever);
}

TEST_CASE("a rate over time: the count is the whole part of its integral, for any ticks") {
  EmitterDef def = into_particles();
  def.rate = 90;
  def.start = 0.5;
  def.end = 3.5;
  def.over_time.rate.points = {{0.5, 0}, {1.5, 1}, {2.5, 0.5}};
  REQUIRE(validate(def).ok());
  // Half of 90 in the first second, three quarters in the second, a half in the third.
  CHECK(count_by_rate(def, 1.5) == 45);
  CHECK(count_by_rate(def, 2.5) == 112);
  CHECK(count_by_rate(def, 9) == 157);
  std::vector<double> first;
  for (const double h : {1.0 / 60, 1.0 / 7}) {
    Emitter e = live(def);
    std::vector<double> births;
    for (double t = h; t < 4; t += h) take_due(e, t, births);
    REQUIRE(births.size() == 157);
    CHECK(spent(e));
    // Rising by the square: number k is due at the root of 2 k / 90.
    for (int k = 1; k <= 45; ++k)
      CHECK(births[size_t(k) - 1] == doctest::Approx(0.5 + std::sqrt(2.0 * k / 90)));
    if (first.empty()) first = births;
    for (size_t i = 0; i < first.size(); ++i) CHECK(births[i] == doctest::Approx(first[i]));
  }
  def.end = EmitterDef::for_ever;
  def.life = {EmitterDef::for_ever};
  CHECK_FALSE(validate(def).ok());  // it goes on at half the rate
  def.over_time.rate.points.push_back({4, 0});
  CHECK(validate(def).ok());
  def.over_time.rate.points.push_back({4, 0});
  CHECK_FALSE(validate(def).ok());
}

TEST_CASE("values over the emitter's time are factors of what is drawn") {
  EmitterDef def = into_particles();
  def.speed = {3, 1};
  def.life = {2, 1};
  def.mass = {0.5};
  def.spin = {10, 2};
  Emitter plain = live(def);
  def.over_time.speed.points = {{0, 1}, {2, 3}};
  def.over_time.life.points = {{0, 1}, {4, 0.5}};
  def.over_time.mass.points = {{1, 2}};
  def.over_time.spin.points = {{0, 0}, {2, -1}};
  def.over_time.colour.points = {{0, Vec3f(1, 0, 0)}, {2, Vec3f(0, 0, 1)}};
  Emitter changing = live(def);
  const EmissionPlace place;
  for (int n = 0; n < 100; ++n) {
    const ParticleDef was = next_particle(plain, place);
    const ParticleDef is = next_particle(changing, place, 1);
    CHECK(is.v.y() == doctest::Approx(2 * was.v.y()));
    CHECK(is.life == doctest::Approx(0.875 * was.life));
    CHECK(is.mass == 1);
    CHECK((is.spin + 0.5 * was.spin).norm() < 1e-12);
    CHECK(was.spin.norm() >= 8);
    CHECK(was.spin.norm() <= 12);
    CHECK((is.colour - Vec3f(0.5f, 0, 0.5f)).norm() < 1e-6f);
  }
}
