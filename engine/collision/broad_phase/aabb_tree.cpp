#include "engine/collision/broad_phase/aabb_tree.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

/// The still tree is rebuilt when the waiting proxies are at least this many and a sixteenth of it.
constexpr size_t least_waiting = 64;

bool same(const Aabb& a, const Aabb& b) {
  return a.min == b.min && a.max == b.max;
}

/// Id of a member that was taken out.
constexpr uint32_t gone = UINT32_MAX;

}  // namespace

void AabbTreeBroadPhase::take_out(uint32_t id) {
  if (place_[id] == Place::still) {
    still_.remove(position_[id]);
    still_.rename(position_[id], gone);
    --still_count_;
  }
  waiting_changed_ |= place_[id] == Place::waiting;
  place_[id] = Place::none;
}

/// Adds a resting proxy that is in no tree yet.
void AabbTreeBroadPhase::let_wait(std::span<const BroadPhaseProxy> proxies, uint32_t id) {
  const bool placed = can_be_placed(proxies[id].bounds);
  place_[id] = placed ? Place::waiting : Place::large;
  waiting_changed_ |= placed;
  (placed ? waiting_ids_ : large_ids_).push_back(id);
}

/// Finds the members of the still tree among the proxies: at their old index, or shifted by the
/// change in the number of proxies (if some were created or removed before them).
void AabbTreeBroadPhase::follow_still(std::span<const BroadPhaseProxy> proxies) {
  const auto shift = int64_t(proxies.size()) - int64_t(place_.size());
  place_.assign(proxies.size(), Place::none);
  position_.resize(proxies.size());
  for (size_t k = 0; k < still_bounds_.size(); ++k) {
    const uint32_t id = still_.members().ids[k];
    if (id == gone) continue;
    const auto rests_at = [&](int64_t i) {
      return i >= 0 && i < int64_t(proxies.size()) && place_[size_t(i)] == Place::none &&
             !proxies[size_t(i)].moving && same(proxies[size_t(i)].bounds, still_bounds_[k]);
    };
    const int64_t index = rests_at(id) ? int64_t(id) : int64_t(id) + shift;
    if (rests_at(index)) {
      still_.rename(k, uint32_t(index));
      place_[size_t(index)] = Place::still;
      position_[size_t(index)] = uint32_t(k);
    } else {
      still_.remove(k);
      still_.rename(k, gone);
      --still_count_;
    }
  }
}

void AabbTreeBroadPhase::follow_all(std::span<const BroadPhaseProxy> proxies) {
  follow_still(proxies);
  if (still_count_ == 0) origin_ = packing_origin(proxies);
  moving_ids_.clear();
  waiting_ids_.clear();
  large_ids_.clear();
  large_.clear();
  for (uint32_t i = 0; i < proxies.size(); ++i) {
    if (place_[i] == Place::still || proxies[i].bounds.empty()) continue;
    if (!proxies[i].moving)
      let_wait(proxies, i);
    else if (can_be_placed(proxies[i].bounds))
      moving_ids_.push_back(i);
    else
      large_.add(proxies[i], i, origin_);
  }
  waiting_changed_ = true;
}

void AabbTreeBroadPhase::follow_news(std::span<const BroadPhaseProxy> proxies,
                                     const ProxyNews& news) {
  for (const uint32_t id : news.moving) take_out(id);
  for (const uint32_t id : news.settled) take_out(id);
  std::erase_if(waiting_ids_, [this](uint32_t id) { return place_[id] != Place::waiting; });
  std::erase_if(large_ids_, [this](uint32_t id) { return place_[id] != Place::large; });
  for (const uint32_t id : news.settled)
    if (!proxies[id].bounds.empty()) let_wait(proxies, id);
  moving_ids_.clear();
  large_.clear();
  for (const uint32_t id : news.moving) {
    if (can_be_placed(proxies[id].bounds))
      moving_ids_.push_back(id);
    else if (!proxies[id].bounds.empty())
      large_.add(proxies[id], id, origin_);
  }
}

void AabbTreeBroadPhase::rebuild_still(std::span<const BroadPhaseProxy> proxies) {
  for (const uint32_t id : still_.members().ids)
    if (id != gone) waiting_ids_.push_back(id);
  std::sort(waiting_ids_.begin(), waiting_ids_.end());
  still_.build(proxies, waiting_ids_, origin_, crew_);
  still_count_ = waiting_ids_.size();
  waiting_ids_.clear();
  waiting_changed_ = true;
  still_bounds_.resize(still_count_);
  for (size_t k = 0; k < still_count_; ++k) {
    const uint32_t id = still_.members().ids[k];
    still_bounds_[k] = proxies[id].bounds;
    place_[id] = Place::still;
    position_[id] = uint32_t(k);
  }
}

void AabbTreeBroadPhase::compare(std::span<const BroadPhaseProxy> proxies,
                                 std::vector<ProxyPair>& pairs) {
  collector_.start(proxies, owners_);
  const bool many_wait = waiting_ids_.size() > least_waiting + still_count_ / 16;
  const bool many_gone = still_bounds_.size() > least_waiting + 2 * still_count_;
  if (many_wait || many_gone) rebuild_still(proxies);
  if (std::exchange(waiting_changed_, false)) waiting_.build(proxies, waiting_ids_, origin_, crew_);
  moving_.build(proxies, moving_ids_, origin_, crew_);
  moving_.pairs_within(collector_, crew_);
  for (const uint32_t id : large_ids_) large_.add(proxies[id], id, origin_);
  for (const PackedTree* rests : {&still_, &waiting_})
    moving_.pairs_with(*rests, collector_, crew_);
  for (size_t i = 0; i < large_.set().size(); ++i)
    for (const PackedTree* tree : {&moving_, &waiting_, &still_})
      tree->pairs_with(large_.set().bounds[i], large_.set().ids[i], collector_);
  large_.pairs_within(collector_);
  stats_ = collector_.finish(pairs, crew_);
}

void AabbTreeBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies,
                                    std::vector<ProxyPair>& pairs) {
  last_news_ = 0;
  follow_all(proxies);
  compare(proxies, pairs);
}

void AabbTreeBroadPhase::find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                                    std::vector<ProxyPair>& pairs) {
  const bool follows = !news.all && last_news_ != 0 && news.number == last_news_ + 1 &&
                       proxies.size() == place_.size();
  last_news_ = news.number;
  if (follows)
    follow_news(proxies, news);
  else
    follow_all(proxies);
  compare(proxies, pairs);
}

void AabbTreeBroadPhase::draw(std::span<const BroadPhaseProxy>, DebugDraw& out) const {
  still_.draw(origin_, out);
  waiting_.draw(origin_, out);
  moving_.draw(origin_, out);
}

}  // namespace tumble
