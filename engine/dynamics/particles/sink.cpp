#include "engine/dynamics/particles/sink.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {

bool holds(const SinkDef& sink, const Vec3& x_world) {
  const Vec3 x = sink.pose.inverse_point(x_world);
  return std::visit([&x](const auto& region) { return region.holds(x); }, sink.region) !=
         sink.outside;
}

Status validate(const SinkDef& def) {
  const auto fault = [&def](std::string message) {
    return Error{ErrorCode::invalid_argument, std::move(message), "sink '" + def.name + "'", {}};
  };
  if (!def.pose.x.allFinite() || !def.pose.q.coeffs().allFinite())
    return fault("pose is not finite");
  if (const auto* box = std::get_if<BoxSink>(&def.region))
    if (!(box->size.minCoeff() > 0 && box->size.allFinite())) return fault("size must be > 0");
  if (const auto* ball = std::get_if<SphereSink>(&def.region))
    if (!(ball->radius > 0 && std::isfinite(ball->radius)))
      return fault(fmt::format("radius must be > 0, got {} m", ball->radius));
  return {};
}

}  // namespace tumble
