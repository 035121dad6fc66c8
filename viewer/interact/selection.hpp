#pragma once
#include "engine/core/handle.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <algorithm>
#include <vector>

namespace tumble {

/// The bodies that a person has chosen. The one chosen last is the main one: panels show it.
class Selection {
 public:
  /// In the order in which they were chosen.
  const std::vector<BodyId>& all() const { return bodies_; }
  /// Null when nothing is selected.
  BodyId main() const { return bodies_.empty() ? BodyId{} : bodies_.back(); }
  bool empty() const { return bodies_.empty(); }
  size_t size() const { return bodies_.size(); }
  bool contains(BodyId id) const { return std::ranges::find(bodies_, id) != bodies_.end(); }

  void clear() { bodies_.clear(); }
  /// This body alone; null: nothing.
  void set(BodyId id) {
    bodies_.clear();
    if (!id.is_null()) bodies_.push_back(id);
  }
  /// Makes it the main one of those that are selected, and selects it before.
  void add(BodyId id) {
    std::erase(bodies_, id);
    bodies_.push_back(id);
  }
  /// Selected, or not any more.
  void toggle(BodyId id) {
    if (std::erase(bodies_, id) == 0) bodies_.push_back(id);
  }
  template <class Keep>
  void keep_if(const Keep& keep) {
    std::erase_if(bodies_, [&](BodyId id) { return !keep(id); });
  }

 private:
  std::vector<BodyId> bodies_;
};

}  // namespace tumble
