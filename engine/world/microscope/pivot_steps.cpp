#include "engine/world/microscope/pivot_steps.hpp"

#include "engine/math/lcp/pivoting/baraff.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/validate.hpp"
#include "engine/world/microscope/pivot_words.hpp"
#include "engine/world/microscope/tolerances.hpp"
#include "engine/world/microscope/world_copy.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

using lcp::PivotSet;
using lcp::PivotStep;

/// At most so many contacts are numbered in the picture.
constexpr size_t most_labels = 24;
/// Limit of recorded pivots: the world waits meanwhile.
constexpr int most_pivots = 3000;

bool turns_or_slides(const lcp::LcpProblem& problem, Eigen::Index i) {
  return std::any_of(problem.groups.begin(), problem.groups.end(), [i](const lcp::ConeGroup& g) {
    return i == g.axial || i == g.lateral[0] || i == g.lateral[1];
  });
}

/// Indices of normal forces and of bounded rows, without friction forces and torques.
std::vector<Eigen::Index> without_friction(const ContactForceProblem& problem) {
  std::vector<char> normal(size_t(problem.lcp.size()), 0);
  for (const auto& p : problem.points) normal[size_t(p.first)] = 1;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < problem.lcp.size(); ++i)
    if (normal[size_t(i)] || !turns_or_slides(problem.lcp, i)) kept.push_back(i);
  return kept;
}

std::vector<Eigen::Index> all_of(const lcp::LcpProblem& problem) {
  std::vector<Eigen::Index> kept(size_t(problem.size()));
  for (size_t i = 0; i < kept.size(); ++i) kept[i] = Eigen::Index(i);
  return kept;
}

class PivotRecorder {
 public:
  PivotRecorder(const World& world, const GroupForceProblem& posed, bool friction)
      : frame_(world.frame()),
        posed_(posed),
        friction_(friction),
        kept_(friction ? all_of(posed.problem.lcp) : without_friction(posed.problem)),
        names_(posed, kept_) {
    const lcp::LcpProblem& whole = posed.problem.lcp;
    problem_.A = whole.A(kept_, kept_);
    problem_.b = whole.b(kept_);
    problem_.lower = whole.lower(kept_), problem_.upper = whole.upper(kept_);
    if (friction) problem_.groups = whole.groups;
  }

  Result<MicroscopeRecording> run();

 private:
  void find_scales();
  MicroscopeStep& add(const PivotStep& at);
  void draw(const PivotStep& at, Sketch& out) const;
  void count(const PivotStep& at, MicroscopeStep& step) const;
  void begin();
  void finish();
  Vec3 force_at(size_t point, const PivotStep& at) const;

  std::shared_ptr<const Frame> frame_;
  const GroupForceProblem& posed_;
  bool friction_;
  std::vector<Eigen::Index> kept_;
  PivotNames names_;
  lcp::LcpProblem problem_;
  lcp::PivotTrace trace_;
  lcp::LcpSolution solution_;
  double z_most_ = 0, w_most_ = 0, force_most_ = 0;
  MicroscopeRecording out_;
};

/// Force at a contact point on B, world axes [N].
Vec3 PivotRecorder::force_at(size_t point, const PivotStep& at) const {
  const ContactForceProblem::Point& p = posed_.problem.points[point];
  Vec3 out = Vec3::Zero();
  int axis = 0;
  for (size_t i = 0; i < names_.unknowns.size(); ++i) {
    if (names_.unknowns[i].point != int(point)) continue;
    out += at.z[Eigen::Index(i)] * p.axes[size_t(axis++)];
  }
  return out;
}

void PivotRecorder::find_scales() {
  for (const PivotStep& s : trace_.steps) {
    z_most_ = std::max(z_most_, s.z.cwiseAbs().maxCoeff());
    w_most_ = std::max(w_most_, lcp::slack(problem_, s.z).cwiseAbs().maxCoeff());
    for (size_t k = 0; k < posed_.places.size(); ++k)
      force_most_ = std::max(force_most_, force_at(k, s).norm());
  }
  for (const uint32_t slot : posed_.bodies) {
    if (slot >= frame_->body_slots() || frame_->body(slot).id.is_null()) continue;
    out_.size = std::max(out_.size, body_size(frame_->info(slot)));
    out_.see_through.push_back(frame_->body(slot).id);
  }
}

void PivotRecorder::draw(const PivotStep& at, Sketch& out) const {
  const double unit = force_most_ > 0 ? tolerances::arrow_share * out_.size / force_most_ : 0;
  for (size_t i = 0; i < names_.unknowns.size(); ++i) {
    const PivotNames::Unknown& unknown = names_.unknowns[i];
    if (unknown.point < 0 || unknown.lateral) continue;
    const auto k = size_t(unknown.point);
    const GroupForceProblem::Place& place = posed_.places[k];
    const auto concerns = [&](int index) {
      return index >= 0 && names_.unknowns[size_t(index)].point == unknown.point;
    };
    const Ink ink = ink_of(at.sets[i]);
    if (concerns(at.driven)) out.point(place.x_world, Ink::test, 20);
    if (concerns(at.limiting) && !concerns(at.driven)) out.point(place.x_world, Ink::active, 20);
    out.point(place.x_world, ink, 12);
    // Drawn on the dynamic body: B, unless that is fixed or kinematic.
    const uint32_t b = place.key.body_b;
    const bool held = b < frame_->body_slots() && frame_->info(b).type != BodyType::dynamic;
    const Vec3 force = (held ? -unit : unit) * force_at(k, at);
    if (force.norm() > 0.01 * out_.size) out.arrow(place.x_world, place.x_world + force, ink);
    if (posed_.places.size() <= most_labels) {
      const Vec3 side = held ? Vec3(-place.normal) : place.normal;
      out.label(place.x_world - 0.16 * out_.size * side, fmt::format("{}", k + 1), Ink::plain);
    }
  }
}

void PivotRecorder::count(const PivotStep& at, MicroscopeStep& step) const {
  const auto of = [&](auto... sets) {
    return std::count_if(at.sets.begin(), at.sets.end(),
                         [&](PivotSet s) { return ((s == sets) || ...); });
  };
  lcp::VecX w;
  const lcp::LcpResidual left = lcp::validate(problem_, at.z, w);
  if (at.driven >= 0) {
    step.numbers.push_back({"driven", names_[at.driven]});
    step.numbers.push_back({"by", fmt::format("{:.4g} N", at.step)});
    step.numbers.push_back({"limited by", at.limiting >= 0 ? names_[at.limiting] : "nothing"});
  }
  step.numbers.push_back({"clamped: w = 0", fmt::format("{}", of(PivotSet::clamped))});
  step.numbers.push_back(
      {"at a bound", fmt::format("{}", of(PivotSet::at_lower, PivotSet::at_upper))});
  step.numbers.push_back({"not clamped yet", fmt::format("{}", of(PivotSet::resting))});
  if (friction_) step.numbers.push_back({"on the cone", fmt::format("{}", of(PivotSet::tied))});
  step.numbers.push_back({"residual", fmt::format("{:.2g}", left.worst())});
  step.diagram = pivot_bars(at, names_, w, z_most_, w_most_);
}

MicroscopeStep& PivotRecorder::add(const PivotStep& at) {
  MicroscopeStep& step = out_.steps.emplace_back();
  draw(at, step.sketch);
  count(at, step);
  return step;
}

void PivotRecorder::begin() {
  MicroscopeStep& step = add(trace_.steps.front());
  step.title = "All contact forces are 0";
  const lcp::VecX w = lcp::slack(problem_, trace_.steps.front().z);
  size_t inwards = 0;
  for (size_t i = 0; i < names_.unknowns.size(); ++i) {
    const PivotNames::Unknown& u = names_.unknowns[i];
    inwards += u.point >= 0 && !u.lateral && w[Eigen::Index(i)] < 0 ? 1 : 0;
  }
  step.caption = fmt::format(
      "{} contacts of {} bodies. Without forces {} of them would go in: their acceleration "
      "w = A z + b is negative. {} drives one force at a time until w is 0 there, while those done "
      "are kept. {}",
      posed_.places.size(), posed_.bodies.size(), inwards,
      friction_ ? "Baraff's method" : "Dantzig's method",
      friction_ ? "Friction follows: up to its cone, against the slip."
                : "Friction is left out here.");
}

/// Adds the solver's final result, by whichever of its methods it was found.
void PivotRecorder::finish() {
  PivotStep last = trace_.steps.back();
  last.driven = last.limiting = -1;
  last.z = solution_.z;
  MicroscopeStep& step = add(last);
  const std::string_view asked = friction_ ? "baraff" : "dantzig";
  const lcp::LcpReport& report = solution_.report;
  step.title = report.solved() ? "All conditions hold" : "There is no answer";
  if (report.status == lcp::LcpStatus::infeasible || report.status == lcp::LcpStatus::ray)
    step.caption =
        "The forces grow without end along a direction that changes no acceleration: "
        "no forces satisfy all conditions.";
  else if (report.solver != asked)
    step.caption = fmt::format(
        "Pivoting with cones need not end, and it gave up here: '{}' was asked instead, which "
        "answered with a residual of {:.2g}.",
        report.solver, report.residual);
  else
    step.caption = fmt::format(
        "No contact accelerates inwards, none pulls, and those that open carry nothing. Pivots: "
        "{}, "
        "and what is left of any condition is {:.2g} of the largest term.{}",
        report.iterations, report.residual,
        trace_.polished ? " Newton's method has turned friction straight against the slip." : "");
  if (trace_.left_out > 0) step.caption += fmt::format(" {} steps are not shown.", trace_.left_out);
}

Result<MicroscopeRecording> PivotRecorder::run() {
  out_.title = friction_ ? "Baraff's pivots" : "Dantzig's pivots";
  const lcp::LcpOptions limits{.max_iterations = most_pivots};
  auto solved = friction_ ? lcp::watch_baraff(problem_, trace_, limits)
                          : lcp::watch_dantzig(problem_, trace_, limits);
  if (!solved) return solved.error();
  solution_ = *std::move(solved);
  find_scales();
  begin();
  for (size_t i = 1; i < trace_.steps.size(); ++i) {
    const PivotStep& at = trace_.steps[i];
    MicroscopeStep& step = add(at);
    step.title = fmt::format("The {} until {}", names_[at.driven],
                             at.event == lcp::PivotEvent::own_w ? "w = 0" : "another stops it");
    step.caption = pivot_caption(at, names_, z_most_);
  }
  finish();
  // The sum of all normal forces.
  for (size_t i = 0; i < names_.unknowns.size(); ++i)
    if (names_.unknowns[i].point >= 0 && !names_.unknowns[i].lateral)
      out_.answer += solution_.z[Eigen::Index(i)];
  return std::move(out_);
}

Result<MicroscopeRecording> record(const World& world, const MicroscopeSetup& setup,
                                   bool friction) {
  std::unique_ptr<World> copy;
  const World* asked = &world;
  if (world.settings().stepper != "event") {
    auto made = copy_of(world, "event");
    if (!made) return made.error();
    copy = *std::move(made);
    if (auto stepped = copy->step(); !stepped) return stepped.error();
    asked = copy.get();
  }
  auto posed = asked->contact_force_problem(setup.a);
  if (!posed) return posed.error();
  if (posed->places.empty())
    return Error{ErrorCode::not_found,
                 "nothing presses on this body or on what touches it",
                 {},
                 copy ? "wait until it has touched something for a tick" : ""};
  return PivotRecorder(*asked, *posed, friction).run();
}

}  // namespace

std::string refuse_pivots(const Frame& frame, const MicroscopeSetup& setup) {
  if (std::string why = moving_body_refusal(frame, setup.a, "the forces of its contacts");
      !why.empty())
    return why;
  bool touches = false;
  frame.for_contacts(
      [&](const ContactFrame& c) { touches = touches || c.a == setup.a || c.b == setup.a; });
  return touches ? "" : fmt::format("'{}' touches nothing now", frame.info(setup.a.index).name);
}

Result<MicroscopeRecording> record_dantzig(const World& world, const MicroscopeSetup& setup) {
  return record(world, setup, false);
}
Result<MicroscopeRecording> record_baraff(const World& world, const MicroscopeSetup& setup) {
  return record(world, setup, true);
}

}  // namespace tumble
