#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>

namespace tumble {

/// The threads of a world. Loops are run as tasks; or, while the threads are gathered for a piece
/// of work, directly: one thread conducts, and the others wait for loops and take chunks of them,
/// so that starting a loop costs about a microsecond instead of the synchronisation of tasks.
class Crew {
 public:
  explicit Crew(int threads);
  ~Crew();

  int threads() const { return threads_; }

  /// Calls work() on this thread; until it returns the other threads help in its loops. Threads
  /// that are busy elsewhere are not waited for. One piece of work at a time.
  template <class Work>
  void gather(const Work& work) {
    if (alone_ || gathered_) return work();
    over_.store(false, std::memory_order_relaxed);
    const auto conducted = [&] {
      const Gathering lasts(*this);
      work();
    };
    with_helpers([](const void* w) { (*static_cast<const decltype(conducted)*>(w))(); },
                 &conducted);
  }

  /// Calls f(i) for every i of [0, n), in any order and on any thread; returns when all are done.
  /// No f(i) may access what another writes, or throw among gathered threads. Loops inside f, among
  /// gathered threads, run on the calling thread alone.
  template <class F>
  void each(size_t n, const F& f) {
    const bool conducts = gathered_ && !in_loop_ && conductor_ == std::this_thread::get_id();
    if (n <= 1 || alone_ || (gathered_ && !conducts)) {
      for (size_t i = 0; i < n; ++i) f(i);
    } else if (conducts) {
      conduct(n, f);
    } else {
      share_out(
          n, [](const void* g, size_t i) { (*static_cast<const F*>(g))(i); }, &f);
    }
  }

 private:
  static constexpr int bits = 16;
  static constexpr uint32_t most = (1u << bits) - 1;  ///< more than most_chunks
  /// Limit of the chunks of a loop; with more indices, a chunk has several.
  static constexpr size_t most_chunks = 512;

  using Call = void (*)(const void*, uint32_t);
  /// Ends the gathering and releases the helpers, also if the work throws.
  class Gathering {
   public:
    explicit Gathering(Crew& crew) : crew_(crew) {
      crew_.conductor_ = std::this_thread::get_id();
      crew_.gathered_ = true;
    }
    Gathering(const Gathering&) = delete;
    Gathering& operator=(const Gathering&) = delete;
    ~Gathering() {
      crew_.gathered_ = false;
      crew_.over_.store(true, std::memory_order_release);
    }

   private:
    Crew& crew_;
  };

  template <class F>
  struct Loop {
    const F& f;
    size_t n, at_once;

    static void run(const void* loop, uint32_t chunk) noexcept {
      const Loop& l = *static_cast<const Loop*>(loop);
      const size_t begin = l.at_once * chunk, end = std::min(l.n, begin + l.at_once);
      for (size_t i = begin; i < end; ++i) l.f(i);
    }
  };

  template <class F>
  void conduct(size_t n, const F& f) {
    const size_t at_once = (n + most_chunks - 1) / most_chunks;
    const Loop<F> loop{f, n, at_once};
    const auto chunks = uint32_t((n + at_once - 1) / at_once);
    in_loop_ = true;
    done_.store(0, std::memory_order_relaxed);
    call_.store(&Loop<F>::run, std::memory_order_relaxed);
    object_.store(&loop, std::memory_order_relaxed);
    left_.store(++loops_ << 2 * bits | uint64_t{chunks} << bits, std::memory_order_release);
    const uint32_t helped = chunks - take_all(Side::front);
    for (int idle = 0; done_.load(std::memory_order_acquire) != helped;) rest(++idle);
    in_loop_ = false;
  }

  /// The end from which chunks are taken: the conductor takes from the front and helpers from the
  /// back, so that from loop to loop the same data tend to be in the caches of the same cores.
  enum class Side { front, back };

  /// Runs the next chunk, if any is left. The number of the loop and the range of its remaining
  /// chunks are one atomic word, which changes with every chunk that is taken; the call to make
  /// changes only after all chunks have been taken. A thread that takes a chunk has therefore read
  /// the call of the same loop.
  bool take_one(Side side) {
    uint64_t left = left_.load(std::memory_order_acquire);
    for (;;) {
      const auto begin = uint32_t(left & most), end = uint32_t(left >> bits & most);
      if (begin >= end) return false;
      const Call call = call_.load(std::memory_order_relaxed);
      const void* object = object_.load(std::memory_order_relaxed);
      const bool front = side == Side::front;
      const uint64_t after = front ? left + 1 : left - (uint64_t{1} << bits);
      if (!left_.compare_exchange_weak(left, after, std::memory_order_acq_rel,
                                       std::memory_order_acquire))
        continue;
      call(object, front ? begin : end - 1);
      return true;
    }
  }
  /// Runs chunks of the present loop until none is left; returns how many.
  uint32_t take_all(Side side) {
    uint32_t taken = 0;
    while (take_one(side)) ++taken;
    return taken;
  }
  void help();
  /// Called between two checks for work: yields the core after many idle checks.
  static void rest(int idle) {
    if (idle > 200) std::this_thread::yield();
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }

  /// Calls work(object) while the other threads help in its loops.
  void with_helpers(void (*work)(const void*), const void* object);
  /// Calls f(object, i) for every i of [0, n) as tasks of the threads.
  void share_out(size_t n, void (*f)(const void*, size_t), const void* object);

  struct Arena;
  std::unique_ptr<Arena> arena_;
  int threads_;
  bool alone_;
  bool gathered_ = false;
  std::thread::id conductor_;
  bool in_loop_ = false;  ///< of the conductor
  uint64_t loops_ = 0;
  std::atomic<bool> over_{false};
  /// Number of the loop, end and begin of its remaining chunks.
  alignas(64) std::atomic<uint64_t> left_{0};
  std::atomic<Call> call_{nullptr};
  std::atomic<const void*> object_{nullptr};
  alignas(64) std::atomic<uint32_t> done_{0};  ///< number of chunks that helpers have run
};

}  // namespace tumble
