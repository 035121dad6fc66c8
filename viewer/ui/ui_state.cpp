#include "viewer/ui/ui_state.hpp"

#include <cmath>

namespace tumble {

void UiState::toast(ToastKind kind, std::string title, std::vector<std::string> lines) {
  std::erase_if(toasts, [&](const Toast& t) { return t.kind == kind && t.title == title; });
  // Errors stay until they are closed: only other messages are dropped to make room.
  const auto passing = [](const Toast& t) { return t.kind != ToastKind::error; };
  for (auto it = toasts.begin(); toasts.size() >= 4 && it != toasts.end();)
    it = passing(*it) ? toasts.erase(it) : std::next(it);
  toasts.push_back({kind, std::move(title), std::move(lines), kind == ToastKind::info ? 3.0 : 8.0});
}

void UiState::raise_new() {
  for (size_t i = 0; i < panel_count; ++i) {
    if (!visible[i])
      raised[i] = 0;
    else if (raised[i] == 0)
      raise(PanelId(i));
  }
}

bool SceneParameter::whole() const {
  const auto round = [](double v) { return v == std::round(v); };
  return round(value) && round(min.value_or(0)) && round(max.value_or(0)) && (min || max);
}

}  // namespace tumble
