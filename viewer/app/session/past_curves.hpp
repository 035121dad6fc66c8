#pragma once
#include "engine/core/stop.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/ui/measures.hpp"

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// Computes the past of curves that were added late: recomputes the run up to the present, from
/// kept moments, in a world of its own beside the running one. At most as many ticks as a curve
/// holds. A computation is cancelled when time jumps, and restarted for the new present.
class PastCurves {
 public:
  PastCurves() = default;
  ~PastCurves() { forget(); }
  PastCurves(const PastCurves&) = delete;
  PastCurves& operator=(const PastCurves&) = delete;

  /// To be called once per picture. `beside`: compute on another thread, otherwise at once.
  void update(Session& session, Measures& measures, bool beside);
  /// To be called when the world has jumped to another moment: the computation under way may lead
  /// to a moment that is not part of its past.
  void note_jump();
  /// Cancels everything.
  void forget();
  /// Progress of the computation under way, 0..1; empty if there is none.
  std::optional<double> share() const;

 private:
  struct Job {
    std::shared_ptr<const Session::Way> way;
    std::vector<Quantity> quantities;
    std::vector<std::vector<double>> at;  ///< of each [s]
    std::vector<std::vector<float>> values;
    uint64_t from = 0, to = 0;  ///< ticks
    std::atomic<uint64_t> reached = 0;
    StopFlag stop;
    std::future<Status> outcome;  ///< not valid until the way (see Session::way) is known

    Status go();
  };
  void begin(Session& session, const Measures& measures);

  std::unique_ptr<Job> job_;
  int quiet_ = 0;  ///< pictures since the last jump of time
};

}  // namespace tumble
