#include "viewer/render/mesh_cache.hpp"

#include "viewer/render/gpu_layout.hpp"

namespace tumble {

MeshCache::~MeshCache() {
  forget_before(~uint64_t(0));
}

const MeshCache::Entry& MeshCache::get(const MeshData& mesh, uint64_t frame) {
  const auto [it, fresh] = entries_.try_emplace(mesh.id);
  Entry& e = it->second;
  e.last_used = frame;
  if (!fresh) return e;
  std::vector<GpuVertex> vertices(mesh.positions.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vec3f &p = mesh.positions[i], &n = mesh.normals[i];
    vertices[i] = {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}};
  }
  const auto v = std::as_bytes(std::span(vertices));
  const auto t = std::as_bytes(std::span(mesh.indices));
  e.vertices = device_.create_buffer(BufferUse::vertex, v.size(), v);
  e.indices = device_.create_buffer(BufferUse::index, t.size(), t);
  e.index_count = uint32_t(mesh.indices.size());
  return e;
}

void MeshCache::forget_before(uint64_t frame) {
  for (auto it = entries_.begin(); it != entries_.end();) {
    if (it->second.last_used >= frame) {
      ++it;
      continue;
    }
    device_.destroy(it->second.vertices);
    device_.destroy(it->second.indices);
    it = entries_.erase(it);
  }
}

}  // namespace tumble
