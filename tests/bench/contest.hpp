#pragma once
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

/// Times several ways of doing the same thing in turn, so that all see the same machine.
namespace tumble::bench {

/// One way of doing it. `run` returns a figure by which answers are compared (a count, a sum).
struct Candidate {
  std::string name;
  std::function<double()> run;
};

struct Timing {
  double milliseconds = 0;  ///< median over the rounds, of wall time
  double cpu = 0;           ///< the same of the process's processor time, all threads together [ms]
  double answer = 0;        ///< of the last round
};

inline double processor_milliseconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

inline double median(std::vector<double>& t) {
  std::nth_element(t.begin(), t.begin() + std::ptrdiff_t(t.size() / 2), t.end());
  return t[t.size() / 2];
}

/// Runs every candidate once to warm up, then `rounds` times in turn.
inline std::vector<Timing> contest(const std::vector<Candidate>& candidates, int rounds) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::vector<double>> times(candidates.size()), cpu(candidates.size());
  std::vector<Timing> out(candidates.size());
  for (int round = -1; round < rounds; ++round) {
    for (size_t i = 0; i < candidates.size(); ++i) {
      const auto start = Clock::now();
      const double cpu_start = processor_milliseconds();
      out[i].answer = candidates[i].run();
      const std::chrono::duration<double, std::milli> spent = Clock::now() - start;
      if (round < 0) continue;
      times[i].push_back(spent.count());
      cpu[i].push_back(processor_milliseconds() - cpu_start);
    }
  }
  for (size_t i = 0; i < candidates.size(); ++i) {
    out[i].milliseconds = median(times[i]);
    out[i].cpu = median(cpu[i]);
  }
  return out;
}

/// Runs a contest and prints a line per candidate: median, ratio to the first (the peer), the same
/// ratio of processor time (which a busy machine disturbs less), answer.
inline std::vector<Timing> report(const std::string& title,
                                  const std::vector<Candidate>& candidates, int rounds = 7) {
  const auto timings = contest(candidates, rounds);
  std::printf("%s\n", title.c_str());
  for (size_t i = 0; i < candidates.size(); ++i) {
    std::printf("  %-28s %10.4f ms  %6.3f x  (cpu %6.3f x)  answer %.9g\n",
                candidates[i].name.c_str(), timings[i].milliseconds,
                timings[i].milliseconds / timings[0].milliseconds, timings[i].cpu / timings[0].cpu,
                timings[i].answer);
  }
  std::fflush(stdout);
  return timings;
}

}  // namespace tumble::bench
