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

/// The names that `--format` knows: "ply", "vtu".
const std::vector<std::string>& particle_formats();

struct ParticleExportOptions {
  std::filesystem::path folder;  ///< empty: nothing is exported
  std::string format = "ply";    ///< one of particle_formats()
  Fraction fps{30, 1};
  uint64_t frames = 0;
  /// Also SYSTEM-surface_000042.ply, one skin about all particles (geometry/isosurface), of cells
  /// of this edge [m]; 0: half the mean radius of the frame's particles.
  std::optional<double> surface;
  bool resume = false;  ///< go on where an earlier run of the same kind stopped
  bool force = false;   ///< overwrite files that exist
  int threads = 0;      ///< of what surfaces are made by; 0: one per core
  std::string version, scene;
  std::string run;  ///< equal for runs that may continue each other
};

/// Writes the particles of a world while it runs: for frame k, the state at k / fps, a file for
/// every system, SYSTEM_000042.ply or .vtu; particles.json tells of all, and for .vtu SYSTEM.pvd
/// says which is when; where surfaces are wanted, a mesh of each. Every file appears whole or not
/// at all.
class ParticleExport {
 public:
  /// Nothing is exported.
  ParticleExport() = default;
  /// Prepares the folder; the world is at tick 0. Errors: `not_found` when it has no particle
  /// systems, `io` when files exist that may not be touched, or when nothing can be written.
  static Result<ParticleExport> begin(const World& world, const ParticleExportOptions& options);

  /// To be called at tick 0 and after every tick. Writes the frames that became due. Error
  /// `internal`: resumed, but the simulation is not the one that was interrupted.
  Status add(const World& world);
  /// Brings particles.json and the collections up to date.
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
  std::unique_ptr<Crew> crew_;  ///< for surfaces
  std::optional<FolderLock> lock_;
  std::vector<ParticleSystemId> systems_;
  ExportList list_;
  uint64_t kept_ = 0;  ///< frames of the run that is continued
  uint64_t next_ = 0;  ///< frame
  /// The systems at the tick before, when a frame lies between it and the next.
  std::vector<ParticleSystem> before_;
  Status status_;
  std::chrono::steady_clock::time_point list_saved_;
};

}  // namespace tumble
