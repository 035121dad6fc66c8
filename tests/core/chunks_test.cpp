// Loops in chunks. References: every index is met once, and sums have the same bits for any number
// of threads.
#include "engine/core/chunks.hpp"

#include "engine/core/prefetch.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

double sum_of_roots(int threads, size_t n) {
  Crew crew(threads);
  std::array<double, chunk_count> sums{};
  for_chunks(&crew, n, [&](size_t chunk, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) sums[chunk] += std::sqrt(double(i));
  });
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum;
}

}  // namespace

TEST_CASE("chunks meet every index once, few or many") {
  Crew crew(2);
  for (const size_t n : {size_t(0), size_t(1), size_t(31), least_parallel, size_t(5001)}) {
    std::vector<int> met(n, 0);
    for_chunks(&crew, n, [&](size_t chunk, size_t first, size_t last) {
      CHECK(chunk < chunk_count);
      for (size_t i = first; i < last; ++i) {
        prefetch_ahead<128>(std::span(met), i);
        ++met[i];
      }
    });
    for (const int times : met) CHECK(times == 1);
  }
}

TEST_CASE("sums of chunks have the same bits with 1, 2 and 4 threads") {
  for (const size_t n : {size_t(100), size_t(14001)}) {
    const double sum = sum_of_roots(1, n);
    CHECK(sum_of_roots(2, n) == sum);
    CHECK(sum_of_roots(4, n) == sum);
  }
}
