#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>

namespace tumble {

/// Asks the world for what a microscope shows, where a frame is not enough: once for each picture
/// that stands still, on the simulation thread, since it may take as long as a tick. Nothing is
/// asked while the world runs.
class MicroscopeProbe {
 public:
  void clear() { *this = MicroscopeProbe{}; }
  /// Takes the answer that has come, and asks if there is a new question.
  void update(Session& session, const std::shared_ptr<const Frame>& frame,
              const std::optional<MicroscopeSetup>& setup);
  /// The last answer, or null.
  const std::shared_ptr<const MicroscopeAnswer>& said() const { return said_; }
  /// Whether the algorithm waits for the world to stand still.
  bool waits() const { return waits_; }

 private:
  struct Answer;

  std::shared_ptr<const Frame> asked_for_;
  std::string asked_algorithm_;
  BodyId asked_a_;
  std::shared_ptr<Answer> pending_;
  std::shared_ptr<const MicroscopeAnswer> said_;
  bool waits_ = false;
};

}  // namespace tumble
