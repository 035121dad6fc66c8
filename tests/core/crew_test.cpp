// Threads that share many short loops. Reference: every chunk of every loop counted once, and seen
// by the loop after it.
#include "engine/core/crew.hpp"

#include "tests/support/scale.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("every chunk of many short loops is done once, before the next loop begins") {
  const int rounds = test::scale() < 1 ? 20 : 200;
  for (const int threads : {1, 2, 3, 8}) {
    CAPTURE(threads);
    Crew crew(threads);
    std::vector<uint32_t> seen(300);
    int wrong = 0;
    for (int round = 0; round < rounds; ++round) {
      std::fill(seen.begin(), seen.end(), 0u);
      crew.gather([&] {
        // Loops of falling and rising lengths: a late helper meets a longer loop than its own.
        for (uint32_t loop = 0; loop < 400; ++loop) {
          const uint32_t n = 2 + (loop * 37) % 60;
          crew.each(n, [&](size_t i) { ++seen[i]; });
          for (uint32_t i = 0; i < n; ++i) wrong += seen[i] != 1;
          for (uint32_t i = 0; i < n; ++i) seen[i] = 0;
        }
      });
      for (const uint32_t left : seen) wrong += left != 0;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("loops of any length, within loops, and without the threads gathered") {
  for (const int threads : {1, 2, 3}) {
    CAPTURE(threads);
    Crew crew(threads);
    const auto every_index_once = [&] {
      for (const size_t n : {size_t(0), size_t(1), size_t(511), size_t(513), size_t(20011)}) {
        std::vector<int> met(n, 0);
        crew.each(n, [&](size_t i) { ++met[i]; });
        CHECK(std::count(met.begin(), met.end(), 1) == std::ptrdiff_t(n));
      }
      std::vector<int> inner(40 * 30, 0);
      crew.each(40, [&](size_t i) { crew.each(30, [&](size_t k) { ++inner[30 * i + k]; }); });
      CHECK(std::count(inner.begin(), inner.end(), 1) == 40 * 30);
    };
    every_index_once();
    crew.gather(every_index_once);
    crew.gather([&] { crew.gather(every_index_once); });
    every_index_once();
  }
}

TEST_CASE("work that throws lets the threads go") {
  for (const int threads : {1, 2, 3}) {
    Crew crew(threads);
    const auto fails = [&] {
      crew.each(100, [](size_t) {});
      throw std::runtime_error("no");
    };
    CHECK_THROWS_AS(crew.gather(fails), std::runtime_error);
    std::vector<int> met(300, 0);
    crew.gather([&] { crew.each(met.size(), [&](size_t i) { ++met[i]; }); });
    CHECK(std::count(met.begin(), met.end(), 1) == 300);
  }
}
