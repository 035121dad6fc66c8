#include "engine/scene/visitors/value_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? fmt::format("{:.12g}", value) : fmt::format("{:.12g} {}", value, unit);
}

}  // namespace

std::string range_text(const Parameter& p) {
  const bool below = std::isfinite(p.min), above = std::isfinite(p.max);
  const char* sign = p.exclusive_min ? ">" : ">=";
  if (below && above && p.min == p.max) return "must be " + with_unit(p.min, p.unit);
  if (below && above)
    return fmt::format("must be {} {:.12g} and <= {}", sign, p.min, with_unit(p.max, p.unit));
  if (below) return fmt::format("must be {} {}", sign, with_unit(p.min, p.unit));
  if (above) return "must be <= " + with_unit(p.max, p.unit);
  return "must be finite";
}

std::string range_fault(double value, const Parameter& p) {
  const bool low = p.exclusive_min ? !(value > p.min) : !(value >= p.min);
  if (!low && value <= p.max && std::isfinite(value)) return {};
  return range_text(p) + ", got " + with_unit(value, p.unit);
}

}  // namespace tumble
