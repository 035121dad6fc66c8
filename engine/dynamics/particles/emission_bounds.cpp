#include "engine/dynamics/particles/emission_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double without_end = EmitterDef::for_ever;

/// Number of births in a network of emitters within time windows.
class Births {
 public:
  explicit Births(std::span<const NamedEmitter> emitters) : emitters_(emitters) {}

  /// The greatest number of births of an emitter in any window of so many seconds.
  double within(size_t e, double window) const {
    const EmitterDef& d = *emitters_[e].def;
    double sum = own(d, window);
    for (size_t p = 0; p < emitters_.size(); ++p)
      for (const SpawnRule& r : emitters_[p].def->events)
        if (!r.emitter.is_null() && r.emitter == emitters_[e].id) sum += by_event(p, r, window);
    return sum;
  }

 private:
  /// How long the rate may be above zero [s].
  static double rate_span(const EmitterDef& d) {
    const FactorCurve& factor = d.over_time.rate;
    const bool fades = !factor.empty() && factor.points.back().value == 0;
    const double end = fades ? std::min(d.end, factor.points.back().time) : d.end;
    return std::max(0.0, end - d.start);
  }

  /// Births by rate and bursts.
  static double own(const EmitterDef& d, double window) {
    double sum = 0;
    if (d.rate > 0) {
      const double span = std::min(window, rate_span(d));
      sum = span < without_end ? std::floor(d.rate * d.over_time.rate.most() * span) + 1
                               : without_end;
    }
    for (const Burst& b : d.bursts) {
      double times = b.times;
      if (b.times > 1) times = std::min(times, std::floor(window / b.every) + 1);
      sum += b.count * times;
    }
    return d.count == ~uint64_t{0} ? sum : std::min(sum, double(d.count));
  }

  /// Births by one of the rules of the particles of `parent`.
  double by_event(size_t parent, const SpawnRule& r, double window) const {
    const EmitterDef& d = *emitters_[parent].def;
    const double longest = d.most_life();
    switch (r.on) {
      case SpawnRule::On::birth:
        return r.count * within(parent, window);
      case SpawnRule::On::death: {
        const double later = std::isfinite(longest) ? longest - d.least_life() : without_end;
        return r.count * within(parent, window + later);
      }
      case SpawnRule::On::life: {
        const double lived = std::min(window, longest);
        const double each = r.rate > 0 ? std::floor(r.rate * lived) + 1 : 0;
        return each > 0 ? each * within(parent, window + longest) : 0;
      }
      case SpawnRule::On::collision: {
        const double parents = within(parent, window + longest);
        if (parents == 0) return 0;
        return r.dies ? r.count * parents : without_end;
      }
      case SpawnRule::On::sink:
        return r.count * within(parent, window + longest);
    }
    return without_end;
  }

  std::span<const NamedEmitter> emitters_;
};

}  // namespace

std::vector<double> most_alive(std::span<const NamedEmitter> emitters, double h) {
  const Births births(emitters);
  std::vector<double> out;
  for (size_t e = 0; e < emitters.size(); ++e) {
    const EmitterDef& d = *emitters[e].def;
    const double most = births.within(e, d.most_life() + h);
    out.push_back(d.at_most == ~uint64_t{0} ? most : std::min(most, double(d.at_most)));
  }
  return out;
}

}  // namespace tumble
