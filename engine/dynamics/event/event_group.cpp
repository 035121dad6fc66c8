#include "engine/dynamics/event/event_group.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/turning.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The longest step that resolves a body's rotation [s]. For a needle only the rotation of its axis
/// counts; but its spin about the axis depends on the angular momentum of that rotation, larger by
/// the ratio of the moments of inertia, so the error of the axis, of fourth order, must be smaller
/// by that ratio. The stages of a step must not spin the thinnest needles either, since the axis at
/// a stage is off by the square of the rotation.
double turning_step(const RigidBody& b) {
  const double step = tolerances::turn_per_step / b.omega.norm();
  const std::optional<SlenderInertia> slender = slender_inertia(b.inertia_body);
  if (!slender) return step;
  Vec3 swing = slender->axes.conjugate() * b.pose.inverse_direction(b.omega);
  swing[0] = 0;
  const double ratio = slender->moments[0] / slender->moments[2];
  const double finer = std::min(std::sqrt(std::sqrt(tolerances::ordinary_moment_ratio * ratio)),
                                tolerances::thinnest_turns * std::sqrt(ratio));
  return std::min(step, finer * tolerances::turn_per_step / swing.norm());
}

double size_of(const RigidBody& b) {
  return std::isfinite(b.bounding_radius) ? b.bounding_radius : tolerances::no_limit;
}

std::unique_ptr<ode::Integrator> integrator_of(const EventSettings& settings) {
  std::unique_ptr<ode::Integrator> made;
  for (const ode::IntegratorEntry& e : ode::all_integrators())
    if (e.name == settings.integrator) made = e.make();
  made->settings.tolerance = {settings.tolerance, settings.tolerance, settings.tolerance};
  return made;
}

/// Least inner radius of the body's shapes [m]: a step must not carry any of them through another
/// body, however thick the whole body is.
double thinnest_part(const RigidBody& b) {
  if (b.shapes.empty()) return b.inner_radius;
  double least = tolerances::no_limit;
  for (const BodyShape& s : b.shapes) least = std::min(least, s.shape->inner_radius());
  return least;
}

}  // namespace

EventGroup::EventGroup(std::span<RigidBody> bodies, BodyGroup& group,
                       std::span<const uint32_t> block_of, const SmoothForces& forces,
                       const EventContext& context)
    : state_(bodies, group, block_of, forces, context),
      projection_(state_),
      impacts_(state_, projection_),
      drives_(state_),
      integrator_(integrator_of(context.settings)),
      first_event_(state_, *integrator_),
      scratch_(state_.system.size()) {}

EventGroup::~EventGroup() {
  state_.system.rest_courses();
  if (state_.group.laid_out) *state_.group.laid_out = state_.system.give_joints();
}

double EventGroup::safe_step(double most) const {
  double step = most;
  for (const uint32_t slot : state_.group.bodies) {
    const RigidBody& b = state_.bodies[slot];
    if (std::isfinite(b.bounding_radius) && !b.omega.isZero(0))
      step = std::min(step, turning_step(b));
  }
  if (const double rate = spring_rate(); rate * step > tolerances::swing_per_step)
    step = tolerances::swing_per_step / rate;
  for (const EventPair& p : state_.pairs) {
    const RigidBody &a = state_.bodies[p.a.body], &b = state_.bodies[p.b.body];
    double room = p.margin;
    for (const EventContact& c : state_.contacts_of(p))
      room = std::min(room, std::max(0.0, place_now(c, state_.bodies).gap));
    double inner = tolerances::no_limit;
    for (const RigidBody* body : {&a, &b})
      if (body->dynamic())
        inner = std::min(inner, std::max(thinnest_part(*body),
                                         tolerances::least_inner_of_size * size_of(*body)));
    const double speed = passing_speed(p, step);
    const double length = std::max(room, tolerances::passed_of_inner * inner);
    if (speed * step > length) step = length / speed;
  }
  return step;
}

/// Upper bound on the speed of any point of one body relative to the other [m/s]. Friction depends
/// on how they pass each other. Without friction only the motion along the normal counts, where one
/// normal separates the shapes: spin about it brings no point nearer.
double EventGroup::passing_speed(const EventPair& p, double step) const {
  const RigidBody &a = state_.bodies[p.a.body], &b = state_.bodies[p.b.body];
  const BodyShape &of_a = a.shapes[p.a.shape], &of_b = b.shapes[p.b.shape];
  const bool along = p.gap.near && combine(of_a.material, of_b.material).friction == 0 &&
                     has_pair_gap(*of_a.shape, *of_b.shape);
  const Vec3& n = p.gap.normal;
  double speed = along ? std::fabs(n.dot(a.v - b.v)) : (a.v - b.v).norm();
  for (const uint32_t slot : {p.a.body, p.b.body}) {
    const RigidBody& body = state_.bodies[slot];
    speed += step * (body.inverse_mass * body.force.norm() + state_.system.course_change(slot));
    if (!std::isfinite(body.bounding_radius)) continue;
    const Vec3& half = state_.group.reaches[slot].half;
    if (along)
      speed += turning_speed_along(body, half, n);
    else if (half.allFinite())
      speed += turning_speed(body, half);
    else
      speed += body.omega.norm() * body.bounding_radius;
  }
  return speed;
}

bool EventGroup::is_shortest(double step) const {
  return step <= tolerances::shortest_step * state_.part.tick;
}

Status EventGroup::step_to(double t, double& step) {
  ode::StepReport report;
  for (bool first = true;; first = false) {
    y_ = start_.y;
    state_.system.foresee_slip(t, step, start_.y);
    report = integrator_->step(state_.system, t, step, y_);
    if (stop_requested()) return stopped_error();
    if (report.ok()) {
      step = report.advanced;
      return {};
    }
    // The integrator's Newton iteration did not converge, or no forces exist at a distant stage: a
    // shorter step may succeed.
    const bool halved = report.status == ode::StepStatus::not_converged ||
                        report.status == ode::StepStatus::refused;
    if (!halved || is_shortest(step) || (first && stuck_at(t))) break;
    step *= 0.5;
  }
  if (!state_.system.report().solved)
    return state_.lost("no contact forces were found that satisfy all conditions",
                       "use a smaller tick or less friction");
  const Error cause = report.text(integrator_->name(), state_.system);
  return state_.error(cause.text(), "use a smaller tick, softer springs or smaller velocities");
}

Status EventGroup::step_to_event(double t, double& step, EventStats& stats) {
  if (Status done = step_to(t, step); !done) return done;
  ++stats.steps;
  stats.substituted += state_.system.report().substituted;
  // The shorter step is computed anew and searched again: where forces are not smooth it differs
  // from the longer one.
  bool early = false;
  for (;;) {
    const double event = first_event_.find(t, step);
    if (stop_requested()) return stopped_error();
    if (event >= step * (1 - tolerances::step_end)) break;
    early = true;
    step = event;
    if (Status done = step_to(t, step); !done) return done;
  }
  stats.events += early;
  return {};
}

bool EventGroup::stuck_at(double t) {
  if (state_.system.report().solved || state_.system.foresees()) return false;
  return !state_.system.derivative(t, start_.y, scratch_) && !state_.system.report().solved;
}

void EventGroup::count_turns() {
  const bool first = angles_.empty();
  angles_.resize(state_.group.joints.size());
  for (size_t i = 0; i < angles_.size(); ++i) {
    const Joint& joint = state_.context.joints[state_.group.joints[i]];
    const std::vector<JointCoordinate>& all = entry_of(joint.kind).coordinates;
    if (!joint.followed() || !std::ranges::any_of(all, &JointCoordinate::turns)) continue;
    const JointSides sides = sides_with_axes(joint, state_.bodies);
    for (size_t k = 0; k < all.size(); ++k) {
      if (!all[k].turns) continue;
      const double angle = all[k].row(sides).error;
      if (!first) state_.group.books.joints[i].turned[k] += nearest_turn(angle - angles_[i][k], 0);
      angles_[i][k] = angle;
    }
  }
}

void EventGroup::note_gone() {
  for (size_t i = 0; i < state_.group.bodies.size(); ++i) {
    const uint32_t slot = state_.group.bodies[i];
    state_.group.max_displacement[i] =
        std::max(state_.group.max_displacement[i],
                 displacement_bound(state_.bodies[slot], state_.group.reaches[slot]));
  }
}

bool EventGroup::kept_closed(std::span<const std::optional<Vec3>> crossings) const {
  for (size_t i = 0; i < state_.contacts.size(); ++i) {
    const EventContact& c = state_.contacts[i];
    if (!c.closed) continue;
    if (crossings[i] && ran_away(c, *crossings[i], state_.bodies)) return false;
    if (c.force.isZero()) continue;
    const ElementGap g = gap_now(c, state_.bodies);
    if (g.regular &&
        (std::fabs(c.room(g)) > tolerances::kept_closed_share * tolerances::closed_distance ||
         std::fabs(g.rate) > tolerances::kept_closed_share * tolerances::still_speed))
      return false;
  }
  return drives_.kept();
}

std::vector<std::optional<Vec3>> EventGroup::pressed_crossings() const {
  std::vector<std::optional<Vec3>> out(state_.contacts.size());
  for (size_t i = 0; i < state_.contacts.size(); ++i)
    if (state_.contacts[i].closed && !state_.contacts[i].force.isZero())
      out[i] = crossing_of(state_.contacts[i], state_.bodies);
  return out;
}

EventGroup::EnergyLost EventGroup::energy_lost(double t, double step) {
  if (!state_.system.only_jointed()) return {};
  double work = state_.system.drive_work(y_), energy = 0, least = tolerances::no_limit,
         most = -tolerances::no_limit;
  const auto look = [&](double at, const std::vector<double>& y, double weight, double sign) {
    state_.system.write(at, y);
    const double power = state_.system.power(at);
    least = std::min(least, power), most = std::max(most, power);
    work += weight / 6 * step * power;
    if (sign != 0) energy += sign * state_.system.kinetic_energy(y);
  };
  look(t, start_.y, 1, -1);
  integrator_->at(state_.system, t + 0.5 * step, scratch_);
  look(t + 0.5 * step, scratch_, 4, 0);
  look(t + step, y_, 1, 1);
  return {std::fabs(energy - work), step * (most - least)};
}

bool EventGroup::kept_jointed(const JointDrift& drift, double lost, double energy_before) const {
  if (state_.system.joints().empty()) return true;
  const double energy = std::max(energy_before, projection_.inner_energy());
  return drift.open <= tolerances::open_per_step &&
         drift.changed <= tolerances::changed_per_step * energy + tolerances::no_energy &&
         lost <= tolerances::lost_per_step * energy +
                     tolerances::energy_rounding * state_.system.kinetic_energy() +
                     tolerances::no_energy;
}

void EventGroup::begin_tick() {
  for (EventContact& c : state_.contacts) {
    c.impacts = 0;
    c.impulse.setZero();
  }
  state_.find_contacts(true);
  projection_.work_off_overlap();
}

void EventGroup::begin_step(double t) {
  start_.t = t;
  start_.y = state_.system.read(t);
  start_.contacts = state_.contacts;
  start_.pairs = state_.pairs;
}

void EventGroup::go_back() {
  state_.contacts = start_.contacts;
  state_.pairs = start_.pairs;
  state_.system.write(start_.t, start_.y);
}

double EventGroup::spring_rate() const {
  double rate = 0;
  if (integrator_->bears_stiffness()) return rate;
  for (const uint32_t slot : state_.group.bodies)
    rate = std::max(rate, state_.context.spring_rate(slot));
  return rate;
}

bool EventGroup::foresees_too_much(const TickPart& part, uint64_t allowed) const {
  const double steps = (part.end - part.begin) * spring_rate() / tolerances::swing_per_step;
  return steps * double(state_.group.bodies.size() * prices::step) > double(allowed);
}

Status EventGroup::advance(const TickPart& part, EventStats& stats, uint64_t allowed) {
  state_.part = part;
  state_.group.max_displacement.assign(state_.group.bodies.size(), 0);
  state_.now = part.begin;
  state_.system.set_now(part.begin);
  const uint64_t budget =
      state_.context.allowed_work(state_.bodies, state_.group.bodies, part.tick);
  WorkMeter meter(budget - std::min(budget, stats.work));
  Status done;
  if (foresees_too_much(part, budget)) {
    stats.work = budget + 1;
    return state_.error("springs are too stiff for so many steps in a tick",
                        "use softer springs, a smaller tick, or a larger event.budget");
  }
  {
    const Metered counted(meter);
    begin_step(part.begin);
    done = go_through(part, stats, allowed);
  }
  stats.work += meter.spent();
  return meter.exhausted() ? too_much(budget) : done;
}

Status EventGroup::too_much(uint64_t budget) {
  if (stop_requested()) return stopped_error();
  go_back();
  const char *message = "too much happens in one tick",
             *cure = "use a smaller tick, restitution below 1, or a larger event.budget";
  // A proof of a crush that the end of the budget cut short, here or before, is invalid.
  state_.group.crushed = false;
  WorkMeter of_proof(budget);
  Status lost;
  {
    const Metered counted(of_proof);
    lost = state_.lost(message, cure);
  }
  if (!of_proof.exhausted()) return lost;
  state_.group.crushed = false;
  return state_.error(message, cure);
}

Status EventGroup::go_through(const TickPart& part, EventStats& stats, uint64_t allowed) {
  count_turns();
  impacts_.start_joints(stats);
  projection_.work_off_openings();
  if (part.begin == 0) {
    begin_tick();
  } else {
    state_.find_contacts(false);
    drives_.accept_depths(0);
  }
  if (Status done = impacts_.resolve(stats); !done) return done;
  const double h = part.end;
  double t = part.begin;
  state_.group.given_up.reset();
  while (t < h) {
    if (stop_requested()) return stopped_error();
    if (stats.steps > allowed) {
      state_.group.given_up = t;
      return {};
    }
    double step = safe_step(h - t);
    if (t + step > h - tolerances::tick_end * h) step = h - t;
    begin_step(t);
    const std::vector<std::optional<Vec3>> crossings = pressed_crossings();
    CauseEffect& projections = state_.group.books.contacts[size_t(ContactCause::projection)];
    const double deep = state_.deepest();
    const double moving_before = state_.system.joints().empty() ? 0 : projection_.inner_energy();
    for (int tries = 0;; ++tries) {
      if (stop_requested()) return stopped_error();
      state_.system.set_contacts(state_.contacts);
      if (Status done = step_to_event(t, step, stats); !done) {
        if (state_.system.report().solved || stop_requested()) return done;
        // No forces are in balance from here on: impulses must act.
        go_back();
        if (!impacts_.stop_jams(stats)) return done;
        y_ = start_.y;
        step = 0;
        break;
      }
      state_.system.write(t + step, y_);
      const EnergyLost lost =
          integrator_->order() < tolerances::accurate_order ? EnergyLost{} : energy_lost(t, step);
      const CauseEffect projected = projections;
      const JointDrift drift = projection_.hold_joints();
      if (tries >= tolerances::most_exact_tries &&
          lost.energy > lost.doubt + tolerances::lost_for_good *
                                         std::max(moving_before, projection_.inner_energy()))
        return state_.error(
            "joints come to a place from which no step leads on without a change of energy",
            "keep linkages from becoming straight or flat, or use a smaller tick");
      const bool exact =
          kept_closed(crossings) && (integrator_->order() < tolerances::accurate_order ||
                                     kept_jointed(drift, lost.energy, moving_before));
      if (exact || tries >= tolerances::most_exact_tries) state_.find_contacts(false);
      // A contact that was not watched overlaps: the step is repeated with half its length.
      if ((exact || tries >= tolerances::most_exact_tries) &&
          (state_.deepest() <= deep + tolerances::came_through || is_shortest(step)))
        break;
      go_back();
      projections = projected;
      step *= 0.5;
    }
    state_.system.add_books(y_, state_.group.books);
    for (EventContact& c : state_.contacts) c.impulse += step * c.force;
    state_.now = t = step >= h - t ? h : t + step;
    note_gone();
    count_turns();
    if (Status done = impacts_.resolve(stats); !done) return done;
    stats.deepest = std::max(stats.deepest, state_.deepest());
  }
  return {};
}

}  // namespace tumble
