#include "engine/dynamics/simd/simd_target.hpp"

#include <cstdint>

#include <hwy/highway.h>

namespace tumble {
std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

SimdTarget::SimdTarget(std::string_view name) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) {
      hwy::GetChosenTarget().Update(target);
      chosen_ = true;
    }
}

SimdTarget::~SimdTarget() {
  if (chosen_) hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace tumble
