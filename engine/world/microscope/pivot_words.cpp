#include "engine/world/microscope/pivot_words.hpp"

#include "engine/world/microscope/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

using lcp::PivotEvent;
using lcp::PivotSet;

}  // namespace

PivotNames::PivotNames(const GroupForceProblem& posed, const std::vector<Eigen::Index>& kept) {
  std::vector<Unknown> all(size_t(posed.problem.lcp.size()));
  for (size_t i = 0; i < all.size(); ++i) all[i].text = fmt::format("unknown {}", i);
  for (size_t k = 0; k < posed.problem.points.size(); ++k) {
    const ContactForceProblem::Point& p = posed.problem.points[k];
    for (int i = 0; i < p.count; ++i)
      all[size_t(p.first + i)] = {
          int(k), i > 0, fmt::format("{} of contact {}", i == 0 ? "force" : "friction", k + 1)};
  }
  for (const Eigen::Index i : kept) unknowns.push_back(std::move(all[size_t(i)]));
}

Ink ink_of(PivotSet set) {
  switch (set) {
    case PivotSet::at_lower:
    case PivotSet::at_upper:
      return Ink::faint;
    case PivotSet::clamped:
      return Ink::answer;
    case PivotSet::resting:
      return Ink::second;
    case PivotSet::tied:
      return Ink::first;
  }
  return Ink::plain;
}

std::string event_text(const lcp::PivotStep& step, const PivotNames& names) {
  const std::string& who = step.limiting >= 0 ? names[step.limiting] : names[0];
  switch (step.event) {
    case PivotEvent::none:
      return "nothing stops it";
    case PivotEvent::own_w:
      return "its own acceleration is 0";
    case PivotEvent::own_bound:
      return "it meets its other bound";
    case PivotEvent::bound:
      return fmt::format("the {} meets its bound", who);
    case PivotEvent::apex:
      return fmt::format("the {} is 0: it opens", who);
    case PivotEvent::surface:
      return fmt::format("the {} meets its cone", who);
    case PivotEvent::other_w:
      return fmt::format("the acceleration at the {} is 0", who);
    case PivotEvent::inward:
      return fmt::format("the {} wants back into its cone", who);
  }
  return {};
}

std::string pivot_caption(const lcp::PivotStep& step, const PivotNames& names, double largest) {
  const std::string moved = fmt::format(
      "The {} is driven by {:.4g} N; clamped ones (green) follow so that nothing accelerates "
      "there. ",
      names[step.driven], step.step);
  const bool none = std::fabs(step.step) <= tolerances::no_pivot_step * largest;
  const std::string way =
      none ? fmt::format("The {} should move, but cannot by any length: ", names[step.driven])
           : moved;
  switch (step.event) {
    case PivotEvent::own_w:
      return way + "It ends where its own acceleration is 0: clamped from now on.";
    case PivotEvent::own_bound:
      return way + "It ends at its other bound, and stays there.";
    case PivotEvent::bound:
    case PivotEvent::apex:
      return way + fmt::format(
                       "The {} comes to its bound first and is held there; the drive goes "
                       "on without it.",
                       names[step.limiting]);
    case PivotEvent::surface:
      return way + fmt::format(
                       "The {} comes to the surface of its cone first, and follows its "
                       "normal force from there.",
                       names[step.limiting]);
    case PivotEvent::other_w:
      return way + fmt::format(
                       "The acceleration at the {} comes to 0 first and would change its "
                       "sign: that one is clamped, and the drive goes on.",
                       names[step.limiting]);
    case PivotEvent::inward:
      return way + fmt::format(
                       "The {} would be pushed along its slip: it comes off the surface of "
                       "its cone and is clamped.",
                       names[step.limiting]);
    case PivotEvent::none:
      break;
  }
  return way + "Nothing stops it.";
}

Diagram pivot_bars(const lcp::PivotStep& step, const PivotNames& names, const lcp::VecX& w,
                   double z_most, double w_most) {
  Diagram out;
  out.title = "forces, accelerations";
  const int n = int(step.z.size());
  const auto contacts = std::ranges::count_if(
      names.unknowns,
      [](const PivotNames::Unknown& unknown) { return unknown.point >= 0 && !unknown.lateral; });
  constexpr double left = 0.04, middle = 0.5, tall = 0.38;
  const double pitch = (out.aspect - 2 * left) / std::max(n, 4), bar = 0.7 * pitch;
  for (int i = 0; i < n; ++i) {
    const double x = left + i * pitch;
    const Ink ink = ink_of(step.sets[size_t(i)]);
    const auto add = [&](double share, double side, Ink of, float opacity) {
      const double h = std::clamp(share, 0.0, 1.0) * tall, foot = middle + side * 0.01;
      if (!(h > 0.001)) return;
      Diagram::Box box;
      box.min = {x, side > 0 ? foot : foot - h};
      box.max = {x + bar, side > 0 ? foot + h : foot};
      box.ink = of, box.opacity = opacity;
      out.boxes.push_back(box);
    };
    if (z_most > 0) add(std::fabs(step.z[i]) / z_most, 1, ink, 1);
    // Marked as wrong: acceleration into a constraint, and any acceleration of an unknown whose set
    // allows none.
    const PivotNames::Unknown& u = names.unknowns[size_t(i)];
    const PivotSet set = step.sets[size_t(i)];
    const bool wrong =
        set == PivotSet::resting || (!u.lateral && ((set == PivotSet::at_lower && w[i] < 0) ||
                                                    (set == PivotSet::at_upper && w[i] > 0)));
    if (w_most > 0) add(std::fabs(w[i]) / w_most, -1, wrong ? Ink::active : Ink::plain, 0.8f);
    if (contacts <= 10 && u.point >= 0 && !u.lateral)
      out.labels.push_back(
          {{x + 0.5 * bar, 0.03}, fmt::format("{}", u.point + 1), Ink::plain, {0.5, 0}});
    if (i == step.driven || i == step.limiting)
      out.points.push_back({{x + 0.5 * bar, 0.96}, i == step.driven ? Ink::test : Ink::active, 7});
  }
  out.lines.push_back({{left, middle}, {out.aspect - left, middle}, Ink::plain, 1, false});
  return out;
}

}  // namespace tumble
