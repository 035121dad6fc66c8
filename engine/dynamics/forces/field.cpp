#include "engine/dynamics/forces/field.hpp"

#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/det/det.hpp"

namespace tumble {

// dw/dt = -(c + k |w|) w has the solution w e^{-ch} / (1 + k |w| s), s = (1 - e^{-ch}) / c, which
// is h for c = 0; the change of w is -w s (c + k |w|) / (1 + k |w| s).
Vec3 flow_acceleration(const Vec3& w, double rate, double k, double h) {
  const double speed = w.norm(), pull = rate + k * speed;
  if (!(h > 0)) return pull * w;
  // The series where the difference would lose digits.
  const double ch = rate * h;
  const double s = ch < tolerances::exponential_series ? h * (1 - ch / 2 * (1 - ch / 3))
                                                       : (1 - det::exp(-ch)) / rate;
  return s / h * pull / (1 + k * speed * s) * w;
}

}  // namespace tumble
