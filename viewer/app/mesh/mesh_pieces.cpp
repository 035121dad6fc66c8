#include "viewer/app/mesh/mesh_pieces.hpp"

#include "engine/core/crew.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

namespace tumble {
namespace {

/// How far a decomposition has got, on stderr: at most ten times a second on a terminal, else a
/// line every five seconds. How much is left nobody knows before the last piece.
class PiecesProgress {
 public:
  void operator()(size_t done, size_t waiting) {
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - last_).count() < (terminal_ ? 0.1 : 5.0)) return;
    last_ = now;
    const std::string line =
        fmt::format("{} pieces done, {} parts to look at, {:.0f} s", done, waiting,
                    std::chrono::duration<double>(now - start_).count());
    fmt::print(stderr, "{}{:<60}{}", terminal_ ? "\r" : "", line, terminal_ ? "" : "\n");
    std::fflush(stderr);
    open_ = terminal_;
  }
  void finish() {
    if (open_) fmt::print(stderr, "\n");
    open_ = false;
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0, open_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
};

}  // namespace

Result<PiecesFacts> decompose_mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                   const PiecesRequest& request, const StopSignal& stop) {
  const Stoppable scope(&stop.flag());
  PiecesProgress progress;
  const DecompositionProgress show = [&](size_t done, size_t waiting) { progress(done, waiting); };
  const auto start = std::chrono::steady_clock::now();
  Crew crew(int(std::clamp(std::thread::hardware_concurrency(), 1u, 64u)));
  auto made = [&] {
    if (request.exact) {
      ExactDecompositionOptions options;
      options.tolerance = request.tolerance;
      options.max_pieces = request.most.value_or(options.max_pieces);
      options.progress = show;
      return decompose_exactly(*mesh, options);
    }
    ApproximateDecompositionOptions options;
    options.concavity = request.concavity;
    options.max_pieces = request.most.value_or(options.max_pieces);
    options.crew = &crew;
    options.progress = show;
    return decompose_approximately(AabbTree(mesh), options);
  }();
  progress.finish();
  if (!made) return made.error();
  PiecesFacts out;
  out.decomposition = *std::move(made);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

Status write_pieces(const std::filesystem::path& file, const ConvexDecomposition& pieces) {
  FileWriter out(file);
  std::string text = fmt::format("# {} convex pieces by Tumble, metres\n", pieces.pieces.size());
  size_t first = 1;
  for (size_t n = 0; n < pieces.pieces.size(); ++n) {
    const ConvexPolyhedron& p = pieces.pieces[n].hull;
    text += fmt::format("o piece_{:03}\n", n);
    for (const Vec3& v : p.vertices) text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
    for (size_t f = 0; f < p.face_count(); ++f) {
      text += "f";
      for (const uint32_t v : p.face(f)) text += fmt::format(" {}", first + v);
      text += "\n";
    }
    first += p.vertices.size();
    out.append(text);
    text.clear();
  }
  out.append(text);
  return out.commit();
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
