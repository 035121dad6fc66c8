#include "engine/core/crew.hpp"

#include "engine/core/stop.hpp"

#include <optional>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#if defined(__SANITIZE_THREAD__)
#include <vector>
#else
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>
#endif

namespace tumble {

struct Crew::Arena {
  explicit Arena(int threads) : tasks(threads) {
    if (threads > int(std::thread::hardware_concurrency()))
      allowed.emplace(tbb::global_control::max_allowed_parallelism, size_t(threads));
  }
  std::optional<tbb::global_control> allowed;  ///< where more threads than cores are asked for
  tbb::task_arena tasks;
};

Crew::Crew(int threads)
    : arena_(std::make_unique<Arena>(threads)),
      threads_(arena_->tasks.max_concurrency()),
      alone_(threads == 1) {}

Crew::~Crew() = default;

void Crew::help() {
  for (int idle = 0; !over_.load(std::memory_order_acquire);) {
    if (const uint32_t taken = take_all(Side::back)) {
      done_.fetch_add(taken, std::memory_order_release);
      idle = 0;
    } else {
      rest(++idle);
    }
  }
}

#if defined(__SANITIZE_THREAD__)
// Plain threads do the same work: Debian's oneTBB is not instrumented, and its own hand-overs
// would be reported as races, and hide ours.
void Crew::with_helpers(void (*work)(const void*), const void* object) {
  std::vector<std::jthread> helpers;
  const StopFlag* stop = Stoppable::present();
  for (int k = 1; k < threads(); ++k)
    helpers.emplace_back([this, stop] {
      const Stoppable scope(stop);
      help();
    });
  work(object);
}

void Crew::share_out(size_t n, void (*f)(const void*, size_t), const void* object) {
  std::atomic<size_t> next{0};
  const StopFlag* stop = Stoppable::present();
  const auto work = [&] {
    const Stoppable scope(stop);
    for (size_t i = next++; i < n; i = next++) f(object, i);
  };
  std::vector<std::jthread> helpers;
  for (size_t k = 1; k < std::min(size_t(threads()), n); ++k) helpers.emplace_back(work);
  work();
}
#else
void Crew::with_helpers(void (*work)(const void*), const void* object) {
  const StopFlag* stop = Stoppable::present();
  arena_->tasks.execute([&] {
    const Stoppable scope(stop);
    tbb::task_group helpers;
    for (int k = 1; k < threads(); ++k)
      helpers.run([this, stop] {
        const Stoppable of_helper(stop);
        help();
      });
    work(object);
    helpers.wait();
  });
}

void Crew::share_out(size_t n, void (*f)(const void*, size_t), const void* object) {
  const StopFlag* stop = Stoppable::present();
  arena_->tasks.execute([&] {
    tbb::parallel_for(size_t{0}, n, [&](size_t i) {
      const Stoppable scope(stop);
      f(object, i);
    });
  });
}
#endif

}  // namespace tumble
