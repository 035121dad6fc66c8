#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/mesh.hpp"

#include <map>

namespace tumble {

/// Vertex and index buffers on the device, by id (hash of the content) of the mesh.
class MeshCache {
 public:
  struct Entry {
    BufferId vertices, indices;
    uint32_t index_count = 0;
    uint64_t last_used = 0;  ///< frame
  };

  explicit MeshCache(Device& device) : device_(device) {}
  ~MeshCache();
  MeshCache(const MeshCache&) = delete;
  MeshCache& operator=(const MeshCache&) = delete;

  /// The mesh's buffers, uploaded on first use.
  const Entry& get(const MeshData& mesh, uint64_t frame);
  /// Frees what was last used before `frame`.
  void forget_before(uint64_t frame);

 private:
  Device& device_;
  std::map<uint64_t, Entry> entries_;
};

}  // namespace tumble
