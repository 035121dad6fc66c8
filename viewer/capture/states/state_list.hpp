#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// A moment of a run that was saved to be drawn later, as states.json tells of it.
struct SavedState {
  uint64_t tick = 0;
  uint64_t state_hash = 0;
  uint64_t file_hash = 0;  ///< of the bytes of its file
};

/// Everything that states.json says.
struct StateList {
  std::string version, scene;
  std::string start;                   ///< hash of the world that the run began with
  std::string run;                     ///< equal for runs that may continue each other
  std::string stepper;                 ///< instead of the scene's; empty: the scene's
  std::vector<std::string> overrides;  ///< "path=value"
  Fraction fps{30, 1};                 ///< of the frames that can be drawn
  TickRate rate;
  uint64_t frames_wanted = 0;
  bool every_tick = false;         ///< also those that no frame needs
  std::vector<SavedState> states;  ///< ascending

  /// The one of a tick, or null.
  const SavedState* find(uint64_t tick) const;
};

inline constexpr const char* state_list_name = "states.json";

/// "state_00000042.bin", of tick 42.
std::string state_file_name(uint64_t tick);
/// Whether a file has such a name.
bool is_state_file_name(const std::string& name);

/// Writes DIR/states.json, whole or not at all.
Status write_state_list(const std::filesystem::path& folder, const StateList& list);
Result<StateList> read_state_list(const std::filesystem::path& folder);

/// The bytes of a state; an error where they are not those that the list tells of.
Result<std::string> read_state(const std::filesystem::path& folder, const SavedState& state);
/// How many of the first states are on disk as the list tells.
size_t whole_states(const std::filesystem::path& folder, const StateList& list);

}  // namespace tumble
