#include "viewer/ui/pins.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

bool Pins::has(const Pin& pin) const {
  return std::ranges::find(all, pin) != all.end();
}

void Pins::flip(const Pin& pin) {
  if (std::erase(all, pin) == 0) all.push_back(pin);
}

void Pins::rename(std::string_view list, const std::string& from, const std::string& to) {
  for (Pin& pin : all) {
    if (list == "bodies") pin.body = renamed_item(pin.body, from, to);
    if (list == "joints") pin.joint = renamed_item(pin.joint, from, to);
  }
}

std::string renamed_item(const std::string& name, const std::string& from, const std::string& to) {
  const bool same =
      name.starts_with(from) && (name.size() == from.size() || name[from.size()] == '[');
  return same ? to + name.substr(from.size()) : name;
}

SliderRange slider_range(double value, double least, double most) {
  const double reach = value == 0 ? 1 : 2 * std::abs(value);
  return {std::max(least, -reach), std::min(most, reach)};
}

}  // namespace tumble
