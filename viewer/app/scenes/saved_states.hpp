#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/capture/states/state_list.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace tumble {

/// Key of the world that a run begins with, as in states.json: equal if scene, settings and version
/// of Tumble are.
std::string start_of_run(const World& world, const std::string& version);

/// A run saved by `tumble simulate --states`, to be drawn with the present looks of the scene.
class SavedStates {
 public:
  /// Reads the list of states in a folder.
  static Result<SavedStates> open(const std::filesystem::path& folder);
  /// Loads the scene as it was simulated, with overrides of its looks. Errors: `invalid_argument`
  /// for an override of anything else, or if the folder belongs to another scene.
  Result<LoadedScene> load_scene(SceneRequest request, const std::string& version);

  /// The number of frames at a rate up to the last state.
  uint64_t frames_at(Fraction fps) const;
  /// Error: one of these frames cannot be drawn; with `each`, because a tick before it was not
  /// saved.
  Status check_frames(uint64_t frames, Fraction fps, bool each) const;
  /// Advances the world towards `tick`: to the next saved state or, unless `each`, directly to that
  /// tick or the one before it.
  Result<std::shared_ptr<const Frame>> advance(World& world, uint64_t tick, bool each) const;
  /// Sets the world to the first state.
  Result<std::shared_ptr<const Frame>> begin(World& world) const;

  const StateList& list() const { return list_; }

 private:
  Result<std::shared_ptr<const Frame>> frame_at(World& world, const SavedState& state) const;
  void take_looks(const World& world, Frame& frame) const;
  void take_looks_of_copies(const World& world, std::vector<BodyInfo>& infos) const;

  std::filesystem::path folder_;
  StateList list_;
  std::shared_ptr<const Frame> looks_;  ///< the scene's first frame, if looks were overridden
  /// Its emitters of bodies, whose templates give the looks of the copies.
  std::vector<std::pair<EmitterId, std::shared_ptr<const EmitterDef>>> emitters_;
};

}  // namespace tumble
