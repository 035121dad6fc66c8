#include "viewer/app/window/scene_loader.hpp"

#include <fmt/format.h>

namespace tumble {

std::vector<SceneEdit> chosen_numbers(const OpenedScene& scene) {
  std::vector<SceneEdit> numbers;
  for (const SceneParameter& p : scene.parameters)
    for (const std::string& o : scene.request.overrides)
      if (o.starts_with(fmt::format("parameters.{}=", p.name)))
        numbers.push_back(ChangedParameter{p.name, p.value});
  return numbers;
}

void SceneLoader::start(SceneOpener open, OpenRequest wanted) {
  open_ = std::move(open);
  asked_ = std::move(wanted);
  since_ = Clock::now();
  outdated_ = under_way_.valid();
  if (outdated_)
    stop_.request();
  else
    begin();
}

void SceneLoader::begin() {
  stop_.clear();
  under_way_ = std::async(std::launch::async, [this, open = open_, wanted = asked_] {
    const Stoppable scope(&stop_);
    return open(wanted);
  });
}

double SceneLoader::seconds() const {
  return asked_.scene.empty() ? 0 : std::chrono::duration<double>(Clock::now() - since_).count();
}

std::optional<SceneLoader::Loaded> SceneLoader::take() {
  if (!under_way_.valid() ||
      under_way_.wait_for(Clock::duration::zero()) != std::future_status::ready)
    return std::nullopt;
  Result<OpenedScene> scene = under_way_.get();
  if (std::exchange(outdated_, false)) {
    begin();
    return std::nullopt;
  }
  return Loaded{std::exchange(asked_, {}), std::move(scene)};
}

}  // namespace tumble
