// Work that is counted and bounded. Reference: charges added up by hand.
#include "engine/core/work_meter.hpp"

#include <thread>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("work is charged to the meter of this thread that was last, and to none without one") {
  charge_work(5);
  WorkMeter outer, inner;
  {
    const Metered counted(outer);
    charge_work(3);
    {
      const Metered within(inner);
      charge_work(7, 2);
    }
    charge_work(1, 2, 3);
    std::thread([] { charge_work(100); }).join();
  }
  charge_work(11);
  CHECK(outer.spent() == 9);
  CHECK(inner.spent() == 14);
  CHECK_FALSE(outer.exhausted());
}

TEST_CASE("work beyond what a meter allows is asked to stop, and only that work") {
  WorkMeter outer(100), inner(10);
  {
    const Metered counted(outer);
    {
      const Metered within(inner);
      charge_work(10);
      CHECK_FALSE(stop_requested());
      charge_work(1);
      CHECK(stop_requested());
    }
    CHECK_FALSE(stop_requested());
    charge_work(90);
    CHECK_FALSE(stop_requested());
  }
  CHECK(inner.exhausted());
  CHECK_FALSE(outer.exhausted());
}

TEST_CASE("a request to stop reaches metered work with its next charge") {
  StopFlag flag;
  const Stoppable scope(&flag);
  WorkMeter outer, inner;
  const Metered counted(outer);
  const Metered within(inner);
  flag.request();
  charge_work(1);
  CHECK(stop_requested());
  CHECK_FALSE(inner.exhausted());
}

TEST_CASE("work that a meter does not allow is not begun, and costs as much as if it had been") {
  WorkMeter meter(100);
  {
    const Metered counted(meter);
    charge_work(40);
    CHECK(may_begin_work(60));
    CHECK(meter.spent() == 40);
    CHECK_FALSE(may_begin_work(61));
    CHECK(meter.spent() == 101);
    CHECK_FALSE(may_begin_work(1));
  }
  WorkMeter any;
  const Metered counted(any);
  CHECK(may_begin_work(~uint64_t{0}));
}

TEST_CASE("work is not begun after a request to stop, metered or not") {
  StopFlag flag;
  const Stoppable scope(&flag);
  CHECK(may_begin_work(1));
  WorkMeter meter;
  const Metered counted(meter);
  CHECK(may_begin_work(1));
  flag.request();
  CHECK_FALSE(may_begin_work(1));
  CHECK(meter.spent() == 0);
}
