#include "engine/scene/fault.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Whether `inner` is equal to `outer` or a path inside it.
bool is_within(std::string_view inner, std::string_view outer) {
  if (!inner.starts_with(outer)) return false;
  return inner.size() == outer.size() || outer.empty() || inner[outer.size()] == '.' ||
         inner[outer.size()] == '[';
}

}  // namespace

std::string Fault::text() const {
  std::string out = file;
  if (line > 0) out += ":" + std::to_string(line);
  if (!out.empty()) out += ": ";
  if (!path.empty()) out += path + ": ";
  return out + message;
}

void FaultList::add(Fault fault) {
  // Limits the faults of a file that is not a scene at all.
  constexpr size_t most = 200;
  if (faults_.size() >= most) return;
  if (faults_.size() == most - 1) fault.message += " (further faults are not listed)";
  faults_.push_back(std::move(fault));
}

bool FaultList::covers(std::string_view path) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& f) {
    return !f.path.empty() && (is_within(path, f.path) || is_within(f.path, path));
  });
}

std::vector<Fault> FaultList::sorted() const {
  std::vector<Fault> out = faults_;
  std::stable_sort(out.begin(), out.end(),
                   [](const Fault& a, const Fault& b) { return a.line < b.line; });
  return out;
}

Error to_error(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& f : faults) text += (text.empty() ? "" : "\n") + f.text();
  return {ErrorCode::parse, std::move(text), {}, {}};
}

}  // namespace tumble
