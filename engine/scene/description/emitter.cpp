#include "engine/scene/description/emitter.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

void check_positive(const std::optional<RandomNumberDescription>& d, const char* key,
                    const char* unit, Complaints& complaints) {
  if (!d || d->number.least() > 0) return;
  if (d->number.spread == 0)
    complaints.add(key, fmt::format("must be > 0 {0}, got {1} {0}", unit, d->number.mean));
  else
    complaints.add(key, fmt::format("must be > 0 {0}, but with this spread it may be {1:.6g} {0}",
                                    unit, d->number.least()));
}

/// Neither a value nor the farthest that the spread allows may be larger.
void check_most(const std::optional<RandomNumberDescription>& d, const char* key, const char* unit,
                double most, Complaints& complaints) {
  if (!d) return;
  const double largest = std::max(std::fabs(d->number.most()), std::fabs(d->number.least()));
  if (largest > most)
    complaints.add(key,
                   fmt::format("must be <= {0:.12g} {1}, got {2:.12g} {1}", most, unit, largest));
}

/// Keys that mean nothing for what it emits.
void check_kind(const EmitterDescription& d, Complaints& complaints) {
  if (d.particles.empty() == d.body.empty()) {
    complaints.add("", "an emitter has either particles or a body");
  } else if (!d.body.empty()) {
    if (d.mass) complaints.add("mass", "is of particles; a body has its own");
    if (d.radius) complaints.add("radius", "is of particles; a body has its own size");
    if (!d.size_over_life.empty()) complaints.add("size_over_life", "is of particles only");
    if (!d.colour_over_life.empty()) complaints.add("colour_over_life", "is of particles only");
    if (!d.events.empty()) complaints.add("events", "are of particles only");
  } else {
    if (d.random_orientation) complaints.add("random_orientation", "is of bodies only");
    if (d.spin.number.mean != 0 || d.spin.number.spread != 0)
      complaints.add("spin", "is of bodies only: particles do not turn");
  }
}

}  // namespace

void EmitterDescription::check(const EmitterDescription& d, Complaints& complaints) {
  check_kind(d, complaints);
  check_positive(d.life, "life", "s", complaints);
  check_positive(d.mass, "mass", "kg", complaints);
  check_positive(d.radius, "radius", "m", complaints);
  check_most(d.life, "life", "s", 1e9, complaints);
  check_most(d.mass, "mass", "kg", 1e12, complaints);
  check_most(d.radius, "radius", "m", 1e6, complaints);
  check_most(d.speed, "speed", "m/s", 1e6, complaints);
  check_most(d.spin, "spin", "rad/s", 1e6, complaints);
  if (d.end && !(*d.end > d.start)) complaints.add("end", "must be after start");
  if (!d.life) {
    if (!d.size_over_life.empty()) complaints.add("size_over_life", "needs a life");
    if (!d.colour_over_life.empty()) complaints.add("colour_over_life", "needs a life");
    if (d.rate > 0 && !d.end && !d.count && !d.at_most)
      complaints.add("rate", "makes more and more without end: give life, end, count or at_most");
  }
}

}  // namespace tumble
