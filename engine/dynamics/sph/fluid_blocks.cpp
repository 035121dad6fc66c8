#include "engine/dynamics/sph/fluid_blocks.hpp"

#include "engine/dynamics/sph/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Numbers places in the order in which they are asked for.
class RowNumbers {
 public:
  /// Forgets all; places are below `places`.
  void restart(size_t places) {
    begin_ += count_;
    count_ = 0;
    if (number_.size() >= places && begin_ < UINT32_MAX / 2) return;
    number_.assign(std::max(places, number_.size()), 0);
    begin_ = 0;
  }
  /// The number of a place; `rows` gets it where it is new.
  uint32_t of(uint32_t place, std::vector<uint32_t>& rows) {
    uint32_t& number = number_[place];
    if (number <= begin_) {
      number = begin_ + ++count_;
      rows.push_back(place);
    }
    return number - begin_ - 1;
  }

 private:
  uint32_t begin_ = 0, count_ = 0;
  std::vector<uint32_t> number_;  ///< above `begin_`: by one more than the number
};

}  // namespace

bool FluidBlocks::make(const FluidPairStore& store, size_t first,
                       std::span<const FluidPairStore::Range> ranges, size_t places) {
  thread_local RowNumbers numbers;
  const auto filling = uint32_t(places - 1);
  const size_t last = first + ranges.size();
  first_ = first;
  parts_.clear(), rows_.clear();
  ends_.resize(ranges.size());
  others_.resize(store.used());
  slopes_ = store.list({0, 0}).slopes;
  for (size_t begin = first; begin < last;) {
    const size_t end = std::min(last, begin + tolerances::block_particles);
    Part part{begin, end, rows_.size(), 0, ranges[begin - first].first};
    numbers.restart(places);
    for (size_t p = begin; p < part.end; ++p) {
      const FluidPairStore::Range range = ranges[p - first];
      const FluidList list = store.list(range);
      if (p > begin && rows_.size() - part.first_row + list.padded > most_rows) {
        part.end = p;
        break;
      }
      for (size_t k = 0; k < list.padded; ++k) {
        // What fills lists up has no slope: any row will do.
        const uint32_t other = list.others[k];
        others_[range.first + k] = other == filling ? 0 : uint16_t(numbers.of(other, rows_));
      }
      ends_[p - first] = uint32_t(range.first + range.padded - part.first_pair);
    }
    part.end_row = rows_.size();
    if (part.end_row - part.first_row > most_rows) return false;
    parts_.push_back(part);
    begin = part.end;
  }
  return true;
}

FluidBlock FluidBlocks::operator[](size_t k) const {
  const Part& p = parts_[k];
  return {p.first,
          {rows_.data() + p.first_row, p.end_row - p.first_row},
          {ends_.data() + (p.first - first_), p.end - p.first},
          others_.data() + p.first_pair,
          slopes_ + p.first_pair,
          p.first_row,
          p.first_pair};
}

}  // namespace tumble
