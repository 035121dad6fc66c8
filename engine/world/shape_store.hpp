#pragma once
#include "engine/collision/shape.hpp"
#include "engine/core/bytes.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

namespace tumble {

/// Immutable geometry addressed by content: equal meshes and equal shapes are stored once, so that
/// a thousand bodies of one mesh share one tree, and snapshots can refer to geometry by its key.
/// May be shared between worlds, and used from several threads.
class ShapeStore {
 public:
  /// The shape of this definition, built on first use.
  Result<std::shared_ptr<const Shape>> shape(const ShapeDef& def);

  /// Content hash of a mesh, which is added to the store; 0 for null.
  uint64_t add_mesh(const std::shared_ptr<const TriangleMesh>& mesh);
  /// Null if the store does not have it.
  std::shared_ptr<const TriangleMesh> mesh(uint64_t key) const;

  /// Writes a shape definition: kind, the parameters that this kind uses, and the content key of
  /// its mesh.
  void write(ByteWriter& out, const ShapeDef& def);
  /// Fails the reader if a value is out of range or the mesh is not in the store.
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
