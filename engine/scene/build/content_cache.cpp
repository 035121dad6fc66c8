#include "engine/scene/build/content_cache.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/resources.hpp"

#include <fstream>
#include <vector>

#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;

fs::path ContentCache::usual_folder(std::string_view name) {
  fs::path folder = user_folder("XDG_CACHE_HOME", ".cache");
  if (!folder.empty()) folder = folder / "tumble" / name;
  return folder;
}

fs::path ContentCache::file_of(std::span<const std::byte> key) const {
  return folder_ / (hash_text(hash_bytes(key)) + hash_text(hash_bytes(key, 1)) + extension_);
}

std::optional<Bytes> ContentCache::read(std::span<const std::byte> key) const {
  if (folder_.empty()) return std::nullopt;
  const fs::path file = file_of(key);
  // A folder or pipe of that name is not an entry: reading it would fail or block.
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  const auto size = fs::file_size(file, error);
  if (error || size < sizeof(uint64_t)) return std::nullopt;
  std::vector<char> text(size);
  if (!in.read(text.data(), std::streamsize(text.size()))) return std::nullopt;
  const auto bytes = std::as_bytes(std::span(text));
  const auto content = bytes.subspan(sizeof(uint64_t));
  if (ByteReader(bytes).get<uint64_t>() != hash_bytes(content)) return std::nullopt;
  return Bytes(content.begin(), content.end());
}

/// Written under a name unique to this process, then renamed: readers see the whole file or none.
void ContentCache::write(std::span<const std::byte> key, std::span<const std::byte> content) const {
  if (folder_.empty()) return;
  ByteWriter whole;
  whole.value(hash_bytes(content));
  whole.raw(content.data(), content.size());
  const fs::path file = file_of(key);
  std::error_code error;
  fs::create_directories(folder_, error);
  fs::path part = file;
  part += "." + std::to_string(::getpid()) + ".part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    const Bytes& bytes = whole.bytes();
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    out.close();
    if (!out) {
      fs::remove(part, error);
      return;
    }
  }
  fs::rename(part, file, error);
  if (error) fs::remove(part, error);
}

void add_to_key(ByteWriter& key, const TriangleMesh& mesh) {
  key.value(uint64_t{mesh.vertices.size()});
  for (const Vec3& v : mesh.vertices) key.value(v);
  key.vector(mesh.triangles);
}

}  // namespace tumble
