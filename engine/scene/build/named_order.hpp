#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Sorts things so that each comes after those that it needs, otherwise in the order in which they
/// are added.
class NamedOrder {
 public:
  /// `needs`: the names that a thing needs; empty for unknown names.
  explicit NamedOrder(std::function<std::vector<std::string>(const std::string&)> needs)
      : needs_(std::move(needs)) {}

  /// False if its needs form a cycle.
  bool add(const std::string& name) {
    if (std::ranges::find(order, name) != order.end()) return true;
    if (std::ranges::find(open_, name) != open_.end()) return false;
    open_.push_back(name);
    for (const std::string& other : needs_(name))
      if (!add(other)) return false;
    open_.pop_back();
    order.push_back(name);
    return true;
  }
  std::vector<std::string> order;

 private:
  std::function<std::vector<std::string>(const std::string&)> needs_;
  std::vector<std::string> open_;
};

}  // namespace tumble
