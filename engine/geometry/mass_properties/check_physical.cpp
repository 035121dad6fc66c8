#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/principal_axes.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {

Status check_physical(const MassProperties& m, double slack) {
  const auto fault = [](std::string message) {
    return Error{ErrorCode::invalid_argument, std::move(message), {}, {}};
  };
  if (!std::isfinite(m.mass) || !m.centre.allFinite() || !m.inertia.allFinite()) {
    return fault("mass, centre or inertia is not finite");
  }
  if (!(m.mass > 0)) return fault(fmt::format("mass must be > 0, got {} kg", m.mass));
  const double size = m.inertia.cwiseAbs().maxCoeff();
  if ((m.inertia - m.inertia.transpose()).cwiseAbs().maxCoeff() > slack * size) {
    return fault("the inertia tensor is not symmetric");
  }
  const Vec3 p = principal_axes(m.inertia).moments;
  const std::string all = fmt::format("principal moments {}, {}, {} kg m2", p[0], p[1], p[2]);
  if (p[0] < -slack * p[2]) return fault(all + ": none can be negative");
  if (p[2] - (p[0] + p[1]) > slack * p[2]) {
    return fault(all + ": none can be larger than the sum of the other two");
  }
  return {};
}

}  // namespace tumble
