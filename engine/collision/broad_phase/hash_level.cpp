#include "engine/collision/broad_phase/hash_level.hpp"

#include "engine/core/stop.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace tumble {
namespace {

/// floor() of a value that fits into int64_t, without a library call.
int64_t floor_of(double x) {
  const auto t = int64_t(x);
  return t - int64_t(x < double(t));
}

}  // namespace

double grid_size(const Aabb& b) {
  // Four roundings, each of at most an epsilon of the coordinate, affect the difference between the
  // cell numbers of two corners.
  const double far = b.min.cwiseAbs().cwiseMax(b.max.cwiseAbs()).maxCoeff();
  return b.extent().maxCoeff() + 16 * std::numeric_limits<double>::epsilon() * far;
}

HashLevel::Cell HashLevel::cell_of(const Vec3& x) const {
  constexpr double end = double(int64_t(1) << 60);
  Cell c;
  for (int k = 0; k < 3; ++k) {
    const double at = x[k] * inverse_edge_;
    c[size_t(k)] = floor_of(at > -end ? std::min(at, end) : -end);  // NaN is the lowest cell
  }
  return c;
}

bool HashLevel::near_slots_differ() const {
  for (int64_t z = -2; z <= 2; ++z)
    for (int64_t y = -2; y <= 2; ++y)
      for (int64_t x = -2; x <= 2; ++x)
        if ((x || y || z) && ((x + y * stride_y_ + z * stride_z_) & mask_) == 0) return false;
  return true;
}

void HashLevel::choose_slots(size_t count) {
  std::array<double, 3> size;
  for (size_t k = 0; k < 3; ++k) size[k] = std::max(double(high_[k] - low_[k] + 1), 5.0);
  const double all = size[0] * size[1] * size[2];
  unique_ = all <= std::max(4.0 * double(count), 128.0);
  if (unique_) {
    stride_y_ = int64_t(size[0]);
    stride_z_ = stride_y_ * int64_t(size[1]);
    mask_ = int64_t(std::bit_ceil(uint64_t(all))) - 1;
    return;
  }
  mask_ = int64_t(std::bit_ceil(std::max<uint64_t>(2 * count, 128))) - 1;
  // Odd numbers far from simple fractions of any table size; in the rare case that nearby slots
  // collide, the next ones, and finally 5 and 25, which never fail.
  uint32_t y = 0x9e3779b1u, z = 0x85ebca77u;
  for (int attempt = 0; attempt < 8; ++attempt, y += 0x632be5aau, z += 0x27d4eb2eu) {
    stride_y_ = int64_t(y) & mask_;
    stride_z_ = int64_t(z) & mask_;
    if (near_slots_differ()) return;
  }
  stride_y_ = 5;
  stride_z_ = 25;
}

void HashLevel::build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> members,
                      double edge, const Vec3& origin, Crew* crew) {
  edge_ = std::max(edge, 1e-200);
  inverse_edge_ = 1 / edge_;
  Aabb corners;
  for (const uint32_t m : members) corners.include(proxies[m].bounds.min);
  low_ = cell_of(corners.min);
  high_ = cell_of(corners.max);
  choose_slots(members.size());
  starts_.assign(size_t(mask_) + 2, 0);
  slots_.resize(members.size());
  for_chunks(crew, members.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i)
      slots_[i] = uint32_t(slot_of(cell_of(proxies[members[i]].bounds.min)));
  });
  for (const uint32_t slot : slots_) ++starts_[slot];
  // Ends of the slots; the insertion below decrements them to the starts.
  for (size_t s = 1; s < starts_.size(); ++s) starts_[s] += starts_[s - 1];
  set_.resize(members.size());
  for (size_t i = members.size(); i-- > 0;) slots_[i] = --starts_[slots_[i]];
  for_chunks(crew, members.size(), [&](size_t, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      set_.bounds[slots_[i]] = pack(proxies[members[i]], origin);
      set_.ids[slots_[i]] = members[i];
    }
  });
}

template <class F>
void HashLevel::for_slots(int64_t slot, int64_t count, F&& f) const {
  const int64_t first = slot & mask_, last = first + count;
  if (last <= mask_ + 1) {
    f(starts_[size_t(first)], starts_[size_t(last)]);
  } else {
    f(starts_[size_t(first)], starts_[size_t(mask_) + 1]);
    f(0u, starts_[size_t(last - mask_ - 1)]);
  }
}

void HashLevel::pairs_within(PairCollector& out, Crew* crew) const {
  out.in_chunks(crew, size_t(mask_) + 1, [this](size_t first, size_t last, PairCollector& part) {
    pairs_of_slots(first, last, part);
  });
}

void HashLevel::pairs_of_slots(size_t first_slot, size_t last_slot, PairCollector& out) const {
  // Half of the 26 neighbours: x + 1, and the rows of (y + 1, z), (y - 1, z + 1), (y, z + 1), (y +
  // 1, z + 1). The other half is tested from those cells.
  const std::array<int64_t, 4> rows{stride_y_, stride_z_ - stride_y_, stride_z_,
                                    stride_z_ + stride_y_};
  for (auto slot = int64_t(first_slot); slot < int64_t(last_slot); ++slot) {
    const uint32_t first = starts_[size_t(slot)], last = starts_[size_t(slot) + 1];
    if (first == last) continue;
    std::array<Run, 10> runs;
    size_t count = 0;
    const auto keep = [&](uint32_t a, uint32_t b) {
      if (a < b) runs[count++] = {a, b};
    };
    for_slots(slot + 1, 1, keep);
    for (const int64_t row : rows) for_slots(slot + row - 1, 3, keep);
    for (uint32_t i = first; i < last; ++i) {
      if (stop_requested()) return;
      const PackedBounds a = set_.bounds[i];
      const uint32_t id = set_.ids[i];
      out.test(a, id, set_, i + 1, last);
      for (size_t r = 0; r < count; ++r) out.test(a, id, set_, runs[r].first, runs[r].last);
    }
  }
}

void HashLevel::pairs_with(const Aabb& bounds, const PackedBounds& packed, uint32_t id,
                           PairCollector& out) const {
  Cell from = cell_of(bounds.min.array() - edge_), to = cell_of(bounds.max);
  bool small = true;
  double cells = 1;
  for (size_t k = 0; k < 3; ++k) {
    from[k] = std::max(from[k], low_[k]);
    to[k] = std::min(to[k], high_[k]);
    if (from[k] > to[k]) return;
    small = small && to[k] - from[k] <= 2;
    cells *= double(to[k] - from[k] + 1);
  }
  const auto test = [&](uint32_t a, uint32_t b) { out.test(packed, id, set_, a, b); };
  if (!small && (!unique_ || cells > double(set_.size()))) return test(0, uint32_t(set_.size()));
  for (int64_t z = from[2]; z <= to[2]; ++z)
    for (int64_t y = from[1]; y <= to[1]; ++y)
      for_slots(slot_of({from[0], y, z}), to[0] - from[0] + 1, test);
}

}  // namespace tumble
