#pragma once
#include "engine/core/crew.hpp"
#include "viewer/capture/folder_lock.hpp"
#include "viewer/capture/particles/export_list.hpp"
#include "viewer/capture/particles/particle_sample.hpp"

#include <chrono>
#include <memory>
#include <optional>

namespace tumble {

class World;

/// The formats of `--format`: "ply", "vtu".
const std::vector<std::string>& particle_formats();

struct ParticleExportOptions {
  std::filesystem::path folder;  ///< empty: nothing is exported
  std::string format = "ply";    ///< one of particle_formats()
  Fraction fps{30, 1};
  uint64_t frames = 0;
  /// If set, also writes SYSTEM-surface_000042.ply, the surface around all particles
  /// (geometry/isosurface), with cells of this edge [m]; 0: half the mean radius of the frame's
  /// particles.
  std::optional<double> surface;
  bool resume = false;  ///< continue where an earlier run of the same kind stopped
  bool force = false;   ///< overwrite files that exist
  int threads = 0;      ///< for computing surfaces; 0: one per core
  std::string version, scene;
  std::string run;  ///< key that is equal for runs that may continue each other
};

/// Writes the particles of a world while it runs. For frame k, the state at time k / fps, there is
/// a file for every system, SYSTEM_000042.ply or .vtu, and a mesh of the surface if requested.
/// particles.json lists them, and for .vtu SYSTEM.pvd gives their times. Every file appears whole
/// or not at all.
class ParticleExport {
 public:
  /// Exports nothing.
  ParticleExport() = default;
  /// Prepares the folder; the world must be at tick 0. Errors: `not_found` if the world has no
  /// particle systems, `io` if files exist that must not be overwritten, or if nothing can be
  /// written.
  static Result<ParticleExport> begin(const World& world, const ParticleExportOptions& options);

  /// To be called at tick 0 and after every tick. Writes the frames that are due. Error `internal`:
  /// after resuming, the simulation differs from the interrupted one.
  Status add(const World& world);
  /// Updates particles.json and the .pvd files.
  Status commit();
  Status status() const { return status_; }

  bool wanted() const { return !options_.folder.empty(); }
  uint64_t frames_kept() const { return kept_; }
  uint64_t frames() const { return list_.frames.size(); }
  uint64_t frames_wanted() const { return list_.frames_wanted; }

 private:
  Status make_room();
  Status write_frame(const World& world, uint64_t k);
  Status write_system(size_t i, const ParticleSample& sample, double time, ExportRecord& record);
  Status write_surface(size_t i, const ParticleSample& sample, double time, ExportRecord& record);
  Status write(const std::string& name, const Result<std::string>& content, ExportRecord& record);
  Status check_kept(const World& world, uint64_t k) const;
  Status save_list();

  ParticleExportOptions options_;
  std::unique_ptr<Crew> crew_;  ///< for computing surfaces
  std::optional<FolderLock> lock_;
  std::vector<ParticleSystemId> systems_;
  ExportList list_;
  uint64_t kept_ = 0;  ///< frames kept from the run that is continued
  uint64_t next_ = 0;  ///< next frame to be written
  /// The systems at the tick before, if a frame lies between it and the next tick.
  std::vector<ParticleSystem> before_;
  Status status_;
  std::chrono::steady_clock::time_point list_saved_;
};

}  // namespace tumble
