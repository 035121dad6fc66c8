#pragma once
#include "viewer/capture/folder_lock.hpp"
#include "viewer/capture/states/state_list.hpp"

#include <chrono>
#include <optional>

namespace tumble {

class World;

struct StateExportOptions {
  std::filesystem::path folder;  ///< empty: nothing is saved
  StateList list;                ///< all but the states; `run` without what the world adds
  uint64_t last_tick = 0;        ///< of the run
  bool geometry = false;         ///< the run may make shapes that the scene has not
  bool resume = false;           ///< go on where an earlier run of the same kind stopped
  bool force = false;            ///< overwrite states that exist
};

/// Saves a world while it runs, at every tick that frames at the list's rate need. Every file
/// appears whole or not at all.
class StateExport {
 public:
  /// Nothing is saved.
  StateExport() = default;
  /// Prepares the folder. Error `io`: files exist that may not be touched, or nothing can be
  /// written.
  static Result<StateExport> begin(const StateExportOptions& options);

  /// The last state that is there brings the world on to its tick, for a resumed run from whose
  /// beginning nothing else is wanted; the last before the run's end, so that a tick is left to
  /// simulate: a world that was only loaded has no statistics of a tick.
  Status skip(World& world);
  /// To be called at tick 0 and after every tick. Error `internal`: resumed, but the simulation is
  /// not the one that was interrupted.
  Status add(const World& world);
  Status commit();
  Status status() const { return status_; }

  bool wanted() const { return !options_.folder.empty(); }
  size_t states() const { return list_.states.size(); }
  size_t states_kept() const { return kept_; }

 private:
  Status make_room();
  bool is_due(uint64_t tick);
  Status check_kept(const World& world) const;
  Status write(const World& world);
  Status save_list();

  StateExportOptions options_;
  std::optional<FolderLock> lock_;
  StateList list_;
  size_t kept_ = 0;     ///< of the run that is continued
  uint64_t frame_ = 0;  ///< the first that does not lie before the present tick
  Status status_;
  std::chrono::steady_clock::time_point list_saved_;
};

}  // namespace tumble
