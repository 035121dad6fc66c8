#pragma once
#include "engine/collision/shape.hpp"
#include "engine/core/bytes.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

namespace tumble {

/// Immutable geometry addressed by its content: equal meshes and equal shapes are stored once, so
/// that a thousand bodies of one mesh share one tree, and snapshots may name geometry instead of
/// holding it. May be shared between worlds; safe to use from several threads.
class ShapeStore {
 public:
  /// The shape of this definition, built on first use.
  Result<std::shared_ptr<const Shape>> shape(const ShapeDef& def);

  /// Content hash of a mesh, which the store keeps from now on; 0 for null.
  uint64_t add_mesh(const std::shared_ptr<const TriangleMesh>& mesh);
  /// Null when the store does not hold it.
  std::shared_ptr<const TriangleMesh> mesh(uint64_t key) const;

  /// A shape definition: kind, the numbers that it uses, its mesh as a content key.
  void write(ByteWriter& out, const ShapeDef& def);
  /// Fails the reader when a value is out of range or the mesh is not in the store.
  ShapeDef read(ByteReader& in) const;

 private:
  mutable std::mutex mutex_;
  std::map<uint64_t, std::shared_ptr<const TriangleMesh>> meshes_;
  std::map<const TriangleMesh*, std::pair<std::shared_ptr<const TriangleMesh>, uint64_t>> keys_;
  std::map<uint64_t, std::shared_ptr<const Shape>> shapes_;
};

/// A mesh as bytes, and back.
void write_mesh(ByteWriter& out, const TriangleMesh& mesh);
TriangleMesh read_mesh(ByteReader& in);

}  // namespace tumble
