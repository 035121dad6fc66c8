#include "engine/scene/build/piece_cache.hpp"

#include "engine/core/bytes.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include <algorithm>
#include <optional>

namespace tumble {
namespace {

constexpr uint32_t format_version = 2;  ///< version of the file format, not of the method
constexpr std::string_view section = "convex pieces";

/// Everything that determines the pieces.
Bytes key_of(const TriangleMesh& mesh, const ApproximateDecompositionOptions& options) {
  ByteWriter out;
  out.value(format_version);
  out.value(decomposition_version);
  out.value(options.concavity);
  out.value(uint64_t{options.max_pieces});
  add_to_key(out, mesh);
  return out.take();
}

Bytes key_of(const TriangleMesh& mesh, const ExactDecompositionOptions& options) {
  ByteWriter out;
  out.value(format_version);
  out.value(decomposition_version);
  out.text("exact");
  out.value(options.tolerance);
  out.value(uint64_t{options.max_pieces});
  add_to_key(out, mesh);
  return out.take();
}

/// Numbers of a decomposition and of a piece, in the order of the file.
template <class Decomposition, class Visit>
void visit_numbers(Decomposition& d, const Visit& visit) {
  for (auto* x : {&d.mesh_volume, &d.solid_volume, &d.hull_volume, &d.left_out_volume, &d.added,
                  &d.missing, &d.concavity})
    visit(*x);
}
template <class Piece, class Visit>
void visit_piece(Piece& p, const Visit& visit) {
  for (auto* x : {&p.volume, &p.solid, &p.added}) visit(*x);
}

Bytes bytes_of(const ConvexDecomposition& d) {
  ByteWriter out;
  out.begin_section(section, format_version);
  visit_numbers(d, [&](double x) { out.value(x); });
  for (const bool flag : {d.exact, d.bound_met}) out.value(uint8_t{flag});
  for (const size_t n : {d.left_out, d.cuts, d.pieces.size()}) out.value(uint64_t{n});
  for (const ConvexPiece& p : d.pieces) {
    visit_piece(p, [&](double x) { out.value(x); });
    out.value(uint64_t{p.hull.vertices.size()});
    for (const Vec3& v : p.hull.vertices) out.value(v);
    out.vector(p.hull.face_first);
    out.vector(p.hull.face_vertices);
    for (const Plane& plane : p.hull.planes) {
      out.value(plane.normal);
      out.value(plane.offset);
    }
  }
  out.end_section();
  return out.take();
}

/// Whether the loops of faces are consecutive and refer to existing vertices.
bool loops_fit(const std::vector<uint32_t>& first, const std::vector<uint32_t>& vertices,
               size_t vertex_count) {
  if (first.size() < 2 || first.front() != 0 || first.back() != vertices.size()) return false;
  for (size_t f = 1; f < first.size(); ++f)
    if (first[f] < first[f - 1] + 3) return false;
  return std::ranges::all_of(vertices, [&](uint32_t v) { return v < vertex_count; });
}

bool read_hull(ByteReader& in, ConvexPolyhedron& out) {
  const auto count = in.get<uint64_t>();
  if (count > in.remaining() / sizeof(Vec3)) return false;
  std::vector<Vec3> vertices(size_t(count), Vec3::Zero());
  for (Vec3& v : vertices) in.value(v);
  std::vector<uint32_t> first, loops;
  in.vector(first);
  in.vector(loops);
  if (!in.ok() || !loops_fit(first, loops, vertices.size())) return false;
  std::vector<Plane> planes(first.size() - 1);
  for (Plane& plane : planes) {
    in.value(plane.normal);
    in.value(plane.offset);
  }
  if (!in.ok()) return false;
  auto hull =
      make_polyhedron(std::move(vertices), std::move(first), std::move(loops), std::move(planes));
  if (hull) out = *std::move(hull);
  return hull.ok();
}

std::optional<ConvexDecomposition> decomposition_of(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.begin_section(section) != format_version) return std::nullopt;
  ConvexDecomposition out;
  visit_numbers(out, [&](double& x) { in.value(x); });
  for (bool* flag : {&out.exact, &out.bound_met}) *flag = in.get<uint8_t>() != 0;
  for (size_t* n : {&out.left_out, &out.cuts}) *n = size_t(in.get<uint64_t>());
  const auto count = in.get<uint64_t>();
  for (uint64_t n = 0; n < count && in.ok(); ++n) {
    ConvexPiece& p = out.pieces.emplace_back();
    visit_piece(p, [&](double& x) { in.value(x); });
    if (!read_hull(in, p.hull)) return std::nullopt;
  }
  if (!in.ok() || out.pieces.empty()) return std::nullopt;
  return out;
}

/// Reads from the cache, or computes and stores.
template <class Make>
Result<ConvexDecomposition> kept_or_made(const ContentCache& cache, const Bytes& key,
                                         const Make& make) {
  if (const auto kept = cache.read(key))
    if (auto known = decomposition_of(*kept)) return *std::move(known);
  auto made = make();
  if (made) cache.write(key, bytes_of(*made));
  return made;
}

}  // namespace

Result<ConvexDecomposition> PieceCache::decomposition(
    const std::shared_ptr<const TriangleMesh>& mesh,
    const ApproximateDecompositionOptions& options) const {
  return kept_or_made(cache_, key_of(*mesh, options),
                      [&] { return decompose_approximately(AabbTree(mesh), options); });
}

Result<ConvexDecomposition> PieceCache::exact_decomposition(
    const TriangleMesh& mesh, const ExactDecompositionOptions& options) const {
  return kept_or_made(cache_, key_of(mesh, options),
                      [&] { return decompose_exactly(mesh, options); });
}

Result<MeshPieces> PieceCache::pieces(const std::shared_ptr<const TriangleMesh>& mesh,
                                      const ApproximateDecompositionOptions& options) const {
  auto made = decomposition(mesh, options);
  if (!made) return made.error();
  MeshPieces out;
  out.added = made->added;
  out.missing = made->missing;
  out.concavity = made->concavity;
  out.bound_met = made->bound_met;
  for (ConvexPiece& piece : made->pieces)
    out.pieces.push_back({std::move(piece.hull.vertices), piece.volume, piece.solid});
  return out;
}

}  // namespace tumble
