// References: the definition of a quotient (what it leaves of the dividend), and the identities of
// small vectors.
#include "engine/math/double_double.hpp"

#include "engine/core/random.hpp"
#include "engine/math/triple.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("a quotient of sums of two doubles leaves nothing of the dividend") {
  Random r(5);
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::pow(10.0, r.uniform(-20, 20));
    const DoubleDouble a = DoubleDouble{r.uniform(-1, 1), 0} * DoubleDouble{scale, 1e-17 * scale},
                       b{r.uniform(0.1, 2), r.uniform(-1, 1) * 1e-17};
    const DoubleDouble rest = a - (a / b) * b;
    CHECK(std::abs(rest.high) <= 1e-30 * std::abs(a.high));
  }
  const DoubleDouble third = DoubleDouble{1, 0} / DoubleDouble{3, 0};
  CHECK(third.high == 1.0 / 3);
  CHECK(third.low == doctest::Approx(1.0 / 3 * 0x1p-54).epsilon(1e-12));
}

TEST_CASE("plain vectors do what those of doubles do") {
  Random r(6);
  const auto draw = [&r] { return Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)); };
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = draw(), b = draw();
    const Plain3 p = Plain3::of(a), q = Plain3::of(b);
    CHECK((p + q).vec() == a + b);
    CHECK((p - q).vec() == a - b);
    CHECK((-p * 3.0).vec() == -a * 3.0);
    CHECK(std::abs(p.dot(q) - a.dot(b)) < 1e-15);
    CHECK(((p.cross(q)).vec() - a.cross(b)).norm() < 1e-15);
  }
}
