#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Instruction sets that kernels were compiled for and this machine has: "AVX3", "AVX2", "SSE2".
/// The best one, which is taken by default, comes first.
std::vector<std::string> simd_targets();

/// While one lives kernels take the instruction set of this name, in all threads of the program,
/// and afterwards the best one again. "", and what simd_targets() does not name: the best one.
/// Results do not depend on it.
class SimdTarget {
 public:
  explicit SimdTarget(std::string_view name);
  ~SimdTarget();
  SimdTarget(const SimdTarget&) = delete;
  SimdTarget& operator=(const SimdTarget&) = delete;

 private:
  bool chosen_ = false;
};

}  // namespace tumble
