// Reference: lanes sorted by whether the mask keeps them, then by their number, for every mask.
#include "engine/math/compress_table.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("the lanes that a mask keeps come first, in their order") {
  for (size_t mask = 0; mask < compress_table.size(); ++mask) {
    CAPTURE(mask);
    std::array<uint8_t, compress_lanes> lanes{};
    std::iota(lanes.begin(), lanes.end(), uint8_t{0});
    std::ranges::sort(lanes, {},
                      [&](uint8_t lane) { return std::pair((mask >> lane & 1) == 0, lane); });
    CHECK(compress_table[mask] == lanes);
  }
}
