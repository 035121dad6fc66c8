#include "engine/world/microscope/v_clip_words.hpp"

#include <algorithm>
#include <cctype>
#include <span>

#include <fmt/format.h>

namespace tumble {
namespace {

/// One transition of the diagram: the feature that changes, what it becomes, and the feature of the
/// other body. In the text {0} is the feature that changes, {1} the new one, {2} the other body's.
struct Transition {
  int number;
  FeatureKind from, to, other;
  const char* words;
};
std::span<const Transition> all_transitions() {
  using enum FeatureKind;
  static constexpr Transition list[] = {
      {1, vertex, edge, vertex,
       "{2} lies beyond the plane across an edge at {0}: along {1} it comes nearer."},
      {2, edge, vertex, vertex,
       "{2} lies beyond the plane at an end of {0}: no point between is as near as that end, {1}."},
      {3, vertex, edge, edge,
       "The nearest point of {2} lies beyond a plane at {0}: it is nearer to {1}."},
      {4, edge, vertex, edge,
       "The nearest point of {2} lies beyond the plane at an end of {0}: it is nearer to {1}."},
      {5, edge, face, vertex,
       "{2} lies beyond the upright plane along {0}, over {1}: inside that face it is nearer."},
      {6, face, edge, vertex,
       "{2} is not over {0}: it lies beyond the upright plane along {1}, the one violated most."},
      {7, edge, face, edge,
       "The nearest point of {2} lies beyond the upright plane along {0}, over {1}."},
      {8, face, edge, edge,
       "Where {2} comes nearest to the plane of {0} it is no longer over that face: it left "
       "through "
       "{1}."},
      {9, vertex, edge, face, "{1} leads from {0} down towards {2}: its points are nearer."},
      {10, face, face, vertex,
       "{2} is below {0} and none of its edges rises: a local minimum. The face whose plane is "
       "furthest from it is {1}."},
      {11, edge, vertex, face, "The nearer end of {0} is over {2}: only that end, {1}, counts."},
      {14, face, vertex, edge, "{2} passes {0} by; of its outline the corner {1} is nearest."},
  };
  return list;
}

/// Positions of the five states in the diagram.
struct StatePlace {
  const char* name;
  Vec2 x;
};
const StatePlace state_places[] = {
    {"V-V", {0.25, 0.76}}, {"V-E", {0.8, 0.76}},  {"E-E", {1.35, 0.76}},
    {"V-F", {0.8, 0.34}},  {"E-F", {1.35, 0.34}},
};
Vec2 place_of(const std::string& state) {
  for (const StatePlace& p : state_places)
    if (state == p.name) return p.x;
  return {0.8, 0.34};
}

}  // namespace

std::string feature_text(const PolyhedronFeature& f, size_t body) {
  const char* kinds[] = {"vertex", "edge", "face"};
  const char* kind = kinds[size_t(f.kind)];
  return fmt::format("{} {} of {}", kind, f.index, body == 0 ? 'A' : 'B');
}

std::string state_text(const ClosestFeatures& at) {
  const auto letter = [](FeatureKind k) { return "VEF"[size_t(k)]; };
  const FeatureKind low = std::min(at[0].kind, at[1].kind), high = std::max(at[0].kind, at[1].kind);
  return fmt::format("{}-{}", letter(low), letter(high));
}

std::optional<VClipMove> v_clip_move(const ClosestFeatures& from, const ClosestFeatures& to) {
  if (from == to) return std::nullopt;
  VClipMove move;
  move.body = from[0] == to[0] ? 1 : 0;
  const PolyhedronFeature &was = from[move.body], &now = to[move.body],
                          &other = from[1 - move.body];
  for (const Transition& t : all_transitions()) {
    if (t.from != was.kind || t.to != now.kind || t.other != other.kind) continue;
    move.number = t.number;
    move.sentence = fmt::format(fmt::runtime(t.words), feature_text(was, move.body),
                                feature_text(now, move.body), feature_text(other, 1 - move.body));
    move.sentence.front() = char(std::toupper(uint8_t(move.sentence.front())));
  }
  return move;
}

Diagram v_clip_diagram(const ClosestFeatures& at, const std::optional<ClosestFeatures>& next,
                       bool penetrating) {
  Diagram out;
  out.title = "states of V-Clip";
  const Vec2 half(0.17, 0.1);
  const std::string now = state_text(at);
  const auto join = [&](const char* a, const char* b) {
    const Vec2 p = place_of(a), q = place_of(b), d = (q - p).normalized();
    const Vec2 step(d.x() * half.x(), d.y() * half.y());
    out.lines.push_back({p + step, q - step, Ink::plain, 1.5f, false});
  };
  join("V-V", "V-E");
  join("V-E", "E-E");
  join("V-E", "V-F");
  join("E-E", "E-F");
  join("V-F", "E-F");
  if (next && state_text(*next) != now) {
    const Vec2 p = place_of(now), q = place_of(state_text(*next)), d = (q - p).normalized();
    const Vec2 step(d.x() * half.x(), d.y() * half.y());
    out.lines.push_back({p + step, q - step, Ink::test, 3, true});
    if (const auto move = v_clip_move(at, *next))
      out.labels.push_back({0.5 * (p + q) + Vec2(-0.09 * d.y() - 0.0, 0.09 * std::abs(d.x())),
                            fmt::format("{}", move->number),
                            Ink::test,
                            {0.5, 0.5}});
  }
  for (const StatePlace& p : state_places) {
    const bool lit = now == p.name;
    out.boxes.push_back(
        {p.x - half, p.x + half, lit ? Ink::active : Ink::plain, lit ? 0.9f : 0.3f});
    out.labels.push_back({p.x, p.name, Ink::plain, {0.5, 0.5}});
  }
  if (!next)
    out.labels.push_back(
        {{0.8, 0.1}, penetrating ? "end: penetrating" : "end: separated", Ink::answer, {0.5, 0.5}});
  return out;
}

}  // namespace tumble
