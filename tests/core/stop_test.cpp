// Requests to stop. Reference: looks counted by hand.
#include "engine/core/stop.hpp"

#include "engine/core/crew.hpp"

#include <atomic>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("a request to stop is seen until it is cleared, by the work that it is meant for only") {
  StopFlag flag, other;
  CHECK_FALSE(stop_requested());
  {
    const Stoppable scope(&flag);
    CHECK_FALSE(stop_requested());
    flag.request();
    CHECK(stop_requested());
    CHECK(stop_requested());
    {
      const Stoppable inner(&other);
      CHECK_FALSE(stop_requested());
      const Stoppable none(nullptr);
      CHECK_FALSE(stop_requested());
    }
    CHECK(stop_requested());
    std::thread([] { CHECK_FALSE(stop_requested()); }).join();
    flag.clear();
    CHECK_FALSE(stop_requested());
  }
  flag.request();
  CHECK_FALSE(stop_requested());
}

TEST_CASE("a request can come after a number of looks") {
  StopFlag flag;
  const Stoppable scope(&flag);
  flag.request_after(3);
  for (int look = 0; look < 3; ++look) CHECK_FALSE(stop_requested());
  CHECK(flag.looks_left() == 0);
  for (int look = 0; look < 3; ++look) CHECK(stop_requested());
  flag.request_after(0);
  CHECK(stop_requested());
  flag.request_after(10);
  for (int look = 0; look < 4; ++look) CHECK_FALSE(stop_requested());
  CHECK(flag.looks_left() == 6);
}

TEST_CASE("the threads of a crew stop with the work that they help in") {
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    Crew crew(threads);
    StopFlag flag;
    flag.request();
    std::atomic<int> saw{0}, saw_without{0};
    const auto look = [](std::atomic<int>& count) {
      return [&count](size_t) { count += stop_requested(); };
    };
    {
      const Stoppable scope(&flag);
      crew.each(100, look(saw));
      crew.gather([&] { crew.each(100, look(saw)); });
    }
    crew.each(100, look(saw_without));
    crew.gather([&] { crew.each(100, look(saw_without)); });
    CHECK(saw == 200);
    CHECK(saw_without == 0);
  }
}
