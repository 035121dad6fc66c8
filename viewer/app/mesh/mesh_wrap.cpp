#include "viewer/app/mesh/mesh_wrap.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/scene/build/wrap_cache.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>

namespace tumble {

Result<WrapFacts> wrap_in_place(TriangleMesh& mesh, const WrapRequest& request,
                                const StopSignal& stop) {
  const Stoppable scope(&stop.flag());
  WorkProgress progress("wrap");
  const ProgressSink show = [&](double share) { progress.show(share); };
  const Watched watched(&show);
  Crew crew(int(std::clamp(std::thread::hardware_concurrency(), 1u, 64u)));
  WrapOptions options;
  options.gap = request.gap;
  options.offset = request.offset;
  options.cell = request.cell;
  options.crew = &crew;
  WrapFacts out;
  out.triangles = mesh.triangles.size();
  const auto start = std::chrono::steady_clock::now();
  auto made = WrapCache().wrap(std::make_shared<const TriangleMesh>(mesh), options);
  progress.finish();
  if (!made) return made.error();
  if (stop.requested()) return stopped_error();
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.report = made->report;
  mesh = std::move(made->mesh);
  return out;
}

std::string wrap_text(const WrapFacts& f) {
  const WrapReport& r = f.report;
  std::string out = fmt::format(
      "  {:<16}around the {} triangles of the file in {:.3g} s: all that follows is of the wrap\n",
      "wrap", f.triangles, f.seconds);
  out += fmt::format(
      "  {:<16}offset {:.4g} m, cells of {:.4g} m; what a ball of {:.4g} m does not "
      "pass is closed\n",
      "", r.offset, r.cell, r.gap);
  out += fmt::format(
      "  {:<16}reaches {:.3g} m outside the mesh, as found ({:.3g} m at most), and "
      "leaves {:.3g} m of it out\n",
      "", r.added, r.bound, r.missing);
  out += fmt::format(
      "  {:<16}of the mesh nothing is more than {:.3g} m beneath it, and nothing nearer to it than "
      "{:.3g} m\n",
      "", r.buried, r.nearest);
  if (!f.file.empty()) out += fmt::format("  {:<16}{}\n", "", f.file.string());
  return out;
}

}  // namespace tumble
