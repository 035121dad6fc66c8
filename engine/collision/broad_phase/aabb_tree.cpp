#include "engine/collision/broad_phase/aabb_tree.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Newly resting proxies wait until they are this many and a sixteenth of the still tree.
constexpr size_t least_waiting = 64;

bool same(const Aabb& a, const Aabb& b) {
  return a.min == b.min && a.max == b.max;
}

/// Id of a member that was taken out.
constexpr uint32_t gone = UINT32_MAX;

}  // namespace

/// Finds the members of the still tree among the proxies: at their old index, or moved along by as
/// many as there are more proxies now (something was made or removed before them).
void AabbTreeBroadPhase::follow_still(std::span<const BroadPhaseProxy> proxies) {
  is_still_.assign(proxies.size(), 0);
  const auto shift = int64_t(proxies.size()) - int64_t(last_count_);
  for (size_t k = 0; k < still_bounds_.size(); ++k) {
    const uint32_t id = still_.members().ids[k];
    if (id == gone) continue;
    const auto rests_at = [&](int64_t i) {
      return i >= 0 && i < int64_t(proxies.size()) && !is_still_[size_t(i)] &&
             !proxies[size_t(i)].moving && same(proxies[size_t(i)].bounds, still_bounds_[k]);
    };
    const int64_t index = rests_at(id) ? int64_t(id) : int64_t(id) + shift;
    if (rests_at(index)) {
      still_.rename(k, uint32_t(index));
      is_still_[size_t(index)] = 1;
    } else {
      still_.remove(k);
      still_.rename(k, gone);
      --still_count_;
    }
  }
}

void AabbTreeBroadPhase::sort_out(std::span<const BroadPhaseProxy> proxies) {
  large_.clear();
  moving_ids_.clear();
  resting_ids_.clear();
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    const Aabb& b = proxies[i].bounds;
    if (is_still_[i] || b.empty()) continue;
    if (!can_be_placed(b))
      large_.add(proxies[i], i, origin_);
    else if (proxies[i].moving)
      moving_ids_.push_back(i);
    else
      resting_ids_.push_back(i);
  }
}

void AabbTreeBroadPhase::rebuild_still(std::span<const BroadPhaseProxy> proxies) {
  for (uint32_t i = 0; i < proxies.size(); ++i)
    if (is_still_[i]) resting_ids_.push_back(i);
  std::sort(resting_ids_.begin(), resting_ids_.end());
  still_.build(proxies, resting_ids_, origin_, crew_);
  still_count_ = resting_ids_.size();
  resting_ids_.clear();
  still_bounds_.resize(still_count_);
  for (size_t k = 0; k < still_count_; ++k)
    still_bounds_[k] = proxies[still_.members().ids[k]].bounds;
}

void AabbTreeBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                    std::vector<ProxyPair>& pairs) {
  collector_.start(proxies);
  follow_still(proxies);
  last_count_ = proxies.size();
  if (still_count_ == 0) origin_ = packing_origin(proxies);
  sort_out(proxies);
  const bool many_wait = resting_ids_.size() > least_waiting + still_count_ / 16;
  const bool many_gone = still_bounds_.size() > least_waiting + 2 * still_count_;
  if (many_wait || many_gone) rebuild_still(proxies);
  moving_ids_.insert(moving_ids_.end(), resting_ids_.begin(), resting_ids_.end());
  moving_.build(proxies, moving_ids_, origin_, crew_);
  moving_.pairs_within(collector_, crew_);
  moving_.pairs_with(still_, collector_, crew_);
  for (size_t i = 0; i < large_.set().size(); ++i) {
    moving_.pairs_with(large_.set().bounds[i], large_.set().ids[i], collector_);
    still_.pairs_with(large_.set().bounds[i], large_.set().ids[i], collector_);
  }
  large_.pairs_within(collector_);
  stats_ = collector_.finish(pairs, crew_);
}

void AabbTreeBroadPhase::draw(std::span<const BroadPhaseProxy>, DebugDraw& out) const {
  still_.draw(origin_, out);
  moving_.draw(origin_, out);
}

}  // namespace tumble
