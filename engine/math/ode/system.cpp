#include "engine/math/ode/system.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble::ode {

bool System::jacobian(double, std::span<const double>, std::span<double>) {
  return false;
}

void System::allowed_errors(const Tolerance& tolerance, std::span<const double> y,
                            std::span<double> allowed) const {
  for (size_t i = 0; i < y.size(); ++i) {
    allowed[i] = tolerance.position + tolerance.relative * std::abs(y[i]);
  }
}

std::string System::entry_name(size_t entry) const {
  return fmt::format("entry {}", entry);
}

void normalise_quaternion(std::span<double, 4> q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0)) return;
  for (double& c : q) c /= length;
}

}  // namespace tumble::ode
