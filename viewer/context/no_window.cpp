#include "viewer/context/window_context.hpp"

namespace tumble {

Result<std::unique_ptr<WindowContext>> make_window_context(const WindowOptions&) {
  return Error{ErrorCode::unsupported, "this program was built without a window", "window",
               "build with -DTUMBLE_WINDOW=ON, or draw to files with `tumble render`"};
}

}  // namespace tumble
