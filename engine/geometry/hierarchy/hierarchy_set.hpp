#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <array>
#include <mutex>

namespace tumble {

/// The hierarchies of one mesh, one per kind, each built on first use. Thread-safe.
class HierarchySet {
 public:
  explicit HierarchySet(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {}

  /// `kind` is an entry of all_hierarchies().
  const Hierarchy& get(const HierarchyKind& kind) const;

 private:
  struct Slot {
    std::once_flag once;
    std::unique_ptr<Hierarchy> hierarchy;
  };
  std::shared_ptr<const TriangleMesh> mesh_;
  mutable std::array<Slot, 8> slots_;
};

}  // namespace tumble
