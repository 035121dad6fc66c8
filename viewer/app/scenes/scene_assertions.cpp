#include "viewer/app/scenes/scene_assertions.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/quantities.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
std::vector<Fault> assertion_faults(const BuiltScene& scene) {
  std::vector<Fault> out;
  const auto& assertions = scene.description->assertions;
  if (assertions.empty()) return out;
  const auto frame = scene.world->frame();
  for (size_t i = 0; i < assertions.size(); ++i) {
    const auto parsed = Expression::parse(assertions[i].holds);
    if (!parsed) continue;  // reported by validate()
    for (const std::string& name : parsed->names()) {
      if (named_value(scene, *frame, name)) continue;
      const std::string near = nearest_word(name, quantity_names(scene));
      out.push_back(fault_at(*scene.description, fmt::format("assertions[{}].holds", i),
                             fmt::format("unknown quantity '{}'{}", name,
                                         near.empty() ? "" : ", did you mean '" + near + "'?")));
    }
  }
  return out;
}

std::shared_ptr<SceneAssertions> SceneAssertions::make(const BuiltScene& scene) {
  std::shared_ptr<SceneAssertions> out(new SceneAssertions);
  for (const AssertionDescription& d : scene.description->assertions) {
    auto condition = Expression::parse(d.holds);
    if (!condition) continue;  // cannot happen in a scene that validate() accepts
    One& one = out->all_.emplace_back();
    one.view.title = d.title;
    one.view.text = d.holds;
    one.view.at = d.at;
    one.view.always = d.always;
    one.condition = *std::move(condition);
  }
  if (out->all_.empty()) return nullptr;
  out->names_ = names_of(scene);
  return out;
}

void SceneAssertions::judge(One& one, const Frame& frame) {
  const auto lookup = [&](std::string_view name) { return named_value(*names_, frame, name); };
  const auto value = one.condition.evaluate(lookup);
  AssertionView& view = one.view;
  view.decided = frame.time;
  view.verdict = value && *value != 0 ? Verdict::holds : Verdict::fails;
  view.values.clear();
  if (view.verdict == Verdict::holds) return;
  if (!value) view.values = value.error().text() + "\n";
  for (const std::string& name : one.condition.names())
    if (const auto v = lookup(name)) view.values += fmt::format("{} = {}\n", name, *v);
}

void SceneAssertions::see(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  const double half = 0.5 * frame.rate.tick();
  for (One& one : all_) {
    const AssertionView& view = one.view;
    if (view.always) {
      if (view.verdict != Verdict::fails && frame.time >= view.at.value_or(0) - half)
        judge(one, frame);
    } else if (view.at && view.verdict == Verdict::waiting) {
      if (frame.time >= *view.at - half && frame.time < *view.at + half) judge(one, frame);
    }
  }
}

void SceneAssertions::go_to(const Frame& frame) {
  {
    const std::lock_guard lock(mutex_);
    const double half = 0.5 * frame.rate.tick();
    for (One& one : all_)
      if (one.view.decided > frame.time - half || !(one.view.always || one.view.at)) {
        one.view.verdict = Verdict::waiting;
        one.view.decided = 0;
        one.view.values.clear();
      }
  }
  see(frame);
}

void SceneAssertions::finish(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  for (One& one : all_)
    if (!one.view.always && !one.view.at) judge(one, frame);
}

std::vector<AssertionView> SceneAssertions::views() const {
  const std::lock_guard lock(mutex_);
  std::vector<AssertionView> out;
  for (const One& one : all_) out.push_back(one.view);
  return out;
}

SceneAssertions::Span SceneAssertions::span(double unsaid) const {
  double last = 0, begin = 0;
  for (const One& one : all_) {
    double& latest = one.view.always ? begin : last;
    latest = std::max(latest, one.view.at.value_or(0));
  }
  if (last > begin) return {last, false};
  return {begin + unsaid, true};
}

double SceneAssertions::last_moment() const {
  double last = 0;
  for (const One& one : all_) last = std::max(last, one.view.at.value_or(0));
  return last;
}

std::string verdict_text(const std::vector<AssertionView>& assertions) {
  std::string out;
  for (const AssertionView& a : assertions) {
    const std::string& name = a.title.empty() ? a.text : a.title;
    if (a.verdict == Verdict::fails) {
      out += fmt::format("assertion of the scene failed after {:g} s: {}\n", a.decided, name);
      if (!a.title.empty()) out += "  " + a.text + "\n";
      size_t begin = 0;
      while (begin < a.values.size()) {
        const size_t end = a.values.find('\n', begin);
        out += "  " + a.values.substr(begin, end - begin) + "\n";
        begin = end + 1;
      }
    } else if (a.verdict == Verdict::waiting) {
      out += fmt::format("assertion of the scene not reached ({}): {}\n", when_text(a), name);
    }
  }
  return out;
}

bool any_fails(const std::vector<AssertionView>& assertions) {
  return std::ranges::any_of(assertions,
                             [](const AssertionView& a) { return a.verdict == Verdict::fails; });
}

bool any_waits(const std::vector<AssertionView>& assertions) {
  return std::ranges::any_of(assertions,
                             [](const AssertionView& a) { return a.verdict == Verdict::waiting; });
}

}  // namespace tumble
