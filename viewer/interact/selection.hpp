#pragma once
#include "engine/core/handle.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <algorithm>
#include <vector>

namespace tumble {

/// The selected bodies. The one selected last is the primary one, which panels show.
class Selection {
 public:
  /// In the order in which they were selected.
  const std::vector<BodyId>& all() const { return bodies_; }
  /// The primary body; null if nothing is selected.
  BodyId main() const { return bodies_.empty() ? BodyId{} : bodies_.back(); }
  bool empty() const { return bodies_.empty(); }
  size_t size() const { return bodies_.size(); }
  bool contains(BodyId id) const { return std::ranges::find(bodies_, id) != bodies_.end(); }

  void clear() { bodies_.clear(); }
  /// Selects this body only; null: nothing.
  void set(BodyId id) {
    bodies_.clear();
    if (!id.is_null()) bodies_.push_back(id);
  }
  /// Adds a body to the selection and makes it the primary one.
  void add(BodyId id) {
    std::erase(bodies_, id);
    bodies_.push_back(id);
  }
  /// Adds a body to the selection, or removes it.
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
