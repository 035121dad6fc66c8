#include "viewer/ui/ui_state.hpp"

namespace tumble {

void UiState::toast(ToastKind kind, std::string title, std::vector<std::string> lines) {
  if (kind != ToastKind::error)
    std::erase_if(toasts, [&](const Toast& t) { return t.kind == kind && t.title == title; });
  while (toasts.size() >= 4) toasts.pop_front();
  toasts.push_back({kind, std::move(title), std::move(lines), kind == ToastKind::info ? 3.0 : 8.0});
}

}  // namespace tumble
