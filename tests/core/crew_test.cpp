// Threads that share many short loops. Reference: every chunk of every loop counted once, and seen
// by the loop after it.
#include "engine/core/crew.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("every chunk of many short loops is done once, before the next loop begins") {
  const char* text = std::getenv("TUMBLE_TEST_SCALE");
  const int rounds = text && std::atof(text) < 1 ? 20 : 200;
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
