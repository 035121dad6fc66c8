#include "engine/world/microscope/epa_steps.hpp"

#include "engine/collision/gjk/epa.hpp"
#include "engine/world/microscope/chart.hpp"
#include "engine/world/microscope/tolerances.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

void draw_polytope(Sketch& out, const DifferenceSpace& space, const EpaStage& stage) {
  Sketch::Surface hull{{}, Ink::active, 0.3f};
  for (size_t f = 0; f < stage.faces.size(); ++f) {
    std::vector<Vec3> corners;
    for (const Vec3& w : stage.faces[f]) corners.push_back(space.beside(w));
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 &p = corners[k], &q = corners[(k + 1) % 3];
      if (p.x() < q.x() || (p.x() == q.x() && p.y() < q.y())) out.line(p, q, Ink::active, 2);
    }
    if (f == stage.nearest)
      add_polygon(out, corners, Ink::answer, 0.55f);
    else
      hull.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  out.surfaces.push_back(std::move(hull));
}

void draw_depths(Diagram& out, const EpaTrace& trace, size_t count) {
  out.title = "bounds on the depth";
  double top = 0;
  for (size_t i = 0; i < count; ++i) top = std::max(top, trace[i].upper);
  Chart chart(out, 0, std::max<double>(5, double(count)), 0, 1.1 * top, "growths", "m");
  std::vector<Vec2> low, high;
  for (size_t i = 0; i < count; ++i) {
    low.push_back({double(i), trace[i].lower});
    high.push_back({double(i), trace[i].upper});
  }
  chart.curve(low, Ink::answer);
  chart.curve(high, Ink::test);
  for (const Vec2& p : low) chart.point(p, Ink::answer);
  for (const Vec2& p : high) chart.point(p, Ink::test);
}

void add_stage(const DifferenceSpace& space, const EpaTrace& trace, size_t i,
               std::vector<MicroscopeStep>& steps) {
  const EpaStage& stage = trace[i];
  MicroscopeStep& step = steps.emplace_back();
  step.title = "EPA: the nearest face, and how far it can move out";
  step.caption = fmt::format(
      "The polytope of {} faces lies inside A - B and holds the origin. Its face nearest to the "
      "origin is {:.4f} m away: the depth is no less. Moving B out as far as the plane through w, "
      "the furthest point across that face, parts the bodies: the best such move so far is {:.4f} "
      "m. The polytope grows to w.",
      stage.faces.size(), stage.lower, stage.upper);
  step.numbers = {{"growths", fmt::format("{}", i)},
                  {"faces", fmt::format("{}", stage.faces.size())},
                  {"depth at least", fmt::format("{:.4f} m", stage.lower)},
                  {"depth at most", fmt::format("{:.4f} m", stage.upper)}};
  space.draw(step.sketch);
  draw_polytope(step.sketch, space, stage);
  const Vec3 zero = space.beside(Vec3::Zero()), n = space.direction(stage.normal);
  const Vec3 w = space.beside(stage.support);
  step.sketch.arrow(zero, zero + stage.normal.dot(stage.support) * n, Ink::test);
  step.sketch.point(w, Ink::test, 13);
  step.sketch.label(w + 0.12 * space.size() * Vec3::UnitY(), "w", Ink::test);
  add_plane(step.sketch, w, n, 0.6 * space.size(), Ink::test);
  draw_depths(step.diagram, trace, i + 1);
}

}  // namespace

double record_epa(const DifferenceSpace& space, const Simplex& start,
                  std::vector<MicroscopeStep>& steps) {
  EpaTrace trace;
  const EpaResult deep = epa(space.a(), space.b(), start, tolerances::epa_accuracy, &trace);
  for (size_t i = 0; i < trace.size(); ++i) add_stage(space, trace, i, steps);
  MicroscopeStep& step = steps.emplace_back();
  step.title = "The depth is known";
  step.caption = fmt::format(
      "The nearest face cannot move out any further: it lies on the surface of A - B. Moving B by "
      "{:.6g} m along the arrow parts the bodies, and no shorter move does.",
      deep.depth + space.rounding());
  step.numbers = {{"depth", fmt::format("{:.6g} m", deep.depth + space.rounding())}};
  space.draw(step.sketch);
  if (!trace.empty()) {
    draw_polytope(step.sketch, space, trace.back());
    draw_depths(step.diagram, trace, trace.size());
  }
  const Vec3 a = space.from_query(deep.a), zero = space.beside(Vec3::Zero());
  step.sketch.arrow(zero, zero + deep.depth * deep.normal, Ink::answer);
  step.sketch.arrow(a - deep.depth * deep.normal, a, Ink::answer);
  return -(deep.depth + space.rounding());
}

}  // namespace tumble
