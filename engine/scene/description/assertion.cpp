#include "engine/scene/description/assertion.hpp"

#include "engine/math/expression.hpp"

namespace tumble {

void AssertionDescription::check(const AssertionDescription& d, Complaints& complaints) {
  if (d.holds.empty()) return;  // which is said as of every required key
  const auto parsed = Expression::parse(d.holds);
  if (!parsed)
    complaints.add("holds", parsed.error().text());
  else if (!parsed->is_condition())
    complaints.add("holds",
                   "a quantity, but nothing is said of it: compare it, and each part "
                   "of an && or ||, as in \"bodies.ball.asleep == 1\"");
}

}  // namespace tumble
