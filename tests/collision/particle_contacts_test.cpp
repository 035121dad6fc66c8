// Contacts of particles, now and within a tick. References: all pairs one by one by closed forms
// written here (distances; the quadratic of two moving balls in long double; balls against planes,
// balls and a turning sheet), and every shape one by one by time_of_contact().
#include "engine/collision/particle_contacts/particle_contacts.hpp"

#include "engine/collision/query.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Dust {
  std::vector<Vec3> x, v;
  std::vector<double> radius;

  ParticleBalls balls() const { return {x, radius}; }
  ParticlePaths paths(double h) const { return {balls(), v, h}; }
  void add(const Vec3& at, double r, const Vec3& speed = Vec3::Zero()) {
    x.push_back(at);
    v.push_back(speed);
    radius.push_back(r);
  }
};

/// Particles in a cube, radii over a ratio of `spread` to 1, some in one place.
Dust random_dust(Random& r, int n, double half, double size, double spread, double speed,
                 const Vec3& middle = Vec3::Zero()) {
  Dust d;
  for (int i = 0; i < n; ++i) {
    const double shrink = r.uniform();
    const double radius = size * (r.below(4) == 0 ? shrink : 1) / (r.below(3) == 0 ? spread : 1);
    Vec3 at = middle + random_vec(r, -half, half);
    if (i > 0 && r.below(50) == 0) at = d.x[r.below(uint32_t(i))];
    d.add(at, radius, speed * random_vec(r, -1, 1));
  }
  return d;
}

/// When two moving balls first touch, in extended precision.
std::optional<long double> exact_meeting(const Dust& d, size_t a, size_t b, double h) {
  long double A = 0, B = 0, C = 0;
  for (int k = 0; k < 3; ++k) {
    const long double x = (long double)d.x[b][k] - (long double)d.x[a][k];
    const long double v = (long double)d.v[b][k] - (long double)d.v[a][k];
    A += v * v, B += x * v, C += x * x;
  }
  const long double r = (long double)d.radius[a] + (long double)d.radius[b];
  C -= r * r;
  if (C <= 0) return 0;
  const long double disc = B * B - A * C;
  if (B >= 0 || disc < 0) return std::nullopt;
  const long double t = C / (std::sqrt(disc) - B);
  return t <= (long double)h ? std::optional(t) : std::nullopt;
}

template <class T>
T found(const auto& call) {
  T out;
  const Status s = call(out);
  REQUIRE_MESSAGE(s.ok(), test::why_not(s));
  return out;
}

std::vector<ParticlePairContact> touching(ParticleContactFinder& f, const Dust& d, double margin) {
  return found<std::vector<ParticlePairContact>>(
      [&](auto& out) { return f.touching_pairs(d.balls(), margin, out); });
}
std::vector<ParticlePairMeeting> meeting(ParticleContactFinder& f, const Dust& d, double h) {
  return found<std::vector<ParticlePairMeeting>>(
      [&](auto& out) { return f.meeting_pairs(d.paths(h), out); });
}
std::vector<ParticleShapeMeeting> meeting(ParticleContactFinder& f, const Dust& d, double h,
                                          const std::vector<MovingShape>& shapes,
                                          double tolerance) {
  return found<std::vector<ParticleShapeMeeting>>(
      [&](auto& out) { return f.meeting_shapes(d.paths(h), shapes, tolerance, out); });
}

MovingShape moving_shape(const std::shared_ptr<const Shape>& s, const Pose& pose, double h,
                         const Vec3& v = Vec3::Zero(), const Vec3& omega = Vec3::Zero()) {
  MovingShape m{s.get(), Motion::at_rest(pose, 0, h)};
  m.motion.velocity = v;
  m.motion.omega = omega;
  return m;
}

}  // namespace

TEST_CASE("particles that touch particles: all pairs, radii up to 1000 to 1, far from the origin") {
  Random r(1);
  ParticleContactFinder finder;
  for (const auto& [spread, middle] :
       {std::pair{1.0, Vec3(0, 0, 0)}, {1000.0, Vec3(0, 0, 0)}, {10.0, Vec3(1e4, 1e4, -1e4)}}) {
    const Dust d = random_dust(r, cases(500), 2, 0.2, spread, 0, middle);
    for (const double margin : {0.0, 0.1}) {
      const auto contacts = touching(finder, d, margin);
      size_t next = 0;
      for (uint32_t a = 0; a < d.x.size(); ++a)
        for (uint32_t b = a + 1; b < d.x.size(); ++b) {
          const double gap = (d.x[b] - d.x[a]).norm() - d.radius[a] - d.radius[b];
          if (gap > margin) continue;
          REQUIRE(next < contacts.size());
          const ParticlePairContact& c = contacts[next++];
          CHECK((c.a == a && c.b == b));
          CHECK(std::abs(c.gap - gap) < 1e-11);
          CHECK(std::abs(c.normal.norm() - 1) < 1e-12);
          if (d.x[a] == d.x[b]) continue;
          CHECK(c.normal.dot(d.x[b] - d.x[a]) == doctest::Approx((d.x[b] - d.x[a]).norm()));
          // Midway between the surfaces.
          CHECK(std::abs((c.x - d.x[a]).norm() - std::abs(d.radius[a] + gap / 2)) < 1e-11);
        }
      CHECK(next == contacts.size());
      if (d.x.size() > 400) CHECK(next > 100);
    }
  }
}

TEST_CASE("particles that meet particles within the tick: all pairs by the quadratic") {
  Random r(2);
  ParticleContactFinder finder;
  for (const auto& [h, speed] : {std::pair{1.0 / 60, 20.0}, {1.0 / 60, 1000.0}, {0.0, 1.0}}) {
    const Dust d = random_dust(r, cases(400), 1.5, 0.1, 10, speed);
    const auto contacts = meeting(finder, d, h);
    size_t next = 0, later = 0;
    for (uint32_t a = 0; a < d.x.size(); ++a)
      for (uint32_t b = a + 1; b < d.x.size(); ++b) {
        const auto t = exact_meeting(d, a, b, h);
        if (!t) continue;
        REQUIRE(next < contacts.size());
        const ParticlePairMeeting& c = contacts[next++];
        REQUIRE((c.a == a && c.b == b));
        CHECK(c.time <= double(*t) + 1e-15);
        CHECK(double(*t) - c.time <= 1e-7 * h);
        later += c.time > 0;
        if (c.time == 0) continue;
        const Vec3 xa = d.x[a] + c.time * d.v[a], xb = d.x[b] + c.time * d.v[b];
        CHECK(std::abs((c.x - xa).norm() - d.radius[a]) < 1e-8);
        CHECK(std::abs((c.x - xb).norm() - d.radius[b]) < 1e-8);
        CHECK(c.normal.dot((xb - xa).normalized()) > 1 - 1e-9);
      }
    CHECK(next == contacts.size());
    if (d.x.size() > 200 && speed > 100) CHECK(later > 20);
  }
}

TEST_CASE("a hundred thousand particles: samples against all others, any number of threads") {
  Random r(3);
  const int n = cases(100'000);
  const double half = 0.5 * std::cbrt(double(n)) * 0.05;
  const Dust d = random_dust(r, n, half, 0.02, 3, 3);
  const double h = 1.0 / 60;
  ParticleContactFinder alone, finder;
  Crew two(2);
  finder.use_threads(&two);
  const auto contacts = touching(alone, d, 0), same = touching(finder, d, 0);
  const auto meetings = meeting(alone, d, h), as_many = meeting(finder, d, h);
  REQUIRE(contacts.size() == same.size());
  REQUIRE(meetings.size() == as_many.size());
  bool equal = true;
  for (size_t k = 0; k < contacts.size(); ++k)
    equal &= contacts[k].a == same[k].a && contacts[k].b == same[k].b &&
             contacts[k].gap == same[k].gap && contacts[k].x == same[k].x;
  for (size_t k = 0; k < meetings.size(); ++k)
    equal &= meetings[k].a == as_many[k].a && meetings[k].b == as_many[k].b &&
             meetings[k].time == as_many[k].time;
  CHECK(equal);
  const int samples = std::min(n, 50);
  for (int k = 0; k < samples; ++k) {
    const auto i = uint32_t(k) * uint32_t(n / samples);
    size_t touch = 0, meet = 0;
    for (uint32_t j = 0; j < d.x.size(); ++j) {
      if (j == i) continue;
      touch += (d.x[i] - d.x[j]).norm() <= d.radius[i] + d.radius[j];
      meet += exact_meeting(d, i, j, h).has_value();
    }
    const auto of_i = [&](const auto& c) { return c.a == i || c.b == i; };
    CHECK(size_t(std::count_if(contacts.begin(), contacts.end(), of_i)) == touch);
    CHECK(size_t(std::count_if(meetings.begin(), meetings.end(), of_i)) == meet);
  }
  if (n == 100'000) CHECK(contacts.size() > 1000);
}

TEST_CASE("particles that touch shapes: every shape one by one, solids and open meshes") {
  Random r(4);
  const Vec3 half(0.4, 0.6, 0.5);
  const std::vector<std::shared_ptr<const Shape>> kinds{
      sphere(0.5),
      box(half),
      capsule(0.3, 0.8),
      cylinder(0.4, 0.7),
      cone(0.5, 0.8),
      tapered_capsule(0.4, 0.2, 0.5),
      random_hull(r, 20, {0.5, 0.6, 0.4}),
      half_space(),
      mesh(make_mesh::torus(0.5, 0.2, 24, 12)),
      mesh(make_mesh::terrain(2, 4, [](double, double) { return 0.0; }))};
  std::vector<StillShape> shapes;
  for (int i = 0; i < 60; ++i)
    shapes.push_back(
        {kinds[size_t(i) % kinds.size()].get(),
         {random_vec(r, -8, 8) - Vec3(0, i % 10 == 7 ? 10 : 0, 0), random_rotation(r)}});
  const Dust d = random_dust(r, cases(1000), 8, 0.3, 10, 0);
  ParticleContactFinder finder;
  const double margin = 0.05;
  const auto contacts = found<std::vector<ParticleShapeContact>>(
      [&](auto& out) { return finder.touching_shapes(d.balls(), shapes, margin, out); });
  size_t next = 0;
  for (uint32_t i = 0; i < d.x.size(); ++i)
    for (uint32_t k = 0; k < shapes.size(); ++k) {
      const Shape& s = *shapes[k].shape;
      const Vec3 p = shapes[k].pose.inverse_point(d.x[i]);
      double distance = 0;
      if (s.type() == ShapeType::sphere) {
        distance = p.norm() - s.def().radius;
      } else if (s.type() == ShapeType::half_space) {
        distance = p.y();
      } else if (s.type() == ShapeType::box) {
        const Vec3 out = p.cwiseAbs() - half;
        distance = out.cwiseMax(0.0).norm() + std::min(0.0, out.maxCoeff());
      } else {
        distance = closest_point(s, shapes[k].pose, d.x[i])->distance;
        if (&s == kinds.back().get()) distance = std::abs(distance);
      }
      const double gap = distance - d.radius[i];
      if (std::abs(gap - margin) < 1e-9) continue;  // either answer
      if (gap > margin) continue;
      REQUIRE(next < contacts.size());
      const ParticleShapeContact& c = contacts[next++];
      REQUIRE((c.particle == i && c.shape == k));
      CHECK(std::abs(c.gap - gap) < 1e-8);
      CHECK((d.x[i] + (c.gap + d.radius[i]) * c.normal - c.x).norm() < 1e-7);
    }
  CHECK(next == contacts.size());
  if (d.x.size() > 500) CHECK(next > 100);
}

TEST_CASE("particles that meet shapes: every shape one by one, all moving and turning") {
  Random r(5);
  const std::vector<std::shared_ptr<const Shape>> kinds{
      sphere(0.5),
      box({0.1, 1.5, 0.2}),
      capsule(0.1, 1.8),
      half_space(),
      mesh(make_mesh::torus(0.5, 0.2, 16, 8)),
      random_hull(r, 20, {0.5, 0.6, 0.4}),
      mesh(make_mesh::terrain(2, 4, [](double x, double) { return 0.2 * x; }))};
  const double h = 1.0 / 60, tolerance = 1e-5;
  std::vector<MovingShape> shapes;
  for (int i = 0; i < 40; ++i) {
    MovingShape m = moving_shape(kinds[size_t(i) % kinds.size()],
                                 {random_vec(r, -4, 4) - Vec3(0, i % 7 == 3 ? 7 : 0, 0),
                                  i % 7 == 3 ? Quat::Identity() : random_rotation(r)},
                                 h, random_vec(r, -30, 30));
    if (i % 3 != 0) m.motion.omega = random_vec(r, -1, 1) * (i % 3 == 1 ? 30 : 200);
    if (i % 7 == 3) m.motion.omega.setZero();
    if (i % 2 == 0) m.motion.offset = {random_vec(r, -0.5, 0.5), random_rotation(r)};
    shapes.push_back(m);
  }
  const Dust d = random_dust(r, cases(600), 4, 0.1, 10, 60);
  ParticleContactFinder finder;
  const auto contacts = meeting(finder, d, h, shapes, tolerance);
  size_t next = 0, later = 0;
  for (uint32_t i = 0; i < d.x.size(); ++i) {
    Motion path = Motion::at_rest({d.x[i], Quat::Identity()}, 0, h);
    path.velocity = d.v[i];
    const auto ball = sphere(d.radius[i]);
    for (uint32_t k = 0; k < shapes.size(); ++k) {
      const auto toc = time_of_contact(*ball, path, *shapes[k].shape, shapes[k].motion, tolerance);
      if (toc.status == TimeOfContactStatus::separated) continue;
      REQUIRE(next < contacts.size());
      const ParticleShapeMeeting& c = contacts[next++];
      REQUIRE((c.particle == i && c.shape == k));
      CHECK(c.status == toc.status);
      CHECK(c.time == (toc.hit() ? toc.time : 0));
      later += toc.hit();
      if (!toc.hit()) continue;
      // On the surface of both, then.
      const auto on = closest_point(*shapes[k].shape, shapes[k].motion.pose(c.time), c.x);
      REQUIRE(on);
      CHECK(std::abs(on->distance) < 1e-6);
      const double gap = (c.x - (d.x[i] + c.time * d.v[i])).norm() - d.radius[i];
      CHECK((gap > -1e-9 && gap < 1.01 * tolerance));
    }
  }
  CHECK(next == contacts.size());
  if (d.x.size() > 500) CHECK(later > 50);
}

TEST_CASE("a shell of 0.1 mm struck at 1000 m/s from either side is met by every particle") {
  Random r(6);
  const double thick = 1e-4;
  const auto shell = mesh(make_mesh::box({1, thick / 2, 1}));
  const auto sheet = mesh(make_mesh::terrain(2, 4, [](double, double) { return 0.0; }));
  for (const double h : {1.0 / 30, 1.0 / 60, 1.0 / 1000}) {
    for (const auto& wall : {shell, sheet}) {
      const double y = wall == shell ? thick / 2 : 0;
      const Pose pose{random_vec(r, -5, 5), random_rotation(r)};
      Dust d;
      std::vector<double> exact;
      for (int i = 0; i < cases(200); ++i) {
        const double side = i % 2 == 0 ? 1 : -1, radius = r.uniform(1e-5, 1e-3);
        const Vec3 target(r.uniform(-0.9, 0.9), 0, r.uniform(-0.9, 0.9));
        // Steep enough to stay over the wall.
        const Vec3 along = Vec3(r.uniform(-0.03, 0.03), -side, r.uniform(-0.03, 0.03)).normalized();
        const double s = r.uniform(0.01, 0.9) * 1000 * h;  // way to the middle plane
        d.add(pose.point(target - s * along), radius, pose.direction(1000 * along));
        exact.push_back((s * std::abs(along.y()) - y - radius) / (1000 * std::abs(along.y())));
      }
      ParticleContactFinder finder;
      const double tolerance = 1e-6;
      const auto contacts = meeting(finder, d, h, {moving_shape(wall, pose, h)}, tolerance);
      REQUIRE(contacts.size() == d.x.size());
      for (size_t i = 0; i < contacts.size(); ++i) {
        CHECK(contacts[i].particle == i);
        CHECK(contacts[i].status == TimeOfContactStatus::contact);
        CHECK(contacts[i].time <= exact[i] + 1e-12);
        CHECK(contacts[i].time > exact[i] - 1.1 * tolerance / 999);
        CHECK(std::abs(contacts[i].normal.dot(pose.direction(Vec3::UnitY()))) > 1 - 1e-6);
      }
    }
  }
}

TEST_CASE("a sheet that turns meets still particles when its plane comes within their radius") {
  // The sheet contains the axis z and turns about it: a particle at distance rho from the axis and
  // angle phi ahead of the plane is met when rho sin(phi - omega t) = r.
  Random r(7);
  const auto sheet = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  const double h = 1.0 / 60, omega = 100;  // 1.67 rad in the tick
  Dust d;
  std::vector<double> exact;
  for (int i = 0; i < cases(200); ++i) {
    const double rho = r.uniform(0.3, 1.8), phi = r.uniform(0.2, 1.5),
                 radius = r.uniform(0.001, 0.05);
    d.add({rho * det::cos(phi), rho * det::sin(phi), r.uniform(-1.8, 1.8)}, radius);
    exact.push_back((phi - std::asin(radius / rho)) / omega);
  }
  ParticleContactFinder finder;
  const auto contacts =
      meeting(finder, d, h, {moving_shape(sheet, {}, h, Vec3::Zero(), {0, 0, omega})}, 1e-6);
  REQUIRE(contacts.size() == d.x.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    CHECK(contacts[i].time <= exact[i] + 1e-12);
    // At the particle the sheet is as fast as omega rho.
    CHECK(contacts[i].time > exact[i] - 2e-6 / (omega * 0.25));
  }
  // A sheet that is shoved past them without turning.
  Dust still;
  for (int i = 0; i < 20; ++i) still.add({0.1 * i - 1, 0.5 + 0.02 * i, 0}, 0.01);
  const auto shoved = meeting(finder, still, h, {moving_shape(sheet, {}, h, {0, 600, 0})}, 1e-6);
  REQUIRE(shoved.size() == 20);
  for (size_t i = 0; i < shoved.size(); ++i)
    CHECK(std::abs(shoved[i].time - (0.49 + 0.02 * double(i)) / 600) < 2e-9);
}

TEST_CASE("particles that are not finite, arrays that do not match: refused with the index") {
  ParticleContactFinder finder;
  Dust d;
  for (int i = 0; i < 3; ++i) d.add({double(i), 0, 0}, 0.6);
  std::vector<ParticlePairContact> pairs;
  std::vector<ParticlePairMeeting> meetings;
  std::vector<ParticleShapeContact> touches;
  std::vector<ParticleShapeMeeting> hits;
  CHECK(touching(finder, d, 0).size() == 2);
  CHECK(touching(finder, Dust{}, 0).empty());
  CHECK_FALSE(finder.touching_pairs(d.balls(), -1, pairs).ok());
  CHECK_FALSE(finder.meeting_pairs(d.paths(-1), meetings).ok());
  CHECK_FALSE(finder.meeting_shapes(d.paths(1), {}, 0, hits).ok());
  d.x[1].y() = std::nan("");
  CHECK(finder.touching_pairs(d.balls(), 0, pairs).error().text() ==
        "position of particle 1 is not finite");
  CHECK_FALSE(finder.touching_shapes(d.balls(), {}, 0, touches).ok());
  d.x[1].y() = 0;
  d.v[2].x() = 1e308;
  CHECK(finder.meeting_pairs(d.paths(100), meetings).error().text() ==
        "path of particle 2 is not finite");
  d.v[2].x() = 0;
  d.radius[0] = -1;
  CHECK(finder.touching_pairs(d.balls(), 0, pairs).error().text() ==
        "radius of particle 0 must be >= 0, got -1 m");
  d.radius.pop_back();
  CHECK(finder.touching_pairs(d.balls(), 0, pairs).error().text() == "3 positions but 2 radii");
  d.radius = {0, 0, 0};  // points
  CHECK(touching(finder, d, 0).empty());
  const auto met =
      meeting(finder, d, 1,
              {moving_shape(sphere(0.25), {{0, 5, 0}, Quat::Identity()}, 1, {0, -10, 0})}, 1e-6);
  REQUIRE(met.size() == 1);
  CHECK(met[0].time == doctest::Approx(0.475).epsilon(1e-6));
}
