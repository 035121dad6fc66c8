#include "engine/collision/shapes/validation.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

Error bad_length(std::string_view name, std::string_view rule, double metres) {
  return {ErrorCode::invalid_argument,
          fmt::format("{} must be {}, got {} m", name, rule, metres),
          {},
          {}};
}

}  // namespace

Status require_positive(std::string_view name, double metres) {
  if (!std::isfinite(metres)) return bad_length(name, "finite", metres);
  if (!(metres > 0)) return bad_length(name, "> 0", metres);
  if (metres < min_shape_size) return bad_length(name, "at least 1e-6 m", metres);
  if (metres > max_shape_size) return bad_length(name, "at most 1e6 m", metres);
  return {};
}

Status require_not_negative(std::string_view name, double metres) {
  if (!std::isfinite(metres)) return bad_length(name, "finite", metres);
  if (!(metres >= 0)) return bad_length(name, ">= 0", metres);
  if (metres > max_shape_size) return bad_length(name, "at most 1e6 m", metres);
  return {};
}

}  // namespace tumble
