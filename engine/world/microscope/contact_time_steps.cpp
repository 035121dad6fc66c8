#include "engine/world/microscope/contact_time_steps.hpp"

#include "engine/collision/continuous/advancement.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/world/microscope/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr int curve_points = 96;

bool is_plane(const Shape& s) {
  return s.is_half_space();
}

class AdvanceRecorder {
 public:
  explicit AdvanceRecorder(const MicroscopeSlide& slide) : slide_(slide) {}

  MicroscopeRecording run();

 private:
  const Motion& motion(size_t i) const { return slide_.body[i].motion; }
  double end() const { return motion(0).t1; }
  TimeOfContact search(double t0, double t1, ContactTimeTrace* trace) const;
  double distance_at(double t) const;
  void measure_curve();
  void add(size_t i);
  void describe(size_t i, MicroscopeStep& step) const;
  void draw(size_t i, Sketch& out) const;
  void draw_path(Sketch& out) const;
  void draw_plot(size_t i, Diagram& out) const;
  void end_apart();

  const MicroscopeSlide& slide_;
  MicroscopeRecording out_;
  ContactTimeTrace trace_;
  TimeOfContact result_;
  std::vector<Vec2> curve_;  ///< (time, distance), for the plot only
};

/// The same search as in time_of_contact() for convex pairs.
TimeOfContact AdvanceRecorder::search(double t0, double t1, ContactTimeTrace* trace) const {
  const Shape &a = *slide_.body[0].shape, &b = *slide_.body[1].shape;
  const auto core = [&](size_t i) {
    const Shape& s = *slide_.body[i].shape;
    return MovingCore{*s.convex(), motion(i), motion(i).lever(s.bounding_radius()),
                      s.bounding_radius() - s.convex()->rounding()};
  };
  if (is_plane(a)) return advance_half_space(motion(0), core(1), t0, t1, slide_.tolerance, trace);
  if (!is_plane(b)) return advance(core(0), core(1), t0, t1, slide_.tolerance, trace);
  TimeOfContact r = advance_half_space(motion(1), core(0), t0, t1, slide_.tolerance, trace);
  std::swap(r.on_a, r.on_b);
  if (trace)
    for (ContactTimeProbe& p : *trace) {
      std::swap(p.on_a, p.on_b);
      p.normal = -p.normal;
    }
  return r;
}

/// The distance at one time, for the plot only; the search makes its own queries.
double AdvanceRecorder::distance_at(double t) const {
  const Pose pose[2] = {motion(0).pose(t), motion(1).pose(t)};
  const size_t plane = is_plane(*slide_.body[0].shape) ? 0 : 1;
  if (is_plane(*slide_.body[plane].shape)) {
    const ConvexShape& core = *slide_.body[1 - plane].shape->convex();
    const Vec3 up = pose[plane].direction(Vec3::UnitY());
    const Pose& other = pose[1 - plane];
    const Vec3 lowest = other.point(core.support(other.inverse_direction(-up)));
    return up.dot(lowest - pose[plane].x) - core.rounding();
  }
  const ConvexShape &a = *slide_.body[0].shape->convex(), &b = *slide_.body[1].shape->convex();
  const GjkResult g =
      gjk(PlacedCore(a, pose[0].q, Vec3::Zero()), PlacedCore(b, pose[1].q, pose[1].x - pose[0].x));
  return g.distance - a.rounding() - b.rounding();
}

/// The distance over the whole span, which the search does not compute.
void AdvanceRecorder::measure_curve() {
  for (int i = 0; i <= curve_points; ++i) {
    const double t = end() * i / curve_points;
    curve_.push_back({t, std::max(0.0, distance_at(t))});
  }
}

/// Draws the paths of the bodies faintly.
void AdvanceRecorder::draw_path(Sketch& out) const {
  for (size_t i = 0; i < 2; ++i) {
    if (is_plane(*slide_.body[i].shape)) continue;
    const Ink ink = i == 0 ? Ink::first : Ink::second;
    Vec3 last = motion(i).carrier(0).x;
    for (int k = 1; k <= 24; ++k) {
      const Vec3 next = motion(i).carrier(end() * k / 24).x;
      if (k % 2 == 1 && next != last) out.line(last, next, ink, 1.5f);
      last = next;
    }
  }
}

void AdvanceRecorder::draw(size_t i, Sketch& out) const {
  const ContactTimeProbe& p = trace_[i];
  draw_path(out);
  for (size_t body = 0; body < 2; ++body) {
    if (is_plane(*slide_.body[body].shape)) continue;
    const Motion& m = motion(body);
    const bool moves = !m.velocity.isZero() || !m.omega.isZero();
    const Pose now = m.pose(p.time);
    if (moves && p.time > 0) out.ghosts.push_back({body, m.pose(0), 0, true});
    if (moves && p.high > p.time) out.ghosts.push_back({body, m.pose(p.high), 0.12f, true});
    out.ghosts.push_back({body, now, 0.9f, true});
    const Aabb bounds = slide_.body[body].shape->bounds(now);
    out.label(Vec3(bounds.centre().x(), bounds.max.y() + 0.12 * bounds.extent().norm(),
                   bounds.centre().z()),
              body == 0 ? "A" : "B", body == 0 ? Ink::first : Ink::second);
  }
  if (p.distance > 0) {
    out.line(p.on_a, p.on_b, Ink::answer, 3.5f);
    out.point(p.on_a, Ink::answer, 10);
    out.point(p.on_b, Ink::answer, 10);
  }
}

void AdvanceRecorder::draw_plot(size_t i, Diagram& out) const {
  out.title = "distance over time";
  out.labels.push_back({{out.aspect - 0.06, 0.82}, "may touch", Ink::active, {1, 1}});
  double top = 0;
  for (const Vec2& p : curve_) top = std::max(top, p.y());
  Chart chart(out, 0, end(), 0, 1.05 * top, "t", "distance");
  const ContactTimeProbe& now = trace_[i];
  chart.band(now.low, now.high, Ink::active, 0.22f);
  chart.curve(curve_, Ink::plain, 1.5f);
  for (size_t k = 0; k <= i; ++k) {
    const ContactTimeProbe& p = trace_[k];
    if (p.speed > 0) {
      const double until = std::min(end(), p.time + p.distance / p.speed);
      chart.line({p.time, p.distance}, {until, p.distance - p.speed * (until - p.time)}, Ink::test,
                 k == i ? 2.5f : 1.5f);
    }
    chart.line({p.time, 0}, {p.time, p.distance}, Ink::answer, k == i ? 2.5f : 1);
    chart.point({p.time, p.distance}, Ink::answer, k == i ? 9 : 6);
  }
}

void AdvanceRecorder::describe(size_t i, MicroscopeStep& step) const {
  const ContactTimeProbe& p = trace_[i];
  step.numbers = {{"query", fmt::format("{}", i + 1)},
                  {"t", fmt::format("{:.6f} s", p.time)},
                  {"distance", fmt::format("{:.6f} m", p.distance)},
                  {"contact not before", fmt::format("{:.6f} s", p.low)}};
  if (p.speed > 0)
    step.numbers.push_back({"closing speed up to", fmt::format("{:.3f} m/s", p.speed)});
  if (result_.hit() && i + 1 == trace_.size()) {
    step.title = "The contact is bracketed";
    step.caption = fmt::format(
        "One look ahead: at t = {:.6f} s the bodies {}. They were {:.2g} m apart at t = {:.6f} s, "
        "which is the answer, and it is never past the contact.",
        p.time,
        p.distance > 0 ? fmt::format("are {:.2g} m apart", p.distance) : std::string("overlap"),
        result_.distance_low, result_.time);
  } else if (p.distance <= slide_.tolerance) {
    step.title = "Near enough";
    step.caption = fmt::format(
        "At t = {:.6f} s the bodies are {:.2g} m apart, within the tolerance of {:.2g} m: this is "
        "the time of contact.",
        p.time, p.distance, slide_.tolerance);
  } else {
    const double until = p.speed > 0 ? p.time + p.distance / p.speed : end();
    step.title = fmt::format("Distance query {} at t = {:.4f} s", i + 1, p.time);
    step.caption = fmt::format(
        "The bodies are {:.4f} m apart. No points of the two close in along this gap faster than "
        "{:.3f} m/s, turning included, so nothing can touch before t = {:.4f} s",
        p.distance, p.speed, std::min(until, end()));
    step.caption += until < end() ? ": go there and measure again. In the plot, the slanted line "
                                    "never overtakes the true curve."
                                  : ", the end of the span.";
  }
}

void AdvanceRecorder::add(size_t i) {
  MicroscopeStep& step = out_.steps.emplace_back();
  describe(i, step);
  draw(i, step.sketch);
  draw_plot(i, step.diagram);
}

void AdvanceRecorder::end_apart() {
  if (result_.hit()) return;
  MicroscopeStep& last = out_.steps.back();
  if (result_.status == TimeOfContactStatus::initially_overlapping)
    last.caption = "The bodies are within the tolerance, or overlap, from the start.";
  else
    last.caption += fmt::format(" There is no contact up to t = {:.4f} s.", result_.time);
}

MicroscopeRecording AdvanceRecorder::run() {
  out_.title = "Conservative advancement";
  result_ = search(0, end(), &trace_);
  measure_curve();
  for (size_t i = 0; i < trace_.size(); ++i) add(i);
  end_apart();
  out_.answer = result_.hit() ? result_.time : std::numeric_limits<double>::infinity();
  return std::move(out_);
}

}  // namespace

std::string refuse_contact_time(const Shape& a, const Shape& b) {
  const bool fine = (a.convex() && (b.convex() || is_plane(b))) || (is_plane(a) && b.convex());
  return fine ? "" : "time_of_contact needs convex shapes, or one and a half_space";
}

MicroscopeRecording record_contact_time(const MicroscopeSlide& slide) {
  return AdvanceRecorder(slide).run();
}

}  // namespace tumble
