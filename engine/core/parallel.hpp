#pragma once
#include <cstddef>

#include <tbb/task_arena.h>

#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#endif

namespace tumble {

/// Calls body(i) for every i of [0, n) on the threads of `arena`, in any order, and returns when
/// all are done. No body may touch what another writes.
///
/// Under thread checks plain threads do the same work: Debian's oneTBB is not instrumented, and its
/// own hand-overs would be reported as races, and hide ours.
template <class Body>
void parallel_for(tbb::task_arena& arena, size_t n, const Body& body) {
#if defined(__SANITIZE_THREAD__)
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < n; i = next++) body(i);
  };
  std::vector<std::jthread> helpers;
  const auto threads = size_t(arena.max_concurrency());
  for (size_t k = 1; k < threads && k < n; ++k) helpers.emplace_back(work);
  work();
#else
  arena.execute([&] { tbb::parallel_for(size_t{0}, n, body); });
#endif
}

}  // namespace tumble
