#include "viewer/app/verify/lockstep.hpp"

#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string body_name(const Frame& frame, size_t slot) {
  const std::string& name = frame.info(slot).name;
  return name.empty() ? fmt::format("body {}", slot) : name;
}

void see(Divergence& d, double distance, const std::string& what) {
  // Of those that are equally far the first is named.
  if (!(distance > d.distance)) return;
  d.distance = distance;
  d.what = what;
}

void compare_bodies(const Frame& a, const Frame& b, Divergence& d) {
  const size_t slots = std::max(a.body_slots(), b.body_slots());
  for (size_t slot = 0; slot < slots; ++slot) {
    const bool in_a = slot < a.body_slots() && !a.body(slot).id.is_null();
    const bool in_b = slot < b.body_slots() && !b.body(slot).id.is_null();
    if (!in_a && !in_b) continue;
    if (in_a != in_b) {
      d.same_bits = false;
      see(d, infinite, body_name(in_a ? a : b, slot));
      continue;
    }
    const BodyFrame &p = a.body(slot), &q = b.body(slot);
    if (p.pose.x == q.pose.x && p.pose.q.coeffs() == q.pose.q.coeffs() && p.v == q.v &&
        p.omega == q.omega)
      continue;
    d.same_bits = false;
    see(d, (p.pose.x - q.pose.x).norm(), body_name(a, slot));
    d.angle = std::max(d.angle, p.pose.q.angularDistance(q.pose.q));
    d.speed = std::max(d.speed, (p.v - q.v).norm());
  }
}

void compare_particles(const ParticleFrame& a, const ParticleFrame& b, Divergence& d) {
  const size_t common = std::min(a.x.size(), b.x.size());
  for (size_t i = 0; i < common; ++i) {
    if (a.x[i] == b.x[i]) continue;
    d.same_bits = false;
    see(d, (a.x[i] - b.x[i]).norm(), fmt::format("{} particle {}", a.name, i));
  }
  if (a.x.size() == b.x.size()) return;
  d.same_bits = false;
  see(d, infinite, fmt::format("{} particle {}", a.name, common));
}

Status step_one(World& world, const char* which) {
  const auto done = world.step();
  if (done) return {};
  Error error = done.error();
  error.place = error.place.empty() ? which : fmt::format("{}: {}", which, error.place);
  return error;
}

}  // namespace

Divergence divergence(const Frame& a, const Frame& b) {
  Divergence d;
  d.time = a.time;
  d.tick_a = a.tick;
  d.tick_b = b.tick;
  compare_bodies(a, b, d);
  const ParticleFrame none;
  for (size_t i = 0; i < std::max(a.particles.size(), b.particles.size()); ++i) {
    const auto of = [&](const Frame& f) -> const ParticleFrame& {
      return i < f.particles.size() && f.particles[i] ? *f.particles[i] : none;
    };
    compare_particles(of(a), of(b), d);
  }
  return d;
}

Status run_lockstep(World& a, World& b, double seconds,
                    const std::function<bool(const Divergence&)>& each) {
  // Times are n/rate, whole numbers over one denominator: equal moments are found exactly.
  const TickRate ra = a.settings().tick, rb = b.settings().tick;
  const auto time_a = [&] { return int64_t(a.tick()) * ra.den * rb.num; };
  const auto time_b = [&] { return int64_t(b.tick()) * rb.den * ra.num; };
  if (!each(divergence(*a.frame(), *b.frame()))) return {};
  while (std::min(a.time(), b.time()) < seconds - 0.5 * std::min(ra.tick(), rb.tick())) {
    const int64_t ta = time_a(), tb = time_b();
    if (ta <= tb)
      if (const Status s = step_one(a, "A"); !s) return s;
    if (tb <= ta)
      if (const Status s = step_one(b, "B"); !s) return s;
    if (time_a() == time_b() && !each(divergence(*a.frame(), *b.frame()))) return {};
  }
  return {};
}

}  // namespace tumble
