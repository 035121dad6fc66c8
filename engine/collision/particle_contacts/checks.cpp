#include "engine/collision/particle_contacts/checks.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

Error bad_particles(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), {}, {}};
}

}  // namespace

Status check_balls(const ParticleBalls& balls) {
  if (balls.x.size() != balls.radius.size())
    return bad_particles(
        fmt::format("{} positions but {} radii", balls.x.size(), balls.radius.size()));
  for (size_t i = 0; i < balls.x.size(); ++i) {
    if (!balls.x[i].allFinite())
      return bad_particles(fmt::format("position of particle {} is not finite", i));
    if (!(balls.radius[i] >= 0) || !std::isfinite(balls.radius[i]))
      return bad_particles(
          fmt::format("radius of particle {} must be >= 0, got {} m", i, balls.radius[i]));
  }
  return {};
}

Status check_paths(const ParticlePaths& paths) {
  if (Status s = check_balls(paths.start); !s) return s;
  if (paths.v.size() != paths.start.x.size())
    return bad_particles(
        fmt::format("{} positions but {} velocities", paths.start.x.size(), paths.v.size()));
  if (!(paths.h >= 0) || !std::isfinite(paths.h))
    return bad_particles(fmt::format("h must be >= 0, got {} s", paths.h));
  for (size_t i = 0; i < paths.v.size(); ++i)
    if (!(paths.start.x[i] + paths.h * paths.v[i]).allFinite())
      return bad_particles(fmt::format("path of particle {} is not finite", i));
  return {};
}

Status check_length(const char* name, double value, bool zero_allowed) {
  if (std::isfinite(value) && (zero_allowed ? value >= 0 : value > 0)) return {};
  return bad_particles(
      fmt::format("{} must be {} 0, got {} m", name, zero_allowed ? ">=" : ">", value));
}

}  // namespace tumble
