#include "engine/world/microscope/event_steps.hpp"

#include "engine/world/microscope/chart.hpp"
#include "engine/world/microscope/world_copy.hpp"
#include "engine/world/tick_watch.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Limits of the ticks that are searched, and of the curves in the plot.
constexpr uint64_t most_ticks = 600;
constexpr size_t most_curves = 24;

using Kind = WatchedValue::Kind;

std::string_view unit_of(Kind kind) {
  switch (kind) {
    case Kind::gap:
    case Kind::pieces:
      return "m";
    case Kind::slip:
      return "m/s";
    case Kind::rolling:
    case Kind::spinning:
      return "rad/s";
    case Kind::limit:
    case Kind::rate:
      break;
  }
  return "";
}

std::string_view event_of(Kind kind) {
  switch (kind) {
    case Kind::gap:
    case Kind::pieces:
      return "a gap closes";
    case Kind::slip:
      return "a slip ends";
    case Kind::limit:
      return "a joint reaches its limit";
    case Kind::rate:
      return "a motor or brake reaches its rate";
    case Kind::rolling:
      return "a rolling ends";
    case Kind::spinning:
      return "a spinning ends";
  }
  return "";
}

std::string value_text(double f, Kind kind) {
  return fmt::format("{:+.3e} {}", f, unit_of(kind));
}

class SearchRecorder {
 public:
  SearchRecorder(const World& world, const MicroscopeSetup& setup)
      : setup_(setup), frame_(world.frame()) {}

  Result<MicroscopeRecording> run(World& copy);

 private:
  Status look_ahead(World& copy);
  MicroscopeStep& add(const SearchLook& at, double low, double high);
  void add_start();
  void add_looks();
  void add_root();
  void add_end();
  void draw(const Pose& pose, MicroscopeStep& step) const;
  void draw_plot(double until, double low, double high, Diagram& out) const;
  std::string name(const WatchedValue& value) const;
  const WatchedValue& first() const { return search_.watched[size_t(search_.first)]; }
  bool found() const { return search_.first != EventSearch::none; }

  const MicroscopeSetup& setup_;
  std::shared_ptr<const Frame> frame_;
  TickWatch watch_;
  EventSearch search_;   ///< the search that is shown
  size_t searches_ = 0;  ///< number of searches before it, in all ticks
  double begin_ = 0;     ///< start of its step, from now on [s]
  /// Path of the body, by tick.
  std::vector<Vec3> way_;
  MicroscopeRecording out_;
};

/// Steps until a search finds an event; if none does, the last search is shown.
Status SearchRecorder::look_ahead(World& copy) {
  const double tick = copy.settings().tick.tick();
  const auto ticks = uint64_t(std::clamp(std::ceil(setup_.span / tick), 1.0, double(most_ticks)));
  watch_.body = setup_.a;
  copy.watch_with(&watch_);
  const auto where = [&] { return copy.body(setup_.a)->pose.x; };
  for (uint64_t k = 0; k < ticks; ++k) {
    way_.push_back(where());
    watch_.searches.searches.clear();
    if (auto stepped = copy.step(); !stepped) return stepped.error();
    auto& all = watch_.searches.searches;
    for (size_t i = 0; i < all.size(); ++i) {
      // A step that is tried again from the same time ends at the event of the last try.
      while (all[i].first != EventSearch::none && i + 1 < all.size() &&
             all[i + 1].begin == all[i].begin && all[i + 1].first != EventSearch::none)
        ++i;
      begin_ = double(k) * tick + all[i].begin;
      search_ = std::move(all[i]);
      if (found()) return {};
      ++searches_;
    }
    if (!copy.body(setup_.a)) break;
  }
  if (searches_ > 0) return {};
  return Error{ErrorCode::not_found,
               "no step of this body was searched: it rests alone, or time-stepping moves it",
               {},
               {}};
}

std::string SearchRecorder::name(const WatchedValue& v) const {
  const std::string bodies = v.a == ~uint32_t{0}
                                 ? std::string("a joint")
                                 : body_text(*frame_, v.a) + " and " + body_text(*frame_, v.b);
  switch (v.kind) {
    case Kind::gap:
      return "gap of " + bodies;
    case Kind::pieces:
      return "room of " + bodies;
    case Kind::slip:
      return "slip of " + bodies;
    case Kind::limit:
      return "room to the limit of a joint";
    case Kind::rate:
      return "what a joint lacks of its rate";
    case Kind::rolling:
      return "rolling of " + bodies;
    case Kind::spinning:
      return "spinning of " + bodies;
  }
  return bodies;
}

void SearchRecorder::draw(const Pose& pose, MicroscopeStep& step) const {
  Sketch& out = step.sketch;
  const BodyInfo& info = frame_->info(setup_.a.index);
  for (size_t k = 1; k < way_.size(); ++k) out.line(way_[k - 1], way_[k], Ink::plain, 1.5f);
  draw_outline(out, info, search_.looks.front().pose, Ink::faint, 1.5f);
  draw_outline(out, info, pose, Ink::active, 2.5f);
  for (size_t i = 0; i < search_.watched.size(); ++i) {
    const WatchedValue& v = search_.watched[i];
    if (v.a == ~uint32_t{0}) continue;
    out.point(v.x_world, int(i) == search_.first ? Ink::answer : Ink::test,
              int(i) == search_.first ? 12 : 8);
  }
}

/// Plots every function relative to its greatest absolute value, so that all signs are visible.
void SearchRecorder::draw_plot(double until, double low, double high, Diagram& out) const {
  out.title = "values over the step";
  Chart chart(out, 0, search_.step, -1, 1, "t", "");
  if (high > low) chart.band(low, high, Ink::active, 0.25f);
  chart.line({0, 0}, {search_.step, 0}, Ink::plain, 1);
  size_t curves = 0;
  for (size_t i = 0; i < search_.watched.size(); ++i) {
    const bool comes_first = int(i) == search_.first;
    if (!comes_first && ++curves > most_curves) continue;
    std::vector<Vec2> points;
    double most = 0;
    for (const SearchLook& l : search_.looks)
      if (l.value == i) most = std::max(most, std::fabs(l.f));
    for (const SearchLook& l : search_.looks)
      if (l.value == i && most > 0 && l.time <= until) points.push_back({l.time, l.f / most});
    std::sort(points.begin(), points.end(),
              [](const Vec2& p, const Vec2& q) { return p.x() < q.x(); });
    const Ink ink = comes_first ? Ink::answer : Ink::test;
    chart.curve(points, ink, comes_first ? 2.5f : 1.2f);
    for (const Vec2& p : points) chart.point(p, p.y() > 0 ? ink : Ink::active, 6);
  }
}

MicroscopeStep& SearchRecorder::add(const SearchLook& at, double low, double high) {
  MicroscopeStep& step = out_.steps.emplace_back();
  draw(at.pose, step);
  step.numbers.push_back({"step begins", fmt::format("{:.6f} s from now", begin_)});
  step.numbers.push_back({"tried", fmt::format("{:+.9f} s", at.time)});
  step.numbers.push_back({"watched", fmt::format("{} values", search_.watched.size())});
  if (high > low) {
    step.numbers.push_back({"event not before", fmt::format("{:+.9f} s", low)});
    step.numbers.push_back({"event by", fmt::format("{:+.9f} s", high)});
    step.numbers.push_back({"bracket", fmt::format("{:.2g} s", high - low)});
  }
  return step;
}

void SearchRecorder::add_start() {
  MicroscopeStep& step = add(search_.looks.front(), 0, 0);
  size_t gaps = 0, others = 0;
  for (const WatchedValue& v : search_.watched)
    ++(v.kind == Kind::gap || v.kind == Kind::pieces ? gaps : others);
  draw_plot(0, 0, 0, step.diagram);
  step.title = fmt::format("A step of {:.4g} s is taken on trial", search_.step);
  step.caption = fmt::format(
      "It begins {:.4f} s from now; {} searches before it found nothing. Watched are {} gaps and "
      "{} "
      "slips and the like, each positive until its event. The first zero of any ends the step.",
      begin_, searches_, gaps, others);
}

/// Adds a step for each time at which the functions were evaluated.
void SearchRecorder::add_looks() {
  const auto& looks = search_.looks;
  double last = 0;
  for (size_t i = 0; i < looks.size(); ++i) {
    if (looks[i].stage != SearchLook::Stage::look) continue;
    size_t end = i, below = 0, all = 0;
    for (; end < looks.size() && looks[end].stage == SearchLook::Stage::look &&
           looks[end].time == looks[i].time;
         ++end) {
      ++all;
      below += looks[end].f > 0 ? 0 : 1;
    }
    const double time = looks[i].time;
    if (time > last || below > 0) {
      MicroscopeStep& step = add(looks[i], below > 0 ? last : 0, below > 0 ? time : 0);
      draw_plot(time, below > 0 ? last : 0, below > 0 ? time : 0, step.diagram);
      step.title = fmt::format("Try t = {:.6f} s: {}", time, below > 0 ? "below 0" : "all above 0");
      step.caption =
          below > 0 ? fmt::format(
                          "{} of {} values looked at here are no longer positive: their event is "
                          "between the last time tried and this one. That bracket is narrowed "
                          "next.",
                          below, all)
                    : fmt::format(
                          "All {} values looked at here are still positive: no event up to this "
                          "time. On to the next.",
                          all);
    }
    last = std::max(last, below > 0 ? last : time);
    i = end - 1;
  }
}

void SearchRecorder::add_root() {
  int n = 0;
  for (const SearchLook& l : search_.looks) {
    if (l.stage != SearchLook::Stage::root || int(l.value) != search_.first) continue;
    MicroscopeStep& step = add(l, l.low, l.high);
    step.numbers.push_back({"value there", value_text(l.f, first().kind)});
    draw_plot(std::numeric_limits<double>::infinity(), l.low, l.high, step.diagram);
    step.title = fmt::format("Narrow the bracket: try {}", ++n);
    step.caption = fmt::format(
        "The {} is {} at t = {:.9f} s, so the event is {} it. The next time is where the line "
        "through both ends is 0; an end that stays counts half, lest it stay for ever (Illinois).",
        name(first()), l.f > 0 ? "positive" : "negative", l.time, l.f > 0 ? "after" : "before");
  }
}

void SearchRecorder::add_end() {
  SearchLook last = search_.looks.back();
  for (const SearchLook& l : search_.looks)
    if (found() && int(l.value) == search_.first && l.time == search_.found) last = l;
  MicroscopeStep& step = add(last, 0, 0);
  draw_plot(std::numeric_limits<double>::infinity(), 0, 0, step.diagram);
  if (!found()) {
    step.title = "No event";
    step.caption = fmt::format(
        "Nothing that is watched comes to 0 within {:.4g} s from now: each step is kept as it was "
        "taken.",
        begin_ + search_.step);
    out_.answer = std::numeric_limits<double>::infinity();
    return;
  }
  out_.answer = begin_ + search_.found;
  step.numbers.push_back({"event", fmt::format("{:.9f} s from now", out_.answer)});
  step.title = fmt::format("First event: {}", event_of(first().kind));
  step.caption = fmt::format(
      "The {} comes to 0 first, {:.6f} s from now. The step is taken again and ends there; then "
      "what collides, closes or stops is resolved, and the next step begins.",
      name(first()), out_.answer);
}

Result<MicroscopeRecording> SearchRecorder::run(World& copy) {
  out_.title = "Search for the first event";
  const BodyInfo& info = frame_->info(setup_.a.index);
  out_.see_through = {setup_.a};
  out_.size = body_size(info);
  if (const Status done = look_ahead(copy); !done) return done.error();
  if (search_.looks.empty())
    return Error{ErrorCode::not_found,
                 fmt::format("no gap, slip or joint is near an event within {:.3g} s from now",
                             begin_ + search_.step),
                 {},
                 {}};
  add_start();
  add_looks();
  if (found()) add_root();
  add_end();
  return std::move(out_);
}

}  // namespace

std::string refuse_first_event(const Frame& frame, const MicroscopeSetup& setup) {
  return moving_body_refusal(frame, setup.a, "the events that come to it");
}

Result<MicroscopeRecording> record_first_event(const World& world, const MicroscopeSetup& setup) {
  auto copy = copy_of(world, "event");
  if (!copy) return copy.error();
  return SearchRecorder(world, setup).run(**copy);
}

}  // namespace tumble
