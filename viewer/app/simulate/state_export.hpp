#pragma once
#include "viewer/capture/folder_lock.hpp"
#include "viewer/capture/states/state_list.hpp"

#include <chrono>
#include <optional>

namespace tumble {

class World;

struct StateExportOptions {
  std::filesystem::path folder;  ///< empty: nothing is saved
  StateList list;  ///< the list without its states; its `run` is completed by the world's state
  uint64_t last_tick = 0;  ///< last tick of the run
  bool geometry = false;   ///< the run may create shapes that the scene does not have
  bool resume = false;     ///< continue where an earlier run of the same kind stopped
  bool force = false;      ///< overwrite states that exist
};

/// Saves the states of a world while it runs, at every tick that the frames of the list's rate
/// need. Every file appears whole or not at all.
class StateExport {
 public:
  /// Saves nothing.
  StateExport() = default;
  /// Prepares the folder. Error `io`: files exist that must not be overwritten, or nothing can be
  /// written.
  static Result<StateExport> begin(const StateExportOptions& options);

  /// For a resumed run whose other outputs need no earlier ticks: loads the last saved state into
  /// the world, but at most the last one before the end of the run, so that at least one tick is
  /// simulated (a world that was only loaded has no statistics of a tick).
  Status skip(World& world);
  /// To be called at tick 0 and after every tick. Error `internal`: after resuming, the simulation
  /// differs from the interrupted one.
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
  size_t kept_ = 0;     ///< states kept from the run that is continued
  uint64_t frame_ = 0;  ///< the first frame that is not before the present tick
  Status status_;
  std::chrono::steady_clock::time_point list_saved_;
};

}  // namespace tumble
