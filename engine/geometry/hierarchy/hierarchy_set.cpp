#include "engine/geometry/hierarchy/hierarchy_set.hpp"

namespace tumble {

const Hierarchy& HierarchySet::get(const HierarchyKind& kind) const {
  Slot& slot = slots_.at(size_t(&kind - all_hierarchies().data()));
  std::call_once(slot.once, [&] { slot.hierarchy = kind.build(mesh_); });
  return *slot.hierarchy;
}

}  // namespace tumble
