#include "engine/scene/description/sensor.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

void check_size(const std::vector<double>& size, size_t extents, Complaints& complaints) {
  if (!size.empty() && size.size() != extents)
    complaints.add("size", fmt::format("must be {} numbers, got {}", extents, size.size()));
}

}  // namespace

void GateDescription::check(const GateDescription& d, Complaints& complaints) {
  if (d.radius.has_value() != d.size.empty()) complaints.add("", "a gate has a radius or a size");
  check_size(d.size, 2, complaints);
}

SensorShape GateDescription::shape() const {
  if (radius) return {SensorForm::disc, {*radius, 0, 0}};
  return {SensorForm::rectangle, {0.5 * size[0], 0, 0.5 * size[1]}};
}

void RegionDescription::check(const RegionDescription& d, Complaints& complaints) {
  if (d.radius.has_value() != d.size.empty())
    complaints.add("", "a region has a size, or a radius, or a radius and a height");
  else if (d.height && !d.radius)
    complaints.add("height", "a box has a size only");
  check_size(d.size, 3, complaints);
}

SensorShape RegionDescription::shape() const {
  if (radius && height) return {SensorForm::cylinder, {*radius, 0.5 * *height, 0}};
  if (radius) return {SensorForm::sphere, {*radius, 0, 0}};
  return {SensorForm::box, {0.5 * size[0], 0.5 * size[1], 0.5 * size[2]}};
}

}  // namespace tumble
