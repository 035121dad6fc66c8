#include "engine/dynamics/bodies/roster.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"

#include <algorithm>

namespace tumble {

void Roster::refresh(std::span<const RigidBody> bodies, Crew* crew) {
  whole_ = !known_ || bodies.size() != size_;
  known_ = true;
  size_ = bodies.size();
  settled_.clear();
  if (!touched_.empty()) {
    active_.insert(active_.end(), touched_.begin(), touched_.end());
    std::ranges::sort(active_);
    active_.erase(std::unique(active_.begin(), active_.end()), active_.end());
    touched_.clear();
  }
  const size_t count = whole_ ? bodies.size() : active_.size();
  const auto slot = [this](size_t k) { return whole_ ? uint32_t(k) : active_[k]; };
  seeks_.resize(count);
  for_chunks(crew, count, [&](size_t, size_t first, size_t last) {
    constexpr size_t ahead = tolerances::bodies_ahead;
    for (size_t k = first; k < last; ++k) {
      prefetch<128>(&bodies[slot(std::min(k + ahead, last - 1))]);
      seeks_[k] = is_active(bodies[slot(k)]);
    }
  });
  size_t active = 0;
  if (whole_) active_.resize(count);
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t i = slot(k);
    if (seeks_[k])
      active_[active++] = i;
    else if (!whole_)
      settled_.push_back(i);
  }
  active_.resize(active);
}

void Roster::add(std::span<const uint32_t> woken) {
  const auto middle = std::ptrdiff_t(active_.size());
  active_.insert(active_.end(), woken.begin(), woken.end());
  std::inplace_merge(active_.begin(), active_.begin() + middle, active_.end());
  std::erase_if(settled_,
                [woken](uint32_t slot) { return std::ranges::binary_search(woken, slot); });
}

void Roster::add_memory(MemoryUse& use) const {
  use.bodies += heap_bytes(active_, settled_, touched_, seeks_);
}

}  // namespace tumble
