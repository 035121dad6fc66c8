#include "viewer/render/particle_trails.hpp"

#include "viewer/render/particle_colours.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Samples along a path: enough for a parabola to look smooth.
constexpr double samples_of_path = 32;
/// Number of lines of one system that a renderer still draws fluently.
constexpr size_t most_lines = 200'000;
constexpr float brightest_path = 0.7f;  ///< opacity right behind the particle
constexpr float path_width = 1.5f;      ///< [px]

uint64_t ticks_between(double seconds, const Frame& frame) {
  return uint64_t(std::max(1.0, std::ceil(seconds / frame.rate.tick() / samples_of_path)));
}

/// The place of a particle, or null. `at` goes on through ascending ids from call to call.
template <class Places>
const Vec3* find_place(const Places& places, uint64_t id, size_t& at) {
  while (at < places.ids.size() && places.ids[at] < id) ++at;
  return at < places.ids.size() && places.ids[at] == id ? &places.x[at] : nullptr;
}

/// Paths are drawn for every n-th particle; n is the least power of two with which there are not
/// too many lines.
uint64_t stride_for(size_t particles, size_t samples) {
  uint64_t stride = 1;
  while (particles / stride * samples > most_lines) stride *= 2;
  return stride;
}

/// Whether the particle left the periodic box through a face on the way, so that a straight line
/// would cross the box.
bool crosses(const PeriodicBox& box, const Vec3& a, const Vec3& b) {
  return box.any() && box.shortest(b - a) != b - a;
}

const ParticleFrame* find_system(const Frame& frame, ParticleSystemId id) {
  for (const auto& system : frame.particles)
    if (system->id == id) return system.get();
  return nullptr;
}

}  // namespace

void ParticleTrails::see(const Frame& frame) {
  std::erase_if(paths_, [&frame](const Path& path) {
    const ParticleFrame* system = find_system(frame, path.id);
    return !system || !(system->look.trail > 0);
  });
  for (const auto& system : frame.particles) {
    const double seconds = system->look.trail;
    if (!(seconds > 0)) continue;
    auto path = std::ranges::find(paths_, system->id, &Path::id);
    if (path == paths_.end()) path = paths_.insert(paths_.end(), {system->id, {}});
    std::deque<Sample>& samples = path->samples;
    while (!samples.empty() && samples.back().tick >= frame.tick) samples.pop_back();
    const uint64_t every = ticks_between(seconds, frame);
    if (!samples.empty() && frame.tick / every <= samples.back().tick / every) continue;
    samples.push_back({frame.tick, frame.time, system->ids, system->x});
    // One sample before the reach is kept: the oldest line ends there.
    while (samples.size() > 2 && samples[1].time < frame.time - seconds) samples.pop_front();
  }
}

void ParticleTrails::draw(const Frame& from, const Frame& to, double s, RenderScene& out) const {
  const double now = from.time + s * (to.time - from.time);
  for (const Path& path : paths_) {
    const ParticleFrame* system = find_system(to, path.id);
    if (!system) continue;
    const ParticleFrame* before = find_system(from, path.id);
    const bool coloured = system->value.size() == system->x.size() && !system->range.empty();
    const NiceScale scale = coloured ? colour_scale(*system) : NiceScale{};
    const auto opacity = [&](double time) {
      return brightest_path * float(std::clamp(1 - (now - time) / system->look.trail, 0.0, 1.0));
    };
    const uint64_t stride = stride_for(system->x.size(), path.samples.size());
    size_t then = 0;
    std::vector<size_t> at(path.samples.size(), 0);
    for (size_t i = 0; i < system->x.size(); ++i) {
      const uint64_t id = system->ids[i];
      if (id % stride != 0) continue;
      const Vec3f colour = coloured
                               ? viridis_linear(double(system->value[i]), scale.low, scale.high)
                               : system->colour[i];
      Vec3 next = system->x[i];
      const Vec3* earlier = before ? find_place(*before, id, then) : nullptr;
      if (earlier && s < 1 && !crosses(system->box, *earlier, next))
        next = *earlier + s * (next - *earlier);
      double next_time = now;
      for (size_t k = path.samples.size(); k-- > 0 && opacity(next_time) > 0;) {
        const Sample& sample = path.samples[k];
        if (sample.time >= now) continue;
        const Vec3* x = find_place(sample, id, at[k]);
        if (!x || crosses(system->box, *x, next)) break;
        const float dim = 0.5f * (opacity(sample.time) + opacity(next_time));
        out.lines.push_back({.a = x->cast<float>(),
                             .b = next.cast<float>(),
                             .colour = {colour.x(), colour.y(), colour.z(), dim},
                             .width = path_width,
                             .occlusion = Occlusion::hidden});
        next = *x;
        next_time = sample.time;
      }
    }
  }
}

}  // namespace tumble
