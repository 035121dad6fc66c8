#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace tumble {

/// Adds the ids of a name and, for what has copies, of all that are present, by slot.
template <class Ids, class Id>
void add_ids(const Ids& ids, const std::string& name, std::vector<Id>& out) {
  if (const auto it = ids.find(name); it != ids.end()) return out.push_back(it->second);
  const std::string copy = name + "[";
  const size_t before = out.size();
  for (auto it = ids.lower_bound(copy); it != ids.end() && it->first.starts_with(copy); ++it)
    out.push_back(it->second);
  std::sort(out.begin() + ptrdiff_t(before), out.end(),
            [](const Id& a, const Id& b) { return a.index < b.index; });
}

}  // namespace tumble
