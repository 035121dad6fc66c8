// The accuracy cases of many bodies, A3, A9 and A10 (tests/support/accuracy/cases.hpp), under the
// event stepper, through World. References: conservation laws, the books of impulses, overlap of
// balls by their centres alone, and that what is in balance does not move.
#include "tests/support/accuracy/cases.hpp"
#include "tests/world/event_case.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("accuracy: halves of a block of elastic balls fly through each other (A3z)") {
  const GasErrors e = a3_gas(event_maker(), 60, false, case_seconds(3, 0.3));
  CHECK(e.energy_most < 1e-9);
  CHECK(e.momentum < 1e-12);
}

TEST_CASE(
    "accuracy: 216 elastic balls keep their energy, and momentum comes from what is booked (A3)") {
  double moved = 0;  // momentum that gravity and contacts gave, summed over ticks
  const auto booked = [&moved](const World& w) {
    const Ledger& books = *w.frame()->ledger;
    for (const LedgerLine line : {LedgerLine::gravity, LedgerLine::restitution})
      moved += books.line(line).tick.momentum.norm();
    const Vec3 unexplained = books.line(LedgerLine::integrator).total().momentum;
    CHECK(unexplained.norm() < 1e-12 * moved);
  };
  const GasErrors e =
      a3_gas(event_maker(event_settings(), booked), 60, true, case_seconds(10, 0.5));
  CHECK(e.energy_most < 1e-9);
}

TEST_CASE("accuracy: a card house stands (A9)") {
  const bool all = case_seconds(1, 0) > 0.99;
  const CardErrors e = a9_cards(event_maker(), 60, case_seconds(10, 0.5), all ? 5 : 3);
  CHECK(e.cards == (all ? 40 : 15));
  CHECK(e.moved_end < 1e-6);
  CHECK(e.kinetic < 1e-12);
}

TEST_CASE("accuracy: a heap of 216 inelastic balls overlaps nowhere (A10)") {
  // Balls leave and hit each other some 500 times a tick: the whole case takes minutes.
  CHECK(a10_penetration(event_maker(), 60, case_seconds(3, 0.1)) < 1e-5);
}
