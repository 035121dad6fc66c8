#include "engine/dynamics/event/event_group.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/turning.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The longest step that follows a body's turning [s]. Of needles the momentum of swinging counts,
/// as spin about themselves, as much more as the greatest moment of inertia is than the least: an
/// error of the axis, of fourth order, must be as much smaller. Of the thinnest the stages of a
/// step must not spin: their axes are off by the square of the turn.
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

}  // namespace

void EventStats::include(const EventStats& s) {
  events += s.events;
  spent += s.spent;
  time_stepped += s.time_stepped;
  impacts += s.impacts;
  steps += s.steps;
  fallbacks += s.fallbacks;
  groups += s.groups;
  windows += s.windows;
  pairs += s.pairs;
  substituted += s.substituted;
  jams += s.jams;
  residual = std::max(residual, s.residual);
  deepest = std::max(deepest, s.deepest);
  impact_work += s.impact_work;
}

std::string EventContext::name(uint32_t slot) const {
  return name_of ? name_of(slot) : fmt::format("body slot {}", slot);
}

EventGroup::EventGroup(std::span<RigidBody> bodies, BodyGroup& group,
                       std::span<const uint32_t> block_of, const SmoothForces& forces,
                       const EventContext& context)
    : bodies_(bodies),
      group_(group),
      block_of_(block_of),
      context_(context),
      system_(bodies, group.bodies, block_of, forces, context.forces),
      pairs_(group.pairs),
      contacts_(group.contacts) {
  for (const ode::IntegratorEntry& e : ode::all_integrators())
    if (e.name == context.settings.integrator) integrator_ = e.make();
  const double t = context.settings.tolerance;
  integrator_->settings.tolerance = {t, t, t};
  system_.set_joints(context.joints, group.joints);
  if (context.rates) system_.book(*context.rates);
}

std::vector<DofBlock> EventGroup::blocks() const {
  return blocks_of(bodies_, group_.bodies);
}

void EventGroup::set_velocities(std::span<const DofBlock> blocks) {
  for (size_t i = 0; i < blocks.size(); ++i) {
    RigidBody& b = bodies_[group_.bodies[i]];
    if (!b.dynamic()) continue;
    b.v = blocks[i].v;
    b.omega = blocks[i].omega;
  }
}

Error EventGroup::error(std::string what, std::string cure) const {
  std::string who = context_.name(group_.bodies.front());
  if (group_.bodies.size() > 1)
    who += fmt::format(" and {} more that may touch it", group_.bodies.size() - 1);
  return {ErrorCode::numeric, std::move(what), std::move(who), std::move(cure)};
}

void EventGroup::find_contacts(bool accept_overlap) {
  // As far as they may come in the part of the tick, but no more than half a body.
  const double h = part_.end - part_.begin;
  for (EventPair& p : pairs_) {
    const RigidBody &a = bodies_[p.a.body], &b = bodies_[p.b.body];
    const double reach = (speed_bound(a, h) + speed_bound(b, h)) * h + tolerances::contact_margin;
    p.margin = std::min(reach, tolerances::margin_of_size * std::min(size_of(a), size_of(b)));
  }
  contacts_ = find_event_contacts(bodies_, pairs_, context_.narrow_phase, context_.hierarchy,
                                  contacts_, accept_overlap);
}

double EventGroup::safe_step(double most) const {
  double step = most;
  for (const uint32_t slot : group_.bodies) {
    const RigidBody& b = bodies_[slot];
    if (std::isfinite(b.bounding_radius) && !b.omega.isZero(0))
      step = std::min(step, turning_step(b));
  }
  for (const EventPair& p : pairs_) {
    const RigidBody &a = bodies_[p.a.body], &b = bodies_[p.b.body];
    double room = p.margin;
    for (const EventContact& c : contacts_of(p))
      room = std::min(room, std::max(0.0, place_now(c, bodies_).gap));
    double inner = tolerances::no_limit;
    for (const RigidBody* body : {&a, &b})
      if (body->dynamic())
        inner = std::min(
            inner, std::max(body->inner_radius, tolerances::least_inner_of_size * size_of(*body)));
    double speed = (a.v - b.v).norm();
    for (const uint32_t slot : {p.a.body, p.b.body}) {
      const RigidBody& body = bodies_[slot];
      speed += step * body.inverse_mass * body.force.norm();
      if (!std::isfinite(body.bounding_radius)) continue;
      const Vec3& half = group_.reaches[slot].half;
      speed +=
          half.allFinite() ? turning_speed(body, half) : body.omega.norm() * body.bounding_radius;
    }
    const double length = std::max(room, tolerances::passed_of_inner * inner);
    if (speed * step > length) step = length / speed;
  }
  return step;
}

Status EventGroup::spend(EventStats& stats) {
  const ContactForceReport& forces = system_.report();
  const bool hard =
      forces.substituted || !forces.solved || forces.iterations > tolerances::usual_iterations;
  const uint64_t work = std::max(1u, evaluations_ / tolerances::ordinary_evaluations);
  stats.spent += group_.bodies.size() * work * (hard ? tolerances::hard_cost : 1);
  if (!context_.over_budget(group_.bodies.size(), stats)) return {};
  return lost("too many events in one tick",
              "use a smaller tick, restitution below 1, or a larger event.budget");
}

Status EventGroup::step_to(double t, double& step, const std::vector<double>& from,
                           EventStats& stats) {
  ode::StepReport report;
  for (int tries = 0; tries < tolerances::most_halvings; ++tries) {
    if (tries > 0) {
      if (Status may = spend(stats); !may) return may;
    }
    y_ = from;
    system_.foresee_slip(t, step, from);
    report = integrator_->step(system_, t, step, y_);
    evaluations_ = report.evaluations;
    if (stop_requested()) return stopped_error();
    if (report.ok()) {
      step = report.advanced;
      return {};
    }
    // Newton's method, or the forces at a stage that is far off, may do with less.
    if (report.status != ode::StepStatus::not_converged &&
        report.status != ode::StepStatus::refused)
      break;
    if (tries == 0 && stuck_at(t, from)) break;
    step *= 0.5;
  }
  if (!system_.report().solved)
    return lost("no contact forces were found that satisfy all conditions",
                "use a smaller tick or less friction");
  const Error cause = report.text(integrator_->name(), system_);
  return error(cause.text(), "use a smaller tick, softer springs or smaller velocities");
}

Status EventGroup::step_to_event(double t, double& step, const std::vector<double>& from,
                                 EventStats& stats) {
  if (Status done = step_to(t, step, from, stats); !done) return done;
  ++stats.steps;
  stats.substituted += system_.report().substituted;
  // A shorter step is another step: where forces are not smooth it goes elsewhere.
  bool early = false;
  EventContact* stopped = nullptr;
  for (int nearer = 0; nearer < tolerances::most_nearer_events; ++nearer) {
    const double event = first_event(t, step);
    if (stop_requested()) return stopped_error();
    if (event >= step * (1 - tolerances::step_end)) break;
    if (nearer == 0) early = true, stopped = stopping_;
    step = event;
    if (Status may = spend(stats); !may) return may;
    if (Status done = step_to(t, step, from, stats); !done) return done;
  }
  stats.events += early;
  if (stopped) ++stopped->impacts;
  return {};
}

bool EventGroup::stuck_at(double t, const std::vector<double>& from) {
  if (system_.report().solved || system_.foresees()) return false;
  scratch_.resize(system_.size());
  return !system_.derivative(t, from, scratch_) && !system_.report().solved;
}

void EventGroup::work_off_overlap() {
  const double worked_off = part_.tick * context_.settings.recovery_speed;
  bool any = false;
  for (EventContact& c : contacts_) {
    if (c.offset == 0) continue;
    any = true;
    const double depth = std::max(0.0, -place_now(c, bodies_).gap);
    c.offset = std::max(0.0, std::min(c.offset, depth) - worked_off);
  }
  if (any) close_up(ContactCause::offset);
}

void EventGroup::note_gone() {
  for (size_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t slot = group_.bodies[i];
    group_.max_displacement[i] = std::max(group_.max_displacement[i],
                                          displacement_bound(bodies_[slot], group_.reaches[slot]));
  }
}

double EventGroup::deepest() const {
  double deepest = 0;
  for (const EventPair& p : pairs_)
    for (const EventContact& c : contacts_of(p))
      deepest = std::max(deepest, -place_now(c, bodies_).gap - std::max(c.offset, p.offset));
  return deepest;
}

bool EventGroup::kept_closed(std::span<const std::optional<Vec3>> crossings) const {
  for (size_t i = 0; i < contacts_.size(); ++i) {
    const EventContact& c = contacts_[i];
    if (!c.closed) continue;
    if (crossings[i] && ran_away(c, *crossings[i], bodies_)) return false;
    if (c.force.isZero()) continue;
    const ElementGap g = gap_now(c, bodies_);
    if (g.regular &&
        (std::fabs(c.room(g)) > tolerances::kept_closed_share * tolerances::closed_distance ||
         std::fabs(g.rate) > tolerances::kept_closed_share * tolerances::still_speed))
      return false;
  }
  return true;
}

std::vector<std::optional<Vec3>> EventGroup::pressed_crossings() const {
  std::vector<std::optional<Vec3>> out(contacts_.size());
  for (size_t i = 0; i < contacts_.size(); ++i)
    if (contacts_[i].closed && !contacts_[i].force.isZero())
      out[i] = crossing_of(contacts_[i], bodies_);
  return out;
}

EventGroup::EnergyLost EventGroup::energy_lost(double t, double step,
                                               const std::vector<double>& from) {
  if (!system_.only_jointed()) return {};
  double work = 0, energy = 0, least = tolerances::no_limit, most = -tolerances::no_limit;
  const auto look = [&](double at, const std::vector<double>& y, double weight, double sign) {
    system_.write(at, y);
    const double power = system_.power(at);
    least = std::min(least, power), most = std::max(most, power);
    work += weight / 6 * step * power;
    energy += sign * system_.kinetic_energy();
  };
  look(t, from, 1, -1);
  integrator_->at(system_, t + 0.5 * step, scratch_);
  look(t + 0.5 * step, scratch_, 4, 0);
  look(t + step, y_, 1, 1);
  return {std::fabs(energy - work), step * (most - least)};
}

bool EventGroup::kept_jointed(const JointDrift& drift, double lost, double energy_before) const {
  if (system_.joints().empty()) return true;
  const double energy = std::max(energy_before, inner_energy());
  return drift.open <= tolerances::open_per_step &&
         drift.changed <= tolerances::changed_per_step * energy + tolerances::no_energy &&
         lost <= tolerances::lost_per_step * energy +
                     tolerances::energy_rounding * system_.kinetic_energy() + tolerances::no_energy;
}

void EventGroup::begin_tick() {
  for (EventContact& c : contacts_) {
    c.impacts = 0;
    c.impulse.setZero();
  }
  find_contacts(true);
  work_off_overlap();
}

Status EventGroup::advance(const TickPart& part, EventStats& stats, uint64_t allowed) {
  part_ = part;
  group_.max_displacement.assign(group_.bodies.size(), 0);
  now_ = part.begin;
  if (part.begin == 0)
    begin_tick();
  else
    find_contacts(false);
  if (Status done = resolve(stats); !done) return done;
  const double h = part.end;
  double t = part.begin;
  scratch_.resize(system_.size());
  group_.given_up.reset();
  while (t < h) {
    if (stop_requested()) return stopped_error();
    if (stats.steps > allowed) {
      group_.given_up = t;
      return {};
    }
    double step = safe_step(h - t);
    if (t + step > h - tolerances::tick_end * h) step = h - t;
    const std::vector<double> from = system_.read(t);
    const std::vector<EventContact> before = contacts_;
    const std::vector<EventPair> pairs_before = pairs_;
    const std::vector<std::optional<Vec3>> crossings = pressed_crossings();
    CauseEffect& projections = group_.books.contacts[size_t(ContactCause::projection)];
    const double deep = deepest();
    const double moving_before = system_.joints().empty() ? 0 : inner_energy();
    for (int tries = 0;; ++tries) {
      if (stop_requested()) return stopped_error();
      if (tries > 0) {
        if (Status may = spend(stats); !may) return may;
      }
      system_.set_contacts(contacts_);
      if (Status done = step_to_event(t, step, from, stats); !done) {
        if (system_.report().solved || tries >= tolerances::most_tries || stop_requested() ||
            context_.over_budget(group_.bodies.size(), stats))
          return done;
        // No forces are in balance: nearer to that moment, and there an impulse.
        const bool stuck = stuck_at(t, from);
        contacts_ = before;
        pairs_ = pairs_before;
        system_.write(t, from);
        if (step > tolerances::shortest_step * part.tick && !stuck) {
          step *= tolerances::step_to_jam;
          continue;
        }
        if (!stop_jams(stats) && !stop_slowest(stats)) return done;
        y_ = from;
        step = 0;
        break;
      }
      system_.write(t + step, y_);
      const EnergyLost lost = integrator_->order() < tolerances::accurate_order
                                  ? EnergyLost{}
                                  : energy_lost(t, step, from);
      const CauseEffect projected = projections;
      const JointDrift drift = hold_joints();
      if (tries >= tolerances::most_exact_tries &&
          lost.energy >
              lost.doubt + tolerances::lost_for_good * std::max(moving_before, inner_energy()))
        return error(
            "joints come to a place from which no step leads on without a change of energy",
            "keep linkages from becoming straight or flat, or use a smaller tick");
      const bool exact =
          kept_closed(crossings) && (integrator_->order() < tolerances::accurate_order ||
                                     kept_jointed(drift, lost.energy, moving_before));
      if (exact || tries >= tolerances::most_exact_tries) find_contacts(false);
      // Something came through that nobody watched: look again, more closely.
      if ((exact || tries >= tolerances::most_exact_tries) &&
          (deepest() <= deep + tolerances::came_through || tries >= tolerances::most_tries))
        break;
      contacts_ = before;
      pairs_ = pairs_before;
      system_.write(t, from);
      projections = projected;
      step *= 0.5;
    }
    system_.add_books(y_, group_.books);
    for (EventContact& c : contacts_) c.impulse += step * c.force;
    now_ = t = step >= h - t ? h : t + step;
    note_gone();
    if (Status done = resolve(stats); !done) return done;
    stats.deepest = std::max(stats.deepest, deepest());
  }
  return {};
}

}  // namespace tumble
