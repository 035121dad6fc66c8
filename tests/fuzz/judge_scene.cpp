#include "tests/fuzz/judge_scene.hpp"

#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/fuzz/euler_gain.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

/// How far a solver may be off, for what it is.
struct Bars {
  double overlap;  ///< of the smaller body's radius [-]
  double outside;  ///< a centre beyond a wall, of half the room [-]
  double energy;   ///< grown beyond booked work, of what was there and went through [-]
};
/// Realtime is iterated and works overlap off over ticks.
Bars bars_of(const std::string& stepper) {
  if (stepper == "realtime") return {0.5, 0.02, 0.1};
  return {0.02, 0.01, 0.05};
}

double processor_time() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Work of everything that may bring energy in from outside: kinematic bodies, the user, and the
/// flows (vortex, wind, turbulence, drag in wind), which have no potential [J]. Only what comes in
/// counts: what one takes away may not excuse another.
double work_from_outside(const Ledger& ledger) {
  double in = 0;
  const auto add = [&in](const LedgerAccount& a) { in += std::max(0.0, a.total().balance); };
  add(ledger.line(LedgerLine::kinematic));
  add(ledger.line(LedgerLine::user));
  for (const ForceAccount& f : ledger.forces()) add(f.account);
  return in;
}

/// One run, judged tick by tick.
class Judge {
 public:
  Judge(const RandomScene& scene, const BuiltScene& built, const Bars& bars)
      : scene_(scene), built_(built), bars_(bars) {
    start_ = built.world->frame()->stats.energies.total();
    kinetic_start_ = built.world->frame()->stats.energies.kinetic;
    if (scene.explicit_euler) euler_.emplace(*built.world->frame());
  }

  void after_tick(SceneVerdict& v, bool look_for_overlap) {
    const auto frame = built_.world->frame();
    // What time-stepping carried on is held to what is asked of the realtime stepper.
    if (frame->stats.time_stepped > 0) {
      const Bars loose = bars_of("realtime");
      bars_ = {std::max(bars_.overlap, loose.overlap), std::max(bars_.outside, loose.outside),
               std::max(bars_.energy, loose.energy)};
      ++v.time_stepped;
    }
    if (euler_) euler_->add_tick(*frame);
    check_bodies(*frame, v);
    check_particles(*frame, v);
    check_energy(*frame, v);
    if (look_for_overlap) check_overlap(v);
  }

 private:
  void fail(SceneVerdict& v, const Frame& frame, const std::string& what) {
    if (v.right()) v.fault = fmt::format("{} at {:.3f} s", what, frame.time);
  }

  bool outside(const Vec3& x) const {
    return !(x.cwiseAbs().maxCoeff() <= (1 + bars_.outside) * scene_.half_room);
  }

  void check_bodies(const Frame& frame, SceneVerdict& v) {
    for (size_t i = 0; i < frame.body_slots(); ++i) {
      const BodyFrame& b = frame.body(i);
      if (b.id == BodyId{} || frame.info(i).type == BodyType::fixed) continue;
      if (!b.pose.x.allFinite() || !b.pose.q.coeffs().allFinite() || !b.v.allFinite() ||
          !b.omega.allFinite())
        fail(v, frame, frame.info(i).name + " is not finite");
      else if (outside(b.pose.x))
        fail(v, frame, frame.info(i).name + " left the box");
    }
  }

  void check_particles(const Frame& frame, SceneVerdict& v) {
    for (const auto& system : frame.particles) {
      if (!system) continue;
      for (const Vec3& x : system->x) {
        if (!x.allFinite()) return fail(v, frame, "a particle is not finite");
        if (outside(x)) return fail(v, frame, "a particle left the box");
      }
    }
  }

  /// Energy beyond the start's, booked work and what explicit Euler makes, against the greatest
  /// that there was to move: kinetic energy at the start, and what went through the books.
  void check_energy(const Frame& frame, SceneVerdict& v) {
    const double now = frame.stats.energies.total();
    if (!std::isfinite(now)) return fail(v, frame, "the energy is not finite");
    const double scale =
        std::max(kinetic_start_ + frame.ledger->throughput(), 1e-9 * std::fabs(start_));
    if (!(scale > 0)) return;
    const double made = euler_ ? euler_->total() : 0;
    const double excess = (now - start_ - work_from_outside(*frame.ledger) - made) / scale;
    v.energy_excess = std::max(v.energy_excess, excess);
    if (!(excess <= bars_.energy))
      fail(v, frame,
           fmt::format(
               "energy grew from {:.4g} J to {:.4g} J, of which {:.4g} J are booked work and "
               "{:.4g} J what explicit Euler makes",
               start_, now, work_from_outside(*frame.ledger), made));
  }

  /// Radius of the smaller of two bodies that the scene drew; walls are called otherwise [m].
  double radius_of(const std::string& a, const std::string& b) const {
    double least = scene_.half_room;
    for (const std::string& name : {a, b})
      for (size_t i = 0; i < scene_.radii.size(); ++i)
        if (name == fmt::format("b{}", i)) least = std::min(least, scene_.radii[i]);
    return least;
  }

  void check_overlap(SceneVerdict& v) {
    for (const Overlap& o : built_.world->overlaps(1e-9 * scene_.half_room)) {
      const auto name = [&](BodyId id) {
        const auto def = built_.world->body_def(id);
        return def ? def->name : std::string("?");
      };
      const std::string a = name(o.a), b = name(o.b);
      const double share = o.depth / radius_of(a, b);
      v.overlap = std::max(v.overlap, share);
      if (share > bars_.overlap)
        fail(v, *built_.world->frame(),
             fmt::format("{} and {} overlap by {:.3g} m", a, b, o.depth));
    }
  }

  const RandomScene& scene_;
  const BuiltScene& built_;
  Bars bars_;
  double start_ = 0, kinetic_start_ = 0;  // [J]
  std::optional<EulerGain> euler_;
};

}  // namespace

std::string SceneVerdict::text() const {
  return fmt::format(
      "{} ({:.3g} s of processor, slowest tick {:.3g} s, overlap {:.2g}, energy {:+.2g}, {} ticks "
      "time-stepped)",
      right() ? "right" : "wrong: " + fault, cpu, slowest_tick, overlap, energy_excess,
      time_stepped);
}

SceneVerdict judge_scene(const RandomScene& scene, const std::string& stepper, double seconds) {
  SceneVerdict v;
  const SceneRead read = read_scene(scene.text, "random.json");
  if (!read.ok()) {
    v.fault = "not valid: " + read.faults.front().text();
    return v;
  }
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  if (!built) {
    v.fault = "not built: " + built.error().text();
    return v;
  }
  World& world = *built->world;
  Judge judge(scene, *built, bars_of(stepper));
  const double tick = world.settings().tick.tick();
  const auto ticks = uint64_t(std::llround(seconds / tick));
  const uint64_t every = std::max<uint64_t>(1, ticks / 10);
  for (uint64_t i = 1; i <= ticks && v.right(); ++i) {
    const double begin = processor_time();
    const auto step = world.step();
    const double spent = processor_time() - begin;
    v.cpu += spent;
    v.slowest_tick = std::max(v.slowest_tick, spent);
    if (!step) {
      v.fault = fmt::format("broke down in tick {}: {}", i, step.error().text());
      return v;
    }
    judge.after_tick(v, i % every == 0);
  }
  return v;
}

}  // namespace tumble
