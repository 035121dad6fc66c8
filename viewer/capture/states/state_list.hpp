#pragma once
#include "engine/core/result.hpp"
#include "viewer/capture/frame_clock.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// The entry of one saved state in states.json.
struct SavedState {
  uint64_t tick = 0;
  uint64_t state_hash = 0;
  uint64_t file_hash = 0;  ///< hash of the file's content
};

/// The content of states.json.
struct StateList {
  std::string version, scene;
  std::string start;                   ///< hash of the world at the start of the run
  std::string run;                     ///< key that is equal for runs that may continue each other
  std::string stepper;                 ///< replaces the scene's; empty: the scene's
  std::vector<std::string> overrides;  ///< "path=value"
  Fraction fps{30, 1};                 ///< of the frames that can be drawn
  TickRate rate;
  uint64_t frames_wanted = 0;
  bool every_tick = false;         ///< including ticks that no frame needs
  std::vector<SavedState> states;  ///< ascending

  /// The state of a tick, or null.
  const SavedState* find(uint64_t tick) const;
};

inline constexpr const char* state_list_name = "states.json";

/// "state_00000042.bin", of tick 42.
std::string state_file_name(uint64_t tick);
/// Whether a file name has this form.
bool is_state_file_name(const std::string& name);

/// Writes DIR/states.json, whole or not at all.
Status write_state_list(const std::filesystem::path& folder, const StateList& list);
Result<StateList> read_state_list(const std::filesystem::path& folder);

/// The content of a state's file; an error if its hash differs from the list's.
Result<std::string> read_state(const std::filesystem::path& folder, const SavedState& state);
/// The number of leading states whose files exist and match the list.
size_t whole_states(const std::filesystem::path& folder, const StateList& list);

}  // namespace tumble
