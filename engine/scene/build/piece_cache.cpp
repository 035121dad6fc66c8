#include "engine/scene/build/piece_cache.hpp"

#include "engine/core/bytes.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"

namespace tumble {
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
  add_to_key(out, mesh);
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
  return out.take();
}

std::optional<MeshPieces> pieces_of(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
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

}  // namespace

Result<MeshPieces> PieceCache::pieces(const std::shared_ptr<const TriangleMesh>& mesh,
                                      const ApproximateDecompositionOptions& options) const {
  const Bytes key = key_of(*mesh, options);
  if (const auto kept = cache_.read(key))
    if (auto known = pieces_of(*kept)) return *std::move(known);
  const AabbTree surface(mesh);
  auto made = decompose_approximately(surface, options);
  if (!made) return made.error();
  MeshPieces out;
  out.added = made->added;
  out.concavity = made->concavity;
  out.bound_met = made->bound_met;
  for (ConvexPiece& piece : made->pieces)
    out.pieces.push_back({std::move(piece.hull.vertices), piece.volume, piece.solid});
  cache_.write(key, bytes_of(out));
  return out;
}

}  // namespace tumble
