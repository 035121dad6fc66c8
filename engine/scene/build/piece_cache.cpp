#include "engine/scene/build/piece_cache.hpp"

#include "engine/core/bytes.hpp"
#include "engine/core/hash.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/scene/resources.hpp"

#include <fstream>
#include <iterator>

#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

constexpr uint32_t format_version = 1;  ///< of the files, not of the method
constexpr std::string_view section = "convex pieces";

/// Everything that decides what the pieces are.
Bytes key_of(const TriangleMesh& mesh, const ApproximateDecompositionOptions& options) {
  ByteWriter out;
  out.value(format_version);
  out.value(decomposition_version);
  out.value(options.concavity);
  out.value(uint64_t{options.max_pieces});
  out.value(uint64_t{mesh.vertices.size()});
  for (const Vec3& v : mesh.vertices) out.value(v);
  out.vector(mesh.triangles);
  return out.take();
}

Bytes bytes_of(const MeshPieces& pieces) {
  ByteWriter out;
  out.begin_section(section, format_version);
  out.value(pieces.added);
  out.value(pieces.concavity);
  out.value(uint8_t{pieces.bound_met});
  out.value(uint64_t{pieces.pieces.size()});
  for (const MeshPieces::Piece& p : pieces.pieces) {
    out.value(p.volume);
    out.value(p.solid);
    out.value(uint64_t{p.vertices.size()});
    for (const Vec3& v : p.vertices) out.value(v);
  }
  out.end_section();
  ByteWriter whole;
  whole.value(hash_bytes(out.bytes()));
  whole.raw(out.bytes().data(), out.bytes().size());
  return whole.take();
}

std::optional<MeshPieces> pieces_of(std::span<const std::byte> bytes) {
  ByteReader hash(bytes);
  if (bytes.size() < sizeof(uint64_t) ||
      hash.get<uint64_t>() != hash_bytes(bytes.subspan(sizeof(uint64_t))))
    return std::nullopt;
  ByteReader in(bytes.subspan(sizeof(uint64_t)));
  if (in.begin_section(section) != format_version) return std::nullopt;
  MeshPieces out;
  in.value(out.added);
  in.value(out.concavity);
  out.bound_met = in.get<uint8_t>() != 0;
  const auto count = in.get<uint64_t>();
  for (uint64_t n = 0; n < count && in.ok(); ++n) {
    MeshPieces::Piece& p = out.pieces.emplace_back();
    in.value(p.volume);
    in.value(p.solid);
    const auto vertices = in.get<uint64_t>();
    if (vertices > in.remaining() / sizeof(Vec3)) return std::nullopt;
    p.vertices.resize(size_t(vertices));
    for (Vec3& v : p.vertices) in.value(v);
  }
  if (!in.ok() || out.pieces.empty()) return std::nullopt;
  return out;
}

std::optional<MeshPieces> read_pieces(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  return pieces_of(std::as_bytes(std::span(text)));
}

/// To a name of this process's own, then renamed: whoever reads sees all of it or nothing.
void write_pieces(const fs::path& file, const MeshPieces& pieces) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  fs::path part = file;
  part += "." + std::to_string(::getpid()) + ".part";
  const Bytes bytes = bytes_of(pieces);
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
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

}  // namespace

PieceCache::PieceCache() {
  folder_ = user_folder("XDG_CACHE_HOME", ".cache");
  if (!folder_.empty()) folder_ /= "tumble/decompositions";
}

Result<MeshPieces> PieceCache::pieces(const std::shared_ptr<const TriangleMesh>& mesh,
                                      const ApproximateDecompositionOptions& options) const {
  fs::path file;
  if (!folder_.empty()) {
    const Bytes key = key_of(*mesh, options);
    file = folder_ / (hash_text(hash_bytes(key)) + hash_text(hash_bytes(key, 1)) + ".pieces");
    if (auto known = read_pieces(file)) return *std::move(known);
  }
  const AabbTree surface(mesh);
  auto made = decompose_approximately(surface, options);
  if (!made) return made.error();
  MeshPieces out;
  out.added = made->added;
  out.concavity = made->concavity;
  out.bound_met = made->bound_met;
  for (ConvexPiece& piece : made->pieces)
    out.pieces.push_back({std::move(piece.hull.vertices), piece.volume, piece.solid});
  if (!file.empty()) write_pieces(file, out);
  return out;
}

}  // namespace tumble
