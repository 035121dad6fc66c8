// Runs one random scene and says what became of it:
//   random_scene --seed N [--stepper event] [--seconds S] [--limit CPU_SECONDS] [--print]
//   random_scene --damaged N --print
// --print writes the scene instead of running it, for `tumble open` and `tumble simulate`.
#include "tests/fuzz/damaged.hpp"
#include "tests/fuzz/judge_scene.hpp"
#include "tests/support/process_limits.hpp"

#include <cstdlib>
#include <optional>
#include <string_view>

#include <fmt/format.h>

using namespace tumble;

int main(int count, char** arguments) {
  uint64_t seed = 0;
  std::string stepper = "realtime";
  double seconds = 1;
  unsigned limit = 120;
  bool print = false;
  std::optional<uint64_t> damaged;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = arguments[i];
    const bool more = i + 1 < count;
    if (word == "--print") {
      print = true;
    } else if (word == "--damaged" && more) {
      damaged = std::strtoull(arguments[++i], nullptr, 10);
    } else if (word == "--seed" && more) {
      seed = std::strtoull(arguments[++i], nullptr, 10);
    } else if (word == "--stepper" && more) {
      stepper = arguments[++i];
    } else if (word == "--seconds" && more) {
      seconds = std::strtod(arguments[++i], nullptr);
    } else if (word == "--limit" && more) {
      limit = unsigned(std::strtoul(arguments[++i], nullptr, 10));
    } else {
      fmt::print(stderr,
                 "usage: random_scene --seed N [--stepper realtime|event] [--seconds S] [--limit "
                 "CPU_SECONDS] [--print]\n");
      return 2;
    }
  }
  if (damaged) {
    fmt::print("{}\n", damaged_scene(*damaged));
    return 0;
  }
  const RandomScene scene = random_scene(seed, stepper);
  if (print) {
    fmt::print("{}\n", scene.text);
    return 0;
  }
  limit_process(limit, 4096);
  const SceneVerdict verdict = judge_scene(scene, stepper, seconds);
  fmt::print("{} {}{}: {}\ncpu {}\n", stepper, seed, scene.ordinary ? " (ordinary)" : "",
             verdict.text(), verdict.cpu);
  return verdict.right() ? 0 : 1;
}
