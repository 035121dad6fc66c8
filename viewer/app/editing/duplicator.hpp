#pragma once
#include "engine/math/types.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/selection.hpp"

#include <future>
#include <optional>
#include <vector>

namespace tumble {

/// Copies bodies together with their joints. The first copies are placed beside their originals. If
/// the user then moves the copies and copies again, the displacement is repeated, so that rows,
/// stairs and rings can be made.
class Duplicator {
 public:
  /// Copies `bodies`, shifted by `aside` [m] if there is no displacement to repeat. With `repeat`
  /// false, the present displacement between originals and copies is due to the simulation and is
  /// ignored. Changes to the scene's file are recorded in `edits`.
  void copy(Session& session, const Selection& bodies, const Vec3& aside, bool repeat,
            UndoStepEdits edits);
  /// Bodies created elsewhere: selected as soon as they exist, but not repeated.
  void await(std::future<std::vector<BodyId>> copies);
  /// The copies requested last, once, as soon as the frame contains them.
  std::vector<BodyId> take(const Frame& shown);
  /// To be called when another world is shown.
  void forget() { *this = Duplicator{}; }

 private:
  BodyId original_;             ///< the primary original of the last time
  std::vector<BodyId> copies_;  ///< the primary copy last
  std::future<std::vector<BodyId>> made_;
  bool awaited_ = false;  ///< the copies were requested but not taken yet
};

}  // namespace tumble
