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

SliderRange slider_range(double value, double least, double most) {
  const double reach = value == 0 ? 1 : 2 * std::abs(value);
  return {std::max(least, -reach), std::min(most, reach)};
}

}  // namespace tumble
