#include "viewer/app/mesh/mesh_fit.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/watched.hpp"
#include "engine/scene/build/fit_cache.hpp"
#include "viewer/capture/progress.hpp"
#include "viewer/capture/stop_signal.hpp"

#include <chrono>

#include <fmt/format.h>

namespace tumble {

Result<FitFacts> fit_mesh(const std::shared_ptr<const TriangleMesh>& mesh, const StopSignal& stop) {
  const Stoppable scope(&stop.flag());
  const auto start = std::chrono::steady_clock::now();
  WorkProgress progress("primitives");
  const ProgressSink show = [&](double share) { progress.show(share); };
  const Watched watched(&show);
  auto fits = FitCache().fits(mesh);
  progress.finish();
  if (!fits) return fits.error();
  FitFacts out;
  out.fits = *std::move(fits);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

std::string fit_text(const FitFacts& facts) {
  std::string out;
  const auto volume = [](const FittedPrimitive& fit) {
    return fit.mesh_volume > 0 ? fmt::format("{:.4g}", fit.volume / fit.mesh_volume)
                               : std::string("-");
  };
  for (size_t k = 0; k < facts.fits.size(); ++k) {
    const FittedPrimitive& fit = facts.fits[k];
    const auto shape = make_shape(fit.shape);
    if (!shape) continue;
    out += fmt::format("  {:<16}{}: added {:.3g} m, missing {:.3g} m, volume {} of the mesh's\n",
                       k == 0 ? "fitted" : "", (*shape)->words(), fit.error.added,
                       fit.error.missing, volume(fit));
    if (k > 0) continue;
    const Vec3& x = fit.pose.x;
    const Vec3 axis = fit.pose.direction(Vec3::UnitY());
    out += fmt::format(
        "  {:<16}at [{:.6g}, {:.6g}, {:.6g}] m, its y along [{:.4f}, {:.4f}, "
        "{:.4f}]; {:.3g} s; others:\n",
        "", x.x(), x.y(), x.z(), axis.x(), axis.y(), axis.z(), facts.seconds);
  }
  return out;
}

}  // namespace tumble
