#pragma once
#include "engine/math/types.hpp"
#include "viewer/app/scene_saver.hpp"
#include "viewer/app/session.hpp"

#include <future>
#include <optional>

namespace tumble {

/// Makes copies of bodies. The first copy stands beside its original. Who then moves that copy and
/// asks for another gets it moved in the same way once more, so that rows, stairs and rings come
/// out of a few copies.
class Duplicator {
 public:
  /// A copy of `body`, by `aside` [m] where nothing is to be repeated. `repeat` false: what lies
  /// between original and copy is the work of physics, and nobody's wish. What it changes about the
  /// scene's file is noted in `edits`.
  void copy(Session& session, BodyId body, const Vec3& aside, bool repeat, DeedEdits edits);
  /// The copy that was asked for last, once, as soon as the frame has it.
  std::optional<BodyId> take(const Frame& shown);
  /// Another world is shown.
  void forget() { *this = Duplicator{}; }

 private:
  BodyId original_, copy_;  ///< of the last time
  std::future<BodyId> made_;
  bool awaited_ = false;  ///< the copy is made and was not taken
};

}  // namespace tumble
