#include "engine/scene/saving/common_lines.hpp"

#include <algorithm>
#include <cstdint>

namespace tumble {

std::vector<std::string_view> lines_of_text(std::string_view text) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::vector<CommonLine> common_lines(const std::vector<std::string_view>& a,
                                     const std::vector<std::string_view>& b) {
  size_t head = 0, tail = 0;
  while (head < std::min(a.size(), b.size()) && a[head] == b[head]) ++head;
  while (tail < std::min(a.size(), b.size()) - head &&
         a[a.size() - 1 - tail] == b[b.size() - 1 - tail])
    ++tail;
  const size_t n = a.size() - head - tail, m = b.size() - head - tail;
  std::vector<std::vector<uint32_t>> common(n + 1, std::vector<uint32_t>(m + 1, 0));
  for (size_t i = n; i-- > 0;)
    for (size_t j = m; j-- > 0;)
      common[i][j] = a[head + i] == b[head + j] ? common[i + 1][j + 1] + 1
                                                : std::max(common[i + 1][j], common[i][j + 1]);
  std::vector<CommonLine> out;
  for (size_t i = 0; i < head; ++i) out.push_back({i, i});
  for (size_t i = 0, j = 0; i < n && j < m;) {
    if (a[head + i] == b[head + j])
      out.push_back({head + i++, head + j++});
    else if (common[i + 1][j] >= common[i][j + 1])
      ++i;
    else
      ++j;
  }
  for (size_t i = 0; i < tail; ++i) out.push_back({head + n + i, head + m + i});
  return out;
}

}  // namespace tumble
