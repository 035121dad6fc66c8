#include "viewer/app/editing/opening_trial.hpp"

#include "viewer/app/scenes/load_scene.hpp"

#include <chrono>
#include <utility>

namespace tumble {

OpeningTrial::OpeningTrial(std::string text, std::filesystem::path file, bool beside)
    : outcome_(std::async(beside ? std::launch::async : std::launch::deferred,
                          [this, text = std::move(text), file = std::move(file)] {
                            const Stoppable scope(&stop_);
                            return check_scene_text(text, file);
                          })) {}

std::optional<Status> OpeningTrial::take() {
  if (!outcome_.valid() ||
      outcome_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout)
    return std::nullopt;
  return outcome_.get();
}

}  // namespace tumble
