// Requests to stop. Reference: looks counted by hand.
#include "engine/core/stop.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/watched.hpp"

#include <atomic>
#include <thread>
#include <vector>

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

TEST_CASE("work tells how far it is to who watches it, on its own thread, as long as he does") {
  std::vector<double> seen;
  const ProgressSink sink = [&](double share) { seen.push_back(share); };
  tell_progress(0.1);
  {
    const Watched watched(&sink);
    tell_progress(0.2);
    {
      const Watched nobody(nullptr);
      tell_progress(0.3);
    }
    std::thread([] { tell_progress(0.4); }).join();
    tell_progress(0.5);
  }
  tell_progress(0.6);
  CHECK(seen == std::vector<double>{0.2, 0.5});
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
