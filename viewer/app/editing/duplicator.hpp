#pragma once
#include "engine/math/types.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/selection.hpp"

#include <future>
#include <optional>
#include <vector>

namespace tumble {

/// Makes copies of bodies, with what joins them. The first copies stand beside their originals. Who
/// then moves the copies and asks for others gets them moved in the same way once more, so that
/// rows, stairs and rings come out of a few copies.
class Duplicator {
 public:
  /// Copies of `bodies`, by `aside` [m] where nothing is to be repeated. `repeat` false: what lies
  /// between originals and copies is the work of physics, and nobody's wish. What it changes about
  /// the scene's file is noted in `edits`.
  void copy(Session& session, const Selection& bodies, const Vec3& aside, bool repeat,
            DeedEdits edits);
  /// Bodies that somebody else makes: selected as soon as they are there, but not repeated.
  void await(std::future<std::vector<BodyId>> copies);
  /// The copies that were asked for last, once, as soon as the frame has them.
  std::vector<BodyId> take(const Frame& shown);
  /// Another world is shown.
  void forget() { *this = Duplicator{}; }

 private:
  BodyId original_;             ///< of the last time, the main one
  std::vector<BodyId> copies_;  ///< the main one last
  std::future<std::vector<BodyId>> made_;
  bool awaited_ = false;  ///< the copies are made and were not taken
};

}  // namespace tumble
