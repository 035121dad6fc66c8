#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Largest number of lanes for which the table is used.
constexpr size_t compress_lanes = 8;

/// By mask: the lanes that it keeps, in their order, then the others in theirs. Of a mask of fewer
/// lanes, the first entries are these lanes.
inline constexpr std::array<std::array<uint8_t, compress_lanes>, 1 << compress_lanes>
    compress_table = [] {
      std::array<std::array<uint8_t, compress_lanes>, 1 << compress_lanes> table{};
      for (size_t mask = 0; mask < table.size(); ++mask) {
        size_t n = 0;
        for (const size_t kept : {size_t{1}, size_t{0}})
          for (size_t lane = 0; lane < compress_lanes; ++lane)
            if ((mask >> lane & 1) == kept) table[mask][n++] = uint8_t(lane);
      }
      return table;
    }();

}  // namespace tumble
