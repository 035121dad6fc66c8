#include "engine/world/state.hpp"

#include "engine/core/registry.hpp"
#include "engine/math/ode/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>

namespace tumble {

ForceContext WorldState::force_context() {
  const double h = settings.tick.tick();
  ForceContext context{bodies, particle_ids, particles, h, settings.gravity.now(), 0.5 * h, time()};
  context.particle_slots = blocks.first_slots();
  context.crew = crew.get();
  return context;
}

void set_threads(WorldState& state, int threads) {
  if (threads <= 0) threads = std::max(1, int(std::thread::hardware_concurrency()));
  state.crew.reset();
  state.crew = std::make_unique<Crew>(threads);
}

void FrameState::mark_changed(uint32_t body_slot) {
  const size_t chunk = body_slot / Frame::chunk_size;
  if (chunks_changed.size() <= chunk) chunks_changed.resize(chunk + 1, 1);
  chunks_changed[chunk] = 1;
}

void FrameState::forget_bodies() {
  unsure = true;
  resting_revision = ~uint64_t{0};
}

void WorldState::mark_active() {
  if (roster.everything()) {
    frames.unsure = true;
    return;
  }
  // Bodies that fell asleep in this tick are no longer in an island.
  for (const std::span<const uint32_t> slots : {roster.active(), roster.settled()})
    for (const uint32_t slot : slots) frames.mark_changed(slot);
}

void WorldState::forget_bodies() {
  roster.forget();
  frames.forget_bodies();
}

namespace {

/// Finds the first declared parameter that is outside its range.
struct RangeCheck {
  std::optional<Error> fault;
  std::string path;

  void number(double value, const Parameter& p) {
    const bool inside = std::isfinite(value) &&
                        (p.exclusive_min ? value > p.min : value >= p.min) && value <= p.max;
    if (!inside && !fault)
      fault = Error{ErrorCode::invalid_argument,
                    fmt::format("{}{} is out of range: {} {}", path, p.name, value, p.unit),
                    "settings",
                    {}};
  }
  void field(double value, const Parameter& p) { number(value, p); }
  void field(int value, const Parameter& p) { number(value, p); }
  void field(bool, const Parameter&) {}
  void field(const std::string&, const Parameter&) {}
  void field(const Vec3& value, const Parameter& p) {
    if (!value.allFinite() && !fault)
      fault = Error{ErrorCode::invalid_argument,
                    fmt::format("{}{} is not finite", path, p.name),
                    "settings",
                    {}};
  }
  void field(const VaryingVec3& value, const Parameter& p) { field(value.now(), p); }
  void field(const TickRate& value, const Parameter& p) {
    if (value.num <= 0 || value.den <= 0) {
      if (!fault)
        fault = Error{
            ErrorCode::invalid_argument,
            fmt::format("{} must be a positive fraction, got {}/{}", p.name, value.num, value.den),
            "settings",
            {}};
      return;
    }
    number(double(value.num) / double(value.den), p);
  }
  template <class T>
  void object(const T& value, const Parameter& p) {
    const std::string outer = path;
    path += std::string(p.name) + ".";
    T::parameters(*this, value);
    path = outer;
  }
};

}  // namespace

Status validate(const WorldSettings& settings) {
  RangeCheck check;
  WorldSettings::parameters(check, settings);
  if (check.fault) return *check.fault;
  if (auto e = find_named(all_steppers(), settings.stepper, "stepper"); !e) return e.error();
  if (auto e = find_named(all_broad_phases(), settings.broad_phase, "broad phase"); !e)
    return e.error();
  if (auto e = find_named(all_hierarchies(), settings.hierarchy, "hierarchy"); !e) return e.error();
  if (auto e = find_named(all_narrow_phases(), settings.narrow_phase, "narrow phase"); !e)
    return e.error();
  if (auto e = find_named(all_contact_time_methods(), settings.contact_time, "contact time"); !e)
    return e.error();
  if (auto e = find_named(ode::all_integrators(), settings.event.integrator, "integrator"); !e)
    return e.error();
  if (auto e = find_named(all_impact_laws(), settings.event.impulses, "law of impulses"); !e)
    return e.error();
  if (auto m = contact_force_method(settings.event.contact_solver, settings.event.friction_cone);
      !m)
    return m.error();
  return {};
}

Status choose_algorithms(WorldState& state, const WorldSettings& settings) {
  const auto entry = find_named(all_broad_phases(), settings.broad_phase, "broad phase");
  if (!entry) return entry.error();
  if (!state.methods.broad_phase || settings.broad_phase != state.settings.broad_phase) {
    state.methods.broad_phase = (*entry)->make();
    state.methods.path_broad_phase = (*entry)->make();
  }
  const auto narrow = find_named(all_narrow_phases(), settings.narrow_phase, "narrow phase");
  if (!narrow) return narrow.error();
  state.methods.narrow_phase = (*narrow)->collide;
  const auto time = find_named(all_contact_time_methods(), settings.contact_time, "contact time");
  if (!time) return time.error();
  state.methods.continuous = {state.methods.narrow_phase,
                              {*time, settings.narrow_phase == "v_clip"}};
  const auto kind = find_named(all_hierarchies(), settings.hierarchy, "hierarchy");
  if (!kind) return kind.error();
  state.methods.hierarchy = settings.hierarchy == "aabb" ? nullptr : *kind;  // every mesh has it
  return {};
}

}  // namespace tumble
