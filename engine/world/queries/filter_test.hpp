#pragma once
#include "engine/world/queries/query.hpp"

#include <algorithm>

namespace tumble {

/// A QueryFilter prepared for many tests.
class FilterTest {
 public:
  explicit FilterTest(const QueryFilter& filter) : filter_(filter) {
    if (filter.leave_out.size() <= few) return;
    sorted_ = filter.leave_out;
    std::sort(sorted_.begin(), sorted_.end());
  }

  bool takes(const QueryTarget& target, BodyType type) const {
    if (type == BodyType::fixed       ? !filter_.fixed
        : type == BodyType::kinematic ? !filter_.kinematic
                                      : !filter_.dynamic)
      return false;
    return !leaves_out(target.body) && takes(target);
  }
  /// For particles, which are only asked about when the filter includes them.
  bool takes(const QueryTarget& target) const { return !filter_.accept || filter_.accept(target); }

 private:
  bool leaves_out(BodyId id) const {
    const std::vector<BodyId>& out = filter_.leave_out;
    if (sorted_.empty()) return std::find(out.begin(), out.end(), id) != out.end();
    return std::binary_search(sorted_.begin(), sorted_.end(), id);
  }

  static constexpr size_t few = 8;
  const QueryFilter& filter_;
  std::vector<BodyId> sorted_;
};

}  // namespace tumble
