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

/// Gives curves that were not watched from the start their past: the way to the present is gone
/// once more in a world of its own, from the kept moments on, beside the one that runs. At most as
/// many ticks as a curve has room for; given up when time goes elsewhere, and begun anew from
/// there.
class PastCurves {
 public:
  PastCurves() = default;
  ~PastCurves() { forget(); }
  PastCurves(const PastCurves&) = delete;
  PastCurves& operator=(const PastCurves&) = delete;

  /// Once a picture. `beside`: on a thread of its own; else at once.
  void update(Session& session, Measures& measures, bool beside);
  /// The world has gone to another moment: what is under way led to one that may not be there.
  void note_jump();
  /// Nobody wants it any more.
  void forget();
  /// How much of what is under way is done, 0..1; nothing while nothing is.
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
    std::future<Status> outcome;  ///< not valid until the way is known

    Status go();
  };
  void begin(Session& session, const Measures& measures);

  std::unique_ptr<Job> job_;
  int quiet_ = 0;  ///< pictures since time last went elsewhere
};

}  // namespace tumble
