#pragma once
#include "engine/world/microscope/microscope.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>

namespace tumble {

/// Queries the world for microscope algorithms to which a frame is not enough. There is one query
/// per shown moment, and only while the world is paused; it runs on the simulation thread, since it
/// may take as long as a tick.
class MicroscopeProbe {
 public:
  void clear() { *this = MicroscopeProbe{}; }
  /// Takes an answer that has arrived, and sends a new query if needed.
  void update(Session& session, const std::shared_ptr<const Frame>& frame,
              const std::optional<MicroscopeSetup>& setup);
  /// The last answer, or null.
  const std::shared_ptr<const MicroscopeAnswer>& said() const { return said_; }
  /// Whether the algorithm cannot be shown until the world is paused.
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
