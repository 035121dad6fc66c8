// Primitive tests: time of a query and how often its exact fallback ran, on random pairs of which
// about a third meet and on lattice pairs, which touch and lie in one plane all the time.
#include "engine/core/random.hpp"
#include "engine/geometry/predicates/filtered.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/bench/contest.hpp"
#include "tests/geometry/draws.hpp"

#include <cmath>

using namespace tumble;

namespace {

constexpr size_t pairs = 4096;

struct Case {
  Triangle3 t, u;
  OrientedBox a, b;
  Sphere s;
};

std::vector<Case> cases(bool lattice) {
  Random r(7);
  const auto point = [&] {
    Vec3 p = draws::in_box(r, 1);
    if (lattice) p = (2 * p).array().round();
    return p;
  };
  std::vector<Case> out(pairs);
  for (Case& c : out) {
    c.t = {point(), point(), point()};
    c.u = {point(), point(), point()};
    for (OrientedBox* box : {&c.a, &c.b}) {
      box->centre = point();
      const Mat3 axes = lattice ? Mat3(Mat3::Identity()) : draws::rotation(r).toRotationMatrix();
      box->half_axes = 0.5 * axes;
    }
    c.s = {point(), lattice ? 0.5 : r.uniform(0.1, 0.8)};
  }
  return out;
}

}  // namespace

int main() {
  for (const bool lattice : {false, true}) {
    const std::vector<Case> all = cases(lattice);
    uint64_t fallbacks = 0;
    const auto over_all = [&](auto test) {
      return [&, test] {
        const uint64_t before = exact_fallbacks();
        size_t hits = 0;
        for (const Case& c : all) hits += test(c);
        fallbacks = exact_fallbacks() - before;
        return double(hits);
      };
    };
    const std::vector<bench::Candidate> tests = {
        {"triangle-triangle",
         over_all([](const Case& c) { return triangles_intersect(c.t, c.u); })},
        {"segment-triangle",
         over_all([](const Case& c) { return segment_triangle_intersect(c.t[0], c.t[1], c.u); })},
        {"edge-edge", over_all([](const Case& c) {
           return segments_intersect(c.t[0], c.t[1], c.u[0], c.u[1]);
         })},
        {"point in triangle",
         over_all([](const Case& c) { return point_in_triangle(c.t[0], c.u); })},
        {"box-box", over_all([](const Case& c) { return boxes_intersect(c.a, c.b); })},
        {"box-triangle", over_all([](const Case& c) { return box_triangle_intersect(c.a, c.t); })},
        {"segment-box", over_all([](const Case& c) {
           return segment_box_intersect(Segment{c.t[0], c.t[1]}, c.a);
         })},
        {"box-sphere", over_all([](const Case& c) { return sphere_box_intersect(c.s, c.a); })},
        {"sphere-triangle", over_all([](const Case& c) {
           return sphere_triangle_intersect(c.s.centre, c.s.radius, c.t);
         })},
        {"segment-sphere", over_all([](const Case& c) {
           return segment_sphere_intersect(Segment{c.t[0], c.t[1]}, c.s);
         })},
        {"sphere-sphere", over_all([](const Case& c) {
           return spheres_intersect(c.s, {c.t[0], 0.5});
         })},
        {"box-box contact",
         over_all([](const Case& c) { return box_box_contact(c.a, c.b).has_value(); })},
        {"triangle-triangle contact",
         over_all([](const Case& c) { return triangle_triangle_contact(c.t, c.u).has_value(); })},
    };
    std::printf("%s pairs\n", lattice ? "lattice" : "random");
    for (const bench::Candidate& test : tests) {
      const bench::Timing timing = bench::contest({test}, 9).front();
      std::printf("  %-28s %9.1f ns a query, %5.1f %% meet, %.4f exact evaluations a query\n",
                  test.name.c_str(), 1e6 * timing.milliseconds / double(pairs),
                  100 * timing.answer / double(pairs), double(fallbacks) / double(pairs));
    }
  }
}
