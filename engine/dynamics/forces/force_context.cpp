#include "engine/dynamics/forces/force_context.hpp"

#include <algorithm>

namespace tumble {

bool ForceContext::may_pull(uint32_t slot) const {
  return !only_some() || std::binary_search(only.begin(), only.end(), slot);
}

std::span<const uint32_t> ForceContext::asked_blocks(uint32_t system) const {
  if (system >= particle_slots.size() || particle_slots[system] == ~uint32_t{0}) return {};
  const uint32_t first = particle_slots[system];
  const auto begin = std::lower_bound(only.begin(), only.end(), first);
  return {begin, std::lower_bound(begin, only.end(), first + particles[system].size())};
}

}  // namespace tumble
