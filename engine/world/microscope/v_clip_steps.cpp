#include "engine/world/microscope/v_clip_steps.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/world/microscope/feature_space.hpp"
#include "engine/world/microscope/v_clip_words.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

const VoronoiPolyhedron* planes_of(const Shape& shape) {
  return shape.convex() ? shape.convex()->voronoi() : nullptr;
}

/// What the last pair of the walk implies.
std::string end_text(const VClipResult& r, const ClosestFeatures& last) {
  const std::string pair =
      fmt::format("{} and {}", feature_text(last[0], 0), feature_text(last[1], 1));
  if (r.state == VClipState::penetrating)
    return fmt::format(
        "{}: parts of one lie on both sides of the other, or below all of its faces. The bodies "
        "overlap (transition {}).",
        pair, state_text(last) == "V-F" ? 13 : 12);
  if (r.answer != VClipAnswer::walk)
    return fmt::format(
        "The walk at {} could not decide within rounding; a search over all near features answers: "
        "{:.6g} m.",
        pair, r.distance);
  return fmt::format(
      "No test names a neighbour: the nearest point of each lies in the region of the other. So "
      "{} are the closest features of the bodies, {:.6g} m apart.",
      pair, r.distance);
}

class WalkRecorder {
 public:
  explicit WalkRecorder(const MicroscopeSlide& slide) : space_(slide) {}

  MicroscopeRecording run() {
    out_.title = "V-Clip";
    VClipOptions options;
    options.trace = &trace_;
    result_ = v_clip(space_.a(), space_.b(), options);
    out_.answer = result_.distance;
    if (trace_.empty()) overlap_at_once();
    for (size_t i = 0; i < trace_.size(); ++i) add(i);
    return std::move(out_);
  }

 private:
  void overlap_at_once() {
    MicroscopeStep& step = out_.steps.emplace_back();
    step.title = "Overlap at first sight";
    step.caption =
        result_.state == VClipState::invalid
            ? "The poses are not finite, or too far apart for double precision."
            : "The balls inside the two bodies overlap already, so the bodies do: no walk is "
              "needed.";
    step.numbers = {{"pairs examined", "0"}};
    space_.draw(step.sketch);
  }

  void add(size_t i) {
    const ClosestFeatures& at = trace_[i];
    const bool last = i + 1 == trace_.size();
    const double distance = space_.nearest(at).distance;
    MicroscopeStep& step = out_.steps.emplace_back();
    step.title =
        fmt::format("{}: {}, {}", state_text(at), feature_text(at[0], 0), feature_text(at[1], 1));
    step.numbers = {{"state", state_text(at)},
                    {"pairs examined", fmt::format("{}", i + 1)},
                    {"distance of the pair", fmt::format("{:.4f} m", distance)}};
    space_.draw(step.sketch);
    space_.draw_features(step.sketch, at);
    std::optional<ClosestFeatures> next;
    if (last) {
      step.caption = end_text(result_, at);
    } else {
      next = trace_[i + 1];
      describe(step, at, *next);
      if (i == 0)
        step.caption =
            "The walk starts at the corners furthest towards the other body. " + step.caption;
    }
    step.diagram = v_clip_diagram(at, next, result_.state == VClipState::penetrating);
  }

  void describe(MicroscopeStep& step, const ClosestFeatures& at, const ClosestFeatures& next) {
    const auto move = v_clip_move(at, next);
    if (!move) return;
    step.caption = move->sentence + fmt::format(" Transition {}: {} becomes {}.", move->number,
                                                feature_text(at[move->body], move->body),
                                                feature_text(next[move->body], move->body));
    step.numbers.push_back({"transition", fmt::format("{}", move->number)});
    space_.draw_crossed_plane(step.sketch, at[move->body], next[move->body], move->body);
  }

  FeatureSpace space_;
  MicroscopeRecording out_;
  std::vector<ClosestFeatures> trace_;
  VClipResult result_;
};

}  // namespace

std::string refuse_v_clip(const Shape& a, const Shape& b) {
  if (planes_of(a) && planes_of(b)) return {};
  return "v_clip needs two polyhedra (box, convex_hull)";
}

MicroscopeRecording record_v_clip(const MicroscopeSlide& slide) {
  return WalkRecorder(slide).run();
}

}  // namespace tumble
