#include "viewer/app/mesh/mesh_pieces.hpp"

#include "engine/core/crew.hpp"
#include "engine/scene/build/piece_cache.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>

namespace tumble {
Result<PiecesFacts> decompose_mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                   const PiecesRequest& request, const StopSignal& stop) {
  const Stoppable scope(&stop.flag());
  WorkProgress progress("convex pieces");
  // Each part still waiting becomes at least one piece.
  const DecompositionProgress show = [&](size_t done, size_t waiting) {
    progress.show(double(done) / double(std::max<size_t>(1, done + waiting)),
                  fmt::format("{} done, {} parts to look at", done, waiting));
  };
  const auto start = std::chrono::steady_clock::now();
  Crew crew(int(std::clamp(std::thread::hardware_concurrency(), 1u, 64u)));
  auto made = [&] {
    if (request.exact) {
      ExactDecompositionOptions options;
      options.tolerance = request.tolerance;
      options.max_pieces = request.most.value_or(options.max_pieces);
      options.progress = show;
      return PieceCache().exact_decomposition(*mesh, options);
    }
    ApproximateDecompositionOptions options;
    options.concavity = request.concavity;
    options.max_pieces = request.most.value_or(options.max_pieces);
    options.crew = &crew;
    options.progress = show;
    return PieceCache().decomposition(mesh, options);
  }();
  progress.finish();
  if (!made) return made.error();
  PiecesFacts out;
  out.decomposition = *std::move(made);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

std::string pieces_text(const PiecesFacts& facts) {
  const ConvexDecomposition& d = facts.decomposition;
  size_t vertices = 0, faces = 0;
  for (const ConvexPiece& p : d.pieces) {
    vertices += p.hull.vertices.size();
    faces += p.hull.face_count();
  }
  std::string out = fmt::format("  {:<16}{} {} by {} cuts in {:.3g} s, {} vertices, {} faces\n",
                                "pieces", d.pieces.size(), d.exact ? "exact" : "approximate",
                                d.cuts, facts.seconds, vertices, faces);
  out += fmt::format("  {:<16}{:.9g} m3 of hulls, {:.6g} of the mesh's\n", "", d.hull_volume,
                     d.hull_volume / d.mesh_volume);
  if (d.left_out > 0)
    out += fmt::format(
        "  {:<16}{} parts as thin as rounding are left out: {:.2g} m3, {:.2g} of the mesh's\n", "",
        d.left_out, d.left_out_volume, d.left_out_volume / d.mesh_volume);
  if (!d.exact) {
    out += fmt::format("  {:<16}{:.3g} m outside the mesh, {:.3g} m of it missing, as sampled\n",
                       "", d.added, d.missing);
    out += d.bound_met ? fmt::format("  {:<16}concavity {:.3g} m is kept\n", "", d.concavity)
                       : fmt::format("  {:<16}concavity {:.3g} m is NOT kept with so few pieces\n",
                                     "", d.concavity);
  }
  if (!facts.file.empty()) out += fmt::format("  {:<16}{}\n", "", facts.file.string());
  return out;
}

}  // namespace tumble
