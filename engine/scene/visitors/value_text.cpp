#include "engine/scene/visitors/value_text.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? fmt::format("{:.12g}", value) : fmt::format("{:.12g} {}", value, unit);
}

/// Greatest magnitude by unit. Lengths reach as far as positions may; velocities a few times those
/// of orbits around stars; m3/s2 (gravitational constant times mass) beyond that of the Sun;
/// Coulomb's constant is 9e9 N m2/C2.
double largest_magnitude(std::string_view unit) {
  static constexpr std::pair<std::string_view, double> largest[] = {
      {"m", 1e7},      {"m/s", 1e6},  {"m/s2", 1e9},   {"rad/s", 1e6},   {"deg", 1e6},
      {"deg/s", 1e8},  {"kg", 1e12},  {"kg/m3", 1e12}, {"kg m2", 1e24},  {"s", 1e7},
      {"Hz", 1e6},     {"1/s", 1e9},  {"1/s2", 1e9},   {"1/m", 1e7},     {"m2/s", 1e12},
      {"m3/s2", 1e21}, {"N/m", 1e12}, {"N s/m", 1e12}, {"N m2/C2", 1e15}};
  for (const auto& [name, value] : largest)
    if (name == unit) return value;
  return 1e9;  // pure numbers: factors, ratios, coefficients
}

}  // namespace

Parameter bounded(Parameter p) {
  const double most = largest_magnitude(p.unit);
  if (std::isinf(p.min)) p.min = -most;
  if (std::isinf(p.max)) p.max = most;
  return p;
}

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

std::string range_fault(double value, const Parameter& declared) {
  const Parameter p = bounded(declared);
  const bool low = p.exclusive_min ? !(value > p.min) : !(value >= p.min);
  if (!low && value <= p.max && std::isfinite(value)) return {};
  return range_text(p) + ", got " + with_unit(value, p.unit);
}

}  // namespace tumble
