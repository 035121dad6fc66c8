#include "viewer/app/window/microscope_controller.hpp"

#include "viewer/app/session/microscope_pair.hpp"

#include <utility>

namespace tumble {

void MicroscopeController::open(std::optional<MicroscopeSetup> of_scene) {
  setup_ = std::move(of_scene);
  put_by_person_ = false;
}

std::optional<MicroscopeSetup> MicroscopeController::setup(const MicroscopeChoice& choice) const {
  std::optional<MicroscopeSetup> out = setup_;
  if (out && !choice.algorithm.empty()) out->algorithm = choice.algorithm;
  return out;
}

bool MicroscopeController::put(const Frame& frame, BodyId body) {
  setup_ = find_microscope_pair(frame, body);
  put_by_person_ = setup_.has_value();
  return put_by_person_;
}

bool MicroscopeController::take_away() {
  if (!std::exchange(put_by_person_, false)) return false;
  setup_.reset();
  return true;
}

}  // namespace tumble
