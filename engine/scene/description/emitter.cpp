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

/// Checks that neither the mean nor the greatest value that the spread allows exceeds `most`.
void check_most(const std::optional<RandomNumberDescription>& d, const char* key, const char* unit,
                double most, Complaints& complaints) {
  if (!d) return;
  const double largest = std::max(std::fabs(d->number.most()), std::fabs(d->number.least()));
  if (largest > most)
    complaints.add(key,
                   fmt::format("must be <= {0:.12g} {1}, got {2:.12g} {1}", most, unit, largest));
}

/// Reports keys that have no meaning for the kind of thing it emits.
void check_kind(const EmitterDescription& d, Complaints& complaints) {
  if (d.particles.empty() == d.body.empty()) {
    complaints.add("", "an emitter has either particles or a body");
  } else if (!d.body.empty()) {
    if (d.mass) complaints.add("mass", "is of particles; a body has its own");
    if (d.radius) complaints.add("radius", "is of particles; a body has its own size");
    if (!d.size_over_life.empty()) complaints.add("size_over_life", "is of particles only");
    if (!d.mass_over_life.empty()) complaints.add("mass_over_life", "is of particles only");
    if (!d.colour_over_life.empty()) complaints.add("colour_over_life", "is of particles only");
  } else {
    if (d.random_orientation) complaints.add("random_orientation", "is of bodies only");
  }
}

/// Times must ascend; keys must not change values that the emitter does not have.
void check_course(const EmitterDescription& d, Complaints& complaints) {
  for (size_t i = 0; i < d.over_time.size(); ++i) {
    const std::string at = fmt::format("over_time[{}]", i);
    const EmissionKeyDescription& key = d.over_time[i];
    if (i > 0 && !(key.time > d.over_time[i - 1].time))
      complaints.add(at + ".time", "must be later than the one before");
    if (!d.body.empty() && key.mass) complaints.add(at + ".mass", "is of particles only");
    if (!d.body.empty() && key.radius) complaints.add(at + ".radius", "is of particles only");
    if (key.life && !d.life) complaints.add(at + ".life", "needs a life");
    if (key.spread && d.spread_deg * *key.spread > 180)
      complaints.add(at + ".spread", "makes spread_deg more than 180 deg");
  }
}

/// Whether the rate comes to an end by itself.
bool rate_ends(const EmitterDescription& d) {
  std::optional<double> last;
  for (const EmissionKeyDescription& key : d.over_time)
    if (key.rate) last = key.rate;
  return d.end || d.count || d.at_most || last == 0.0;
}

}  // namespace

void EmitterDescription::check(const EmitterDescription& d, Complaints& complaints) {
  check_kind(d, complaints);
  check_course(d, complaints);
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
    if (!d.mass_over_life.empty()) complaints.add("mass_over_life", "needs a life");
    if (!d.colour_over_life.empty()) complaints.add("colour_over_life", "needs a life");
    if (d.rate > 0 && !rate_ends(d))
      complaints.add("rate", "makes more and more without end: give life, end, count or at_most");
  }
}

}  // namespace tumble
