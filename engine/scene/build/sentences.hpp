#pragma once
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tumble {

/// Warnings of one kind: the first few, and the number of the others, since copies of a thing give
/// the same warning.
class Sentences {
 public:
  static constexpr size_t most_named = 3;
  explicit Sentences(std::vector<std::string>& out) : out_(out) {}
  ~Sentences() {
    if (count_ > most_named) out_.back() += fmt::format(" (and {} more)", count_ - most_named);
  }
  Sentences(const Sentences&) = delete;
  Sentences& operator=(const Sentences&) = delete;
  void add(std::string sentence) {
    if (++count_ <= most_named) out_.push_back(std::move(sentence));
  }

 private:
  std::vector<std::string>& out_;
  size_t count_ = 0;
};

}  // namespace tumble
