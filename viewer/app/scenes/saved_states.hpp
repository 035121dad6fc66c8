#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/capture/states/state_list.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace tumble {

/// What states.json says of the world that a run begins with: equal where scene, settings and
/// version of Tumble are.
std::string start_of_run(const World& world, const std::string& version);

/// A run that `tumble simulate --states` saved, to be drawn with the looks that the scene has now.
class SavedStates {
 public:
  /// Reads the list of a folder.
  static Result<SavedStates> open(const std::filesystem::path& folder);
  /// The scene as it was simulated, with changes to how it looks. Errors: `invalid_argument` for a
  /// change to something else, and for another scene than that of the folder.
  Result<LoadedScene> load_scene(SceneRequest request, const std::string& version);

  /// How many frames of a rate there are up to the last state.
  uint64_t frames_at(Fraction fps) const;
  /// Error: one of so many frames cannot be drawn; `each`: not without every tick before it.
  Status check_frames(uint64_t frames, Fraction fps, bool each) const;
  /// Brings the world of the scene nearer to `tick`: to the next saved one, or, unless `each` is
  /// wanted, to that tick or the one before it.
  Result<std::shared_ptr<const Frame>> advance(World& world, uint64_t tick, bool each) const;
  /// Brings it to the first.
  Result<std::shared_ptr<const Frame>> begin(World& world) const;

  const StateList& list() const { return list_; }

 private:
  Result<std::shared_ptr<const Frame>> frame_at(World& world, const SavedState& state) const;
  void take_looks(const World& world, Frame& frame) const;
  void take_looks_of_copies(const World& world, std::vector<BodyInfo>& infos) const;

  std::filesystem::path folder_;
  StateList list_;
  std::shared_ptr<const Frame> looks_;  ///< the scene at its start, where looks were changed
  /// Its emitters of bodies then, whose templates say how the copies look.
  std::vector<std::pair<EmitterId, std::shared_ptr<const EmitterDef>>> emitters_;
};

}  // namespace tumble
