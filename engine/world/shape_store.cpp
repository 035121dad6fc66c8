#include "engine/world/shape_store.hpp"

#include "engine/core/hash.hpp"

namespace tumble {

void write_mesh(ByteWriter& out, const TriangleMesh& mesh) {
  out.value(uint64_t(mesh.vertices.size()));
  out.raw(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  out.value(uint64_t(mesh.triangles.size()));
  out.raw(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
}

TriangleMesh read_mesh(ByteReader& in) {
  TriangleMesh mesh;
  const auto read_array = [&in](auto& array) {
    const auto n = in.get<uint64_t>();
    if (n > in.remaining() / sizeof(array[0])) {
      in.fail();
      return;
    }
    array.resize(size_t(n));
    in.raw(array.data(), array.size() * sizeof(array[0]));
  };
  read_array(mesh.vertices);
  read_array(mesh.triangles);
  return mesh;
}

uint64_t ShapeStore::add_mesh(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (!mesh) return 0;
  const std::scoped_lock lock(mutex_);
  if (const auto it = keys_.find(mesh.get()); it != keys_.end()) return it->second.second;
  ByteWriter bytes;
  write_mesh(bytes, *mesh);
  const uint64_t key = hash_bytes(bytes.bytes());
  keys_[mesh.get()] = {mesh, key};
  meshes_.try_emplace(key, mesh);
  return key;
}

std::shared_ptr<const TriangleMesh> ShapeStore::mesh(uint64_t key) const {
  const std::scoped_lock lock(mutex_);
  const auto it = meshes_.find(key);
  return it == meshes_.end() ? nullptr : it->second;
}

void ShapeStore::write(ByteWriter& out, const ShapeDef& def) {
  out.value(def.type);
  for (const ShapeParameter& p : shape_entry(def.type).parameters) {
    if (p.number) out.value(def.*p.number);
    if (p.vector) out.value(def.*p.vector);
  }
  if (made_of_mesh(def.type)) out.value(add_mesh(def.mesh));
}

ShapeDef ShapeStore::read(ByteReader& in) const {
  ShapeDef def;
  in.value(def.type);
  if (size_t(def.type) >= shape_type_count) {
    in.fail();
    return def;
  }
  for (const ShapeParameter& p : shape_entry(def.type).parameters) {
    if (p.number) in.value(def.*p.number);
    if (p.vector) in.value(def.*p.vector);
  }
  if (!made_of_mesh(def.type)) return def;
  const auto key = in.get<uint64_t>();
  if (key != 0 && !(def.mesh = mesh(key))) in.fail();
  return def;
}

Result<std::shared_ptr<const Shape>> ShapeStore::shape(const ShapeDef& def) {
  ByteWriter bytes;
  write(bytes, def);
  const uint64_t key = hash_bytes(bytes.bytes());
  {
    const std::scoped_lock lock(mutex_);
    if (const auto it = shapes_.find(key); it != shapes_.end()) return it->second;
  }
  auto made = make_shape(def);
  if (!made) return made.error();
  const std::scoped_lock lock(mutex_);
  return shapes_.try_emplace(key, *made).first->second;
}

}  // namespace tumble
