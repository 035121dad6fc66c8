#pragma once
#include "engine/core/parallel.hpp"

#include <atomic>
#include <cstdint>
#include <thread>

namespace tumble {

/// The threads of an arena through many short loops in a row: one conducts, the others wait for
/// loops and take chunks of them as they come, so that a loop costs a microsecond and not a
/// rendezvous of tasks. Whoever fails to come is not waited for.
class Crew {
 public:
  /// Calls work(crew) on one thread; the others help in its loops.
  template <class Work>
  static void run(tbb::task_arena& arena, const Work& work) {
    Crew crew;
    const auto threads = size_t(arena.max_concurrency());
    crew.alone_ = threads == 1;
    if (crew.alone_) {
      arena.execute([&] { work(crew); });
      return;
    }
    parallel_for(arena, threads, [&](size_t) {
      if (crew.conducted_.exchange(true)) {
        crew.help();
      } else {
        work(crew);
        crew.over_.store(true, std::memory_order_release);
      }
    });
  }

  /// f(i) for every i of [0, n), in any order and on any thread; returns when all are done.
  template <class F>
  void each(uint32_t n, const F& f) {
    if (n <= 1 || alone_ || n > most) {
      for (uint32_t i = 0; i < n; ++i) f(i);
      return;
    }
    done_.store(0, std::memory_order_relaxed);
    call_.store([](const void* g, uint32_t i) { (*static_cast<const F*>(g))(i); },
                std::memory_order_relaxed);
    object_.store(&f, std::memory_order_relaxed);
    next_.store(++loops_ << 2 * bits | uint64_t{n} << bits, std::memory_order_release);
    while (take_one()) {
    }
    while (done_.load(std::memory_order_acquire) != n) std::this_thread::yield();
  }

 private:
  using Call = void (*)(const void*, uint32_t);

  static constexpr int bits = 20;
  static constexpr uint32_t most = (1u << bits) - 1;  ///< chunks of a loop that others help with

  /// Does the next chunk, if any is left. The number of the loop, how many chunks it has and which
  /// is the next are one word: it changes with every chunk that is taken, and what to call changes
  /// only when all have been. So who takes a chunk has read the call of that very loop.
  bool take_one() {
    uint64_t next = next_.load(std::memory_order_acquire);
    for (;;) {
      const auto i = uint32_t(next & most), n = uint32_t(next >> bits & most);
      if (i >= n) return false;
      const Call call = call_.load(std::memory_order_relaxed);
      const void* object = object_.load(std::memory_order_relaxed);
      if (!next_.compare_exchange_weak(next, next + 1, std::memory_order_acq_rel,
                                       std::memory_order_acquire))
        continue;
      call(object, i);
      done_.fetch_add(1, std::memory_order_release);
      return true;
    }
  }
  void help() {
    for (int idle = 0; !over_.load(std::memory_order_acquire);) {
      if (take_one()) {
        idle = 0;
      } else if (++idle > 200) {
        std::this_thread::yield();
      }
    }
  }

  std::atomic<bool> conducted_{false}, over_{false};
  bool alone_ = false;
  uint64_t loops_ = 0;
  alignas(64) std::atomic<uint64_t> next_{0};  ///< loop, its chunks, the next of them
  std::atomic<Call> call_{nullptr};
  std::atomic<const void*> object_{nullptr};
  alignas(64) std::atomic<uint32_t> done_{0};
};

}  // namespace tumble
