#include "viewer/capture/free_name.hpp"

#include <fmt/format.h>

namespace tumble {

std::filesystem::path free_name(const std::filesystem::path& folder, std::string_view stem,
                                std::string_view ending) {
  constexpr int most = 99999;
  std::error_code ignored;
  for (int i = 0;; ++i) {
    auto path = (folder / fmt::format("{}-{:03}{}", stem, i, ending)).lexically_normal();
    if (i > most || !std::filesystem::exists(path, ignored)) return path;
  }
}

}  // namespace tumble
