// The constructions behind the assets. Reference: closed forms. A region of area A and centroid
// radius c, turned in N straight pieces, encloses N sin(2 pi / N) A c (the Jacobian of the chord
// map (r, y, t) -> r ((1-t) e0 + t e1) is r |e0 x e1|); a prism encloses A h. Resolution:
// coordinates are rounded to 1 um, so volumes agree to about the surface times 0.5 um.
#include "assets/generate/audit.hpp"
#include "assets/generate/catalogue.hpp"
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "assets/generate/triangulate.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::assets;

namespace {

/// Integral of r over the region, from the closed form for a polygon.
double first_moment(const Loop2& loop) {
  double sum = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Point2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    sum += (a.u + b.u) * (a.u * b.w - b.u * a.w) / 6;
  }
  return sum;
}

double turned_volume(const Loop2& profile, int n) {
  return n * std::sin(2 * det::pi / n) * first_moment(profile);
}

double polygon_area(double corner_radius, int n) {
  return 0.5 * n * corner_radius * corner_radius * std::sin(2 * det::pi / n);
}

}  // namespace

TEST_CASE("the torus link has the volume of a polygon turned in straight pieces") {
  const double expected = 32 * std::sin(2 * det::pi / 32) * polygon_area(0.045, 14) * 0.20;
  CHECK(volume(make_torus_link()) == doctest::Approx(expected).epsilon(1e-5));
}

TEST_CASE("the ring is a chamfered rectangle turned about the axis") {
  const double c = 0.012;
  const Loop2 profile = {{0.20 + c, 0},   {0.26 - c, 0},   {0.26, c},       {0.26, 0.1 - c},
                         {0.26 - c, 0.1}, {0.20 + c, 0.1}, {0.20, 0.1 - c}, {0.20, c}};
  CHECK(volume(make_ring()) == doctest::Approx(turned_volume(profile, 56)).epsilon(1e-5));
}

TEST_CASE("a profile that touches the axis turns into a closed solid") {
  const Loop2 cone = {{0, 0}, {0.3, 0}, {0, 0.5}};
  Builder builder;
  revolve(builder, cone, 24);
  const Audit report = audit(builder.mesh());
  CHECK(report.faults.empty());
  CHECK(report.volume == doctest::Approx(polygon_area(0.3, 24) * 0.5 / 3).epsilon(1e-5));
}

TEST_CASE("a prism with holes has its area times its height") {
  const Loop2 l = {{0, 0}, {0.5, 0}, {0.5, 0.2}, {0.2, 0.2}, {0.2, 0.6}, {0, 0.6}};
  Loop2 hole_1 = regular_polygon(0.05, 20), hole_2 = hole_1;
  for (Point2& p : hole_1) p = {p.u + 0.1, p.w + 0.1};
  for (Point2& p : hole_2) p = {p.u + 0.1, p.w + 0.4};
  Builder builder;
  extrude(builder, l, {hole_1, hole_2}, 0.3, 0);
  const Audit report = audit(builder.mesh());
  CHECK(report.faults.empty());
  const double area = 0.5 * 0.2 + 0.2 * 0.4 - 2 * polygon_area(0.05, 20);
  CHECK(report.volume == doctest::Approx(area * 0.3).epsilon(2e-5));
}

TEST_CASE("the bevelled star is a prism between two layers of linearly shrinking mitred offset") {
  // Every edge of the star moves inwards at the same speed, so area(d) = A - P d + k d^2 with
  // k from the corners: the sum of cot(half the inner angle).
  const double outer = 0.26, inner = 0.125, b = 0.012, h = 0.10, step = det::pi / 5;
  const double area = 10 * 0.5 * outer * inner * std::sin(step);
  const double edge = std::sqrt(outer * outer + inner * inner - 2 * outer * inner * std::cos(step));
  const double half_tip = std::asin(inner * std::sin(step) / edge);
  const double half_notch = det::pi - step - half_tip;  // more than a right angle
  const double k = 5 * (1 / std::tan(half_tip) + 1 / std::tan(half_notch));
  const double layer = area * b - 10 * edge * b * b / 2 + k * b * b * b / 3;
  CHECK(volume(make_star_prism()) == doctest::Approx(area * (h - 2 * b) + 2 * layer).epsilon(2e-5));
}

TEST_CASE("thirteen stones stand joint to joint in a half circle") {
  const Mesh stone = make_arch_stone();
  const double half_angle = det::pi / 26;
  int on_left = 0, on_right = 0;
  for (const Vec3& p : stone.vertices) {
    // Distance beyond each joint's plane, which passes through the arch's axis at y = -1.75.
    const double y = p.y() + 1.75;
    const double right = p.x() * std::cos(half_angle) - y * std::sin(half_angle);
    const double left = -p.x() * std::cos(half_angle) - y * std::sin(half_angle);
    CHECK(right < 1e-15);
    CHECK(left < 1e-15);
    on_right += right > -1e-15;
    on_left += left > -1e-15;
  }
  CHECK(on_left == 4);
  CHECK(on_right == 4);
}

TEST_CASE("triangulation fills a comb of concave corners exactly") {
  Loop2 comb = {{0, -0.1}, {1, -0.1}};
  for (int i = 10; i-- > 0;) {
    comb.push_back({0.1 * i + 0.1, 0.0});
    comb.push_back({0.1 * i + 0.1, 0.5 + 0.01 * i});
    comb.push_back({0.1 * i + 0.05, 0.5});
    comb.push_back({0.1 * i + 0.05, 0.0});
  }
  double sum = 0;
  for (const auto& t : triangulate({comb})) {
    sum += twice_area({comb[size_t(t[0])], comb[size_t(t[1])], comb[size_t(t[2])]});
  }
  CHECK(sum == doctest::Approx(twice_area(comb)).epsilon(1e-12));
}

TEST_CASE("the audit sees an opening, a turned face, an inside-out solid and a pinched vertex") {
  const Mesh sound = make_hex_nut();
  CHECK(audit(sound).faults.empty());

  Mesh open = sound;
  open.triangles.pop_back();
  CHECK_FALSE(audit(open).faults.empty());

  Mesh turned = sound;
  std::swap(turned.triangles[7][0], turned.triangles[7][1]);
  CHECK_FALSE(audit(turned).faults.empty());

  Mesh inside_out = sound;
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  CHECK_FALSE(audit(inside_out).faults.empty());

  Builder two_tetrahedra;  // that share one corner
  for (const double s : {1.0, -1.0}) {
    const Vec3 o = Vec3::Zero(), x(s, 0, 0), y(0, s, 0), z(0, 0, s);
    const auto face = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      s > 0 ? two_tetrahedra.triangle(a, b, c) : two_tetrahedra.triangle(a, c, b);
    };
    face(o, y, x);
    face(o, z, y);
    face(o, x, z);
    face(x, y, z);
  }
  CHECK(audit(two_tetrahedra.mesh()).faults.size() == 1);
}
