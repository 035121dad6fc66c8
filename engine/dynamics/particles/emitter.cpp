#include "engine/dynamics/particles/emitter.hpp"

#include "engine/dynamics/particles/tolerances.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

using tolerances::count_rounding;
using tolerances::most_births;

namespace {

constexpr size_t most_bursts = 1000;
constexpr size_t most_curve_values = 1000;

uint64_t whole(double x) {
  return x > 0 ? uint64_t(std::min(std::floor(x * (1 + count_rounding)), most_births)) : 0;
}

Error emitter_error(const EmitterDef& def, std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), "emitter '" + def.name + "'",
          std::move(cure)};
}

std::string number_fault(const char* name, const RandomNumber& n, const char* unit) {
  if (n.spread >= 0 && std::isfinite(n.spread) && !std::isnan(n.mean)) return {};
  return fmt::format("{} must be a number with a spread >= 0, got {} and {} {}", name, n.mean,
                     n.spread, unit);
}

std::string positive_fault(const char* name, const RandomNumber& n, const char* unit) {
  if (std::string fault = number_fault(name, n, unit); !fault.empty()) return fault;
  if (n.least() > 0) return {};
  return fmt::format("{} must be > 0, but it may be {} {}", name, n.least(), unit);
}

std::string schedule_fault(const EmitterDef& d) {
  if (!(d.rate >= 0 && std::isfinite(d.rate)))
    return fmt::format("rate must be >= 0, got {} 1/s", d.rate);
  if (!(d.start >= 0 && std::isfinite(d.start)))
    return fmt::format("start must be >= 0, got {} s", d.start);
  if (!(d.end > d.start)) return fmt::format("end must be after start, got {} s", d.end);
  if (d.bursts.size() > most_bursts)
    return fmt::format("at most {} bursts, got {}", most_bursts, d.bursts.size());
  for (const Burst& b : d.bursts) {
    if (!(b.time >= 0 && std::isfinite(b.time)))
      return fmt::format("the time of a burst must be >= 0, got {} s", b.time);
    if (b.count < 1 || b.times < 1)
      return fmt::format("a burst needs a count and times >= 1, got {} and {}", b.count, b.times);
    if (b.times > 1 && !(b.every > 0 && std::isfinite(b.every)))
      return fmt::format("bursts need time between them, got {} s", b.every);
  }
  return {};
}

std::string curve_fault(const FactorCurve& curve) {
  if (curve.points.size() > most_curve_values)
    return fmt::format("at most {} values over time", most_curve_values);
  for (size_t i = 0; i < curve.points.size(); ++i) {
    if (!std::isfinite(curve.points[i].time) || !std::isfinite(curve.points[i].value))
      return "a value over time is not finite";
    if (i > 0 && !(curve.points[i].time > curve.points[i - 1].time))
      return fmt::format("times must ascend, got {} s after {} s", curve.points[i].time,
                         curve.points[i - 1].time);
  }
  return {};
}

std::string course_fault(const EmitterDef& d) {
  std::string fault;
  EmissionCourse::for_factors(d.over_time, [&fault](const FactorCurve& curve) {
    if (fault.empty()) fault = curve_fault(curve);
  });
  if (!fault.empty()) return fault;
  const EmissionCourse& c = d.over_time;
  for (const auto& [name, curve] : {std::pair{"rate", &c.rate}, {"spread", &c.spread}})
    if (curve->least() < 0)
      return fmt::format("factors of {} must be >= 0, got {}", name, curve->least());
  for (const auto& [name, curve] :
       {std::pair{"life", &c.life}, {"mass", &c.mass}, {"radius", &c.radius}})
    if (!(curve->least() > 0))
      return fmt::format("factors of {} must be > 0, got {}", name, curve->least());
  if (d.spread * c.spread.most() > det::pi)
    return fmt::format("spread must be at most pi, got {} rad", d.spread * c.spread.most());
  for (size_t i = 1; i < c.colour.points.size(); ++i)
    if (!(c.colour.points[i].time > c.colour.points[i - 1].time))
      return "times of colours must ascend";
  return {};
}

std::string value_fault(const EmitterDef& d) {
  if (!d.pose.x.allFinite() || !d.pose.q.coeffs().allFinite()) return "pose is not finite";
  if (!(d.spread >= 0 && d.spread <= det::pi))
    return fmt::format("spread must be in 0..pi, got {} rad", d.spread);
  if (!std::isfinite(d.inherit)) return "inherit is not finite";
  for (std::string fault :
       {number_fault("speed", d.speed, "m/s"), number_fault("spin", d.spin, "rad/s"),
        positive_fault("life", d.life, "s"), positive_fault("mass", d.mass, "kg"),
        positive_fault("radius", d.radius, "m")})
    if (!fault.empty()) return fault;
  for (const RandomNumber* n : {&d.speed, &d.spin, &d.mass, &d.radius})
    if (!std::isfinite(n->mean)) return "speed, spin, mass and radius must be finite";
  if (std::max({d.size_over_life.size(), d.mass_over_life.size(), d.colour_over_life.size(),
                d.opacity_over_life.size()}) > most_curve_values)
    return fmt::format("at most {} values over a life", most_curve_values);
  for (const auto& [name, factors] :
       {std::pair{"size", &d.size_over_life}, {"mass", &d.mass_over_life}})
    for (const double f : *factors)
      if (!(f > 0 && std::isfinite(f)))
        return fmt::format("factors of the {} must be > 0, got {}", name, f);
  for (const double f : d.opacity_over_life)
    if (!(f >= 0 && f <= 1))
      return fmt::format("factors of the opacity must be in 0..1, got {}", f);
  const bool lasting = !std::isfinite(d.life.mean);
  if (lasting && d.changes())
    return "size, mass, colour and opacity over a life need a life that ends";
  return {};
}

std::string event_fault(const EmitterDef& d) {
  for (const SpawnRule& r : d.events) {
    if (r.emitter.is_null() && !(r.on == SpawnRule::On::collision && r.dies))
      return "an event needs an emitter";
    if (r.count < 1) return fmt::format("the count of an event must be >= 1, got {}", r.count);
    if (!(r.rate >= 0 && std::isfinite(r.rate)))
      return fmt::format("the rate of an event must be >= 0, got {} 1/s", r.rate);
  }
  return {};
}

std::string content_fault(const EmitterDef& d) {
  const bool bodies = d.particles.is_null();
  if (bodies != bool(d.body)) return "an emitter has either particles or a body";
  if (!bodies) return {};
  if (d.changes()) return "only particles change over their life";
  return {};
}

/// Whether rate and bursts go on for ever.
bool endless(const EmitterDef& d) {
  const FactorCurve& factor = d.over_time.rate;
  const bool ends = std::isfinite(d.end) || (!factor.empty() && factor.points.back().value == 0);
  return d.rate > 0 && !ends && d.count == ~uint64_t{0};
}

/// When the rate makes number k, counted from 1.
double time_by_rate(const EmitterDef& d, uint64_t k) {
  const double share = double(k) / d.rate;
  return d.over_time.rate.empty() ? d.start + share
                                  : d.over_time.rate.time_of_integral(d.start, share);
}

template <class T, class Scalar>
T between(std::span<const T> values, double u, Scalar) {
  const double at = u * double(values.size() - 1);
  const size_t i = std::min(size_t(std::max(at, 0.0)), values.size() - 1);
  if (i + 1 == values.size()) return values[i];
  const auto w = Scalar(at - double(i));
  return T((1 - w) * values[i] + w * values[i + 1]);
}

EmissionPoint drawn_point(const Emitter& e, const EmissionPlace& place, double time, Random& random,
                          Vec3& direction) {
  const EmissionPoint at = e.shape->draw(random);
  const Vec3 axis = e.def->outward ? at.outward : Vec3::UnitY();
  const double spread = e.def->spread * e.def->over_time.spread.at(time);
  direction = place.frame.direction(direction_in_cone(random, axis, det::cos(spread)));
  return at;
}

/// One of the colours, or that of the time; `own` where there is neither.
Vec3f drawn_colour(const EmitterDef& d, double time, Random& random, const Vec3f& own) {
  const Vec3f drawn = d.colours.empty() ? own : d.colours[random.below(uint32_t(d.colours.size()))];
  return d.over_time.colour.at(time, drawn);
}

/// About any axis, besides the turning of what it comes from.
Vec3 drawn_spin(const EmitterDef& d, const EmissionPlace& place, double time, Random& random) {
  Vec3 out = d.inherit * place.omega;
  if (const double spin = d.spin.draw(random) * d.over_time.spin.at(time); spin != 0)
    out += spin * random_unit_vector(random);
  return out;
}

}  // namespace

Status validate(const EmitterDef& def) {
  for (const std::string& fault : {content_fault(def), schedule_fault(def), value_fault(def),
                                   course_fault(def), event_fault(def)})
    if (!fault.empty()) return emitter_error(def, fault);
  if (endless(def) && !std::isfinite(def.life.mean) && def.at_most == ~uint64_t{0})
    return emitter_error(def, "it makes more and more, without end",
                         "give a life, an end, a count or at_most");
  if (auto made = EmissionShape::make(def.shape); !made)
    return emitter_error(def, made.error().message, made.error().cure);
  return {};
}

uint64_t count_by_rate(const EmitterDef& def, double time) {
  const double until = std::min(time, def.end);
  if (def.over_time.rate.empty()) return whole(def.rate * (until - def.start));
  return until > def.start ? whole(def.rate * def.over_time.rate.integral(def.start, until)) : 0;
}

uint64_t bursts_by(const Burst& burst, double time) {
  const double since = time - burst.time;
  if (!(since >= -count_rounding * time)) return 0;
  if (burst.times == 1) return 1;
  return std::min(uint64_t(burst.times), 1 + whole(since / burst.every));
}

void take_due(Emitter& e, double time, std::vector<double>& births) {
  const EmitterDef& d = *e.def;
  const auto begin = ptrdiff_t(births.size());
  const uint64_t room = d.count - std::min(d.count, e.scheduled);
  uint64_t taken = 0;
  const auto add = [&](double t) {
    births.push_back(std::min(std::max(t, e.emitted_to), time));
    ++taken;
  };
  const uint64_t by_now = count_by_rate(d, time);
  for (uint64_t k = count_by_rate(d, e.emitted_to) + 1; k <= by_now && taken < room; ++k)
    add(time_by_rate(d, k));
  for (const Burst& b : d.bursts) {
    const uint64_t so_far = bursts_by(b, time);
    for (uint64_t k = bursts_by(b, e.emitted_to); k < so_far; ++k)
      for (int i = 0; i < b.count && taken < room; ++i) add(b.time + double(k) * b.every);
  }
  std::sort(births.begin() + begin, births.end());
  e.scheduled += taken;
  e.emitted_to = time;
}

bool spent(const Emitter& e) {
  const EmitterDef& d = *e.def;
  if (e.scheduled >= d.count) return true;
  if (d.rate > 0 && count_by_rate(d, d.end) > count_by_rate(d, e.emitted_to)) return false;
  return std::ranges::all_of(
      d.bursts, [&e](const Burst& b) { return bursts_by(b, e.emitted_to) == uint64_t(b.times); });
}

double over_life(std::span<const double> values, double u) {
  return between(values, u, double{});
}

Vec3f over_life(std::span<const Vec3f> values, double u) {
  return between(values, u, float{});
}

ParticleDef next_particle(Emitter& e, const EmissionPlace& place, double time) {
  const EmitterDef& d = *e.def;
  Random random = numbered_random(d.seed, e.made++);
  ParticleDef out;
  Vec3 direction;
  const EmissionCourse& course = d.over_time;
  out.x = place.frame.point(drawn_point(e, place, time, random, direction).x);
  out.v = d.speed.draw(random) * course.speed.at(time) * direction +
          d.inherit * place.velocity_at(out.x);
  out.life = d.life.draw(random) * course.life.at(time);
  out.mass = d.mass.draw(random) * course.mass.at(time);
  out.radius = d.radius.draw(random) * course.radius.at(time);
  out.colour = drawn_colour(d, time, random, out.colour);
  out.spin = drawn_spin(d, place, time, random);
  return out;
}

EmittedBody next_body(Emitter& e, const EmissionPlace& place, double time) {
  const EmitterDef& d = *e.def;
  const uint64_t number = e.made++;
  Random random = numbered_random(d.seed, number);
  EmittedBody out{*d.body};
  Vec3 direction;
  out.def.name = fmt::format("{}[{}]", d.name, number);
  out.def.pose.x = place.frame.point(drawn_point(e, place, time, random, direction).x);
  out.def.velocity = d.speed.draw(random) * d.over_time.speed.at(time) * direction +
                     d.inherit * place.velocity_at(out.def.pose.x);
  out.life = d.life.draw(random) * d.over_time.life.at(time);
  const Quat turn = d.any_orientation ? random_orientation(random) : place.frame.q;
  out.def.pose.q = (turn * d.body->pose.q).normalized();
  out.def.angular_velocity = drawn_spin(d, place, time, random);
  out.def.look.colour = drawn_colour(d, time, random, out.def.look.colour);
  return out;
}

}  // namespace tumble
