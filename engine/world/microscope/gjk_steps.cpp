#include "engine/world/microscope/gjk_steps.hpp"

#include "engine/world/microscope/chart.hpp"
#include "engine/world/microscope/difference_space.hpp"
#include "engine/world/microscope/epa_steps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int most_iterations = 128;

std::string vertex_text(uint32_t vertex, char body) {
  return vertex == no_core_vertex ? fmt::format("a point of {}", body)
                                  : fmt::format("corner {} of {}", vertex, body);
}
std::string part_text(int count) {
  const char* names[] = {"", "the point", "the segment", "the triangle", "the tetrahedron"};
  return names[std::clamp(count, 1, 4)];
}

class GjkRecorder {
 public:
  explicit GjkRecorder(const MicroscopeSlide& slide) : space_(slide) {}

  MicroscopeRecording run();

 private:
  MicroscopeStep& begin(std::string title, const GjkResult& g);
  void draw_simplex(Sketch& out, const Simplex& s) const;
  void draw_nearest(Sketch& out, const Simplex& s) const;
  DifferencePoint draw_look(Sketch& out, const Vec3& v) const;
  void draw_bounds(Diagram& out) const;
  void start(const GjkResult& g);
  void look(const GjkResult& g);
  void take_in(const GjkResult& before, const GjkResult& g);
  void finish(const GjkResult& g);
  void finish_overlap(const GjkResult& g);

  DifferenceSpace space_;
  MicroscopeRecording out_;
  std::vector<double> upper_, lower_;  ///< by iteration [m]
  int iteration_ = 0;
};

MicroscopeStep& GjkRecorder::begin(std::string title, const GjkResult& g) {
  MicroscopeStep& step = out_.steps.emplace_back();
  step.title = std::move(title);
  space_.draw(step.sketch);
  draw_simplex(step.sketch, g.simplex);
  step.numbers.push_back({"iteration", fmt::format("{}", iteration_)});
  step.numbers.push_back({"points of the simplex", fmt::format("{}", g.simplex.count)});
  if (!upper_.empty())
    step.numbers.push_back({"distance at most", fmt::format("{:.4f} m", upper_.back())});
  if (!lower_.empty() && lower_.back() > 0)
    step.numbers.push_back({"distance at least", fmt::format("{:.4f} m", lower_.back())});
  draw_bounds(step.diagram);
  return step;
}

/// Draws a simplex in the difference, and the support points of A and B that it is made of.
void GjkRecorder::draw_simplex(Sketch& out, const Simplex& s) const {
  const auto at = [&](int i) { return s.points[size_t(i)]; };
  for (int i = 0; i < s.count; ++i) {
    out.point(space_.beside(at(i).w.vec()), Ink::active, 12);
    out.point(space_.on_body(at(i).a.vec()), Ink::active, 10);
    out.point(space_.on_body(at(i).b.vec()), Ink::active, 10);
    for (int j = i + 1; j < s.count; ++j) {
      out.line(space_.beside(at(i).w.vec()), space_.beside(at(j).w.vec()), Ink::active, 3);
      out.line(space_.on_body(at(i).a.vec()), space_.on_body(at(j).a.vec()), Ink::active, 2.5f);
      out.line(space_.on_body(at(i).b.vec()), space_.on_body(at(j).b.vec()), Ink::active, 2.5f);
    }
  }
  Sketch::Surface faces{{}, Ink::active, 0.35f};
  for (int i = 0; i < s.count; ++i)
    for (int j = i + 1; j < s.count; ++j)
      for (int k = j + 1; k < s.count; ++k)
        faces.triangles.push_back({space_.beside(at(i).w.vec()), space_.beside(at(j).w.vec()),
                                   space_.beside(at(k).w.vec())});
  if (!faces.triangles.empty()) out.surfaces.push_back(std::move(faces));
}

void GjkRecorder::draw_nearest(Sketch& out, const Simplex& s) const {
  const Vec3 v = space_.beside(s.nearest().vec()), zero = space_.beside(Vec3::Zero());
  out.line(zero, v, Ink::answer, 3);
  out.point(v, Ink::answer, 9);
  out.label(0.5 * (zero + v), "v", Ink::answer);
  const Vec3 a = space_.on_body(s.nearest_a().vec()), b = space_.on_body(s.nearest_b().vec());
  out.line(a, b, Ink::answer, 3);
  out.point(a, Ink::answer, 9);
  out.point(b, Ink::answer, 9);
}

/// Plots how the two bounds on the distance converge.
void GjkRecorder::draw_bounds(Diagram& out) const {
  out.title = "bounds on the distance";
  if (upper_.empty()) return;
  Chart chart(out, 0, std::max<double>(5, double(upper_.size())), 0, 1.1 * upper_.front(),
              "iteration", "m");
  std::vector<Vec2> high, low;
  for (size_t i = 0; i < upper_.size(); ++i) high.push_back({double(i), upper_[i]});
  for (size_t i = 0; i < lower_.size(); ++i) low.push_back({double(i), std::max(0.0, lower_[i])});
  chart.curve(high, Ink::answer);
  chart.curve(low, Ink::test);
  for (const Vec2& p : high) chart.point(p, Ink::answer);
  for (const Vec2& p : low) chart.point(p, Ink::test);
}

void GjkRecorder::start(const GjkResult& g) {
  upper_ = {g.simplex.nearest().vec().norm()};
  MicroscopeStep& step = begin("Start with one point", g);
  draw_nearest(step.sketch, g.simplex);
  step.caption = fmt::format(
      "A - B holds every point of A minus every point of B: the bodies are as far apart as it is "
      "from the origin. GJK never builds it. It starts with one of its points: {} minus {}.",
      vertex_text(g.simplex.points[0].vertex_a, 'A'),
      vertex_text(g.simplex.points[0].vertex_b, 'B'));
}

/// Draws the support point in the direction from v to the origin, with its supporting plane.
DifferencePoint GjkRecorder::draw_look(Sketch& out, const Vec3& v) const {
  const DifferencePoint p = space_.support(-v);
  const Vec3 from = space_.beside(v), w = space_.beside(p.w.vec());
  const Vec3 n = space_.direction(v.normalized());
  out.arrow(from, from - 0.9 * space_.size() * n, Ink::test);
  out.point(w, Ink::test, 13);
  out.label(w + 0.12 * space_.size() * Vec3::UnitY(), "w", Ink::test);
  add_plane(out, w, n, 0.7 * space_.size(), Ink::test);
  out.point(space_.on_body(p.a.vec()), Ink::test, 11);
  out.point(space_.on_body(p.b.vec()), Ink::test, 11);
  return p;
}

void GjkRecorder::look(const GjkResult& g) {
  const Vec3 v = g.simplex.nearest().vec();
  if (v.isZero()) return;
  Sketch marks;
  const DifferencePoint p = draw_look(marks, v);
  const double height = v.dot(p.w.vec()) / v.norm();
  lower_.push_back(std::max(height, lower_.empty() ? height : lower_.back()));
  MicroscopeStep& step = begin("Look from v towards the origin", g);
  draw_nearest(step.sketch, g.simplex);
  step.sketch.add(marks);
  step.caption = fmt::format(
      "v is the point of the simplex nearest to the origin. Which point of A - B lies furthest "
      "from v towards the origin? It is w: {} minus {}. ",
      vertex_text(p.vertex_a, 'A'), vertex_text(p.vertex_b, 'B'));
  if (height > 0)
    step.caption += fmt::format(
        "All of A - B lies beyond the plane through w, so the distance is at least {:.4f} m.",
        height);
  else
    step.caption += "The plane through w lies behind the origin: no lower bound yet.";
}

void GjkRecorder::take_in(const GjkResult& before, const GjkResult& g) {
  upper_.push_back(g.simplex.nearest().vec().norm());
  MicroscopeStep& step = begin("Take w in, drop what is needless", g);
  draw_nearest(step.sketch, g.simplex);
  const int dropped = before.simplex.count + 1 - g.simplex.count;
  step.caption = fmt::format(
      "w joins the simplex, and its point nearest to the origin moves: |v| falls from {:.4f} m to "
      "{:.4f} m. v now lies on {} of {} corner{}; ",
      upper_[upper_.size() - 2], upper_.back(), part_text(g.simplex.count), g.simplex.count,
      g.simplex.count == 1 ? "" : "s");
  step.caption += dropped == 0
                      ? "all are needed to carry it."
                      : fmt::format("{} that {} not carry it {} dropped.", dropped,
                                    dropped == 1 ? "does" : "do", dropped == 1 ? "is" : "are");
}

void GjkRecorder::finish(const GjkResult& g) {
  lower_.push_back(g.lower_bound);
  upper_.back() = g.distance;
  MicroscopeStep& step = begin("The bounds have met", g);
  draw_nearest(step.sketch, g.simplex);
  (void)draw_look(step.sketch, g.simplex.nearest().vec());
  step.caption = fmt::format(
      "The furthest point w towards the origin is no further than v, so nothing of A - B is "
      "nearer: "
      "the distance is {:.6g} m. The mixture of corners that makes v also makes the nearest points "
      "of A and of B.",
      g.distance);
  if (const double r = space_.rounding(); r > 0)
    step.caption +=
        fmt::format(" These are the cores; the rounded bodies are {:.6g} m apart.", g.distance - r);
  out_.answer = g.distance - space_.rounding();
}

void GjkRecorder::finish_overlap(const GjkResult& g) {
  MicroscopeStep& step = begin("The origin is inside", g);
  step.caption = fmt::format(
      "{} holds the origin: some point of A minus some point of B is zero, so the two share a "
      "point and overlap. How deep, GJK cannot say: the expanding polytope algorithm (EPA) goes "
      "on from here.",
      g.simplex.count == 4 ? "The tetrahedron" : "The simplex");
  out_.answer = record_epa(space_, g.simplex, out_.steps);
}

MicroscopeRecording GjkRecorder::run() {
  out_.title = "GJK";
  GjkResult before;
  for (iteration_ = 0; iteration_ <= most_iterations; ++iteration_) {
    GjkOptions options;
    options.max_iterations = iteration_ + 1;  // stops after so many
    const GjkResult g = gjk(space_.a(), space_.b(), options);
    if (iteration_ == 0)
      start(g);
    else if (g.status != GjkStatus::intersecting)
      take_in(before, g);
    if (g.status == GjkStatus::separated) {
      finish(g);
      return std::move(out_);
    }
    if (g.status == GjkStatus::intersecting) {
      finish_overlap(g);
      return std::move(out_);
    }
    look(g);
    before = g;
  }
  out_.answer = upper_.back() - space_.rounding();
  return std::move(out_);
}

}  // namespace

std::string refuse_gjk(const Shape& a, const Shape& b) {
  if (a.convex() && b.convex()) return {};
  return "gjk needs two convex shapes (no half_space, no triangle_mesh)";
}

MicroscopeRecording record_gjk(const MicroscopeSlide& slide) {
  return GjkRecorder(slide).run();
}

}  // namespace tumble
