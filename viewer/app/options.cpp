#include "viewer/app/options.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {
namespace {

/// Parses a number, if the whole text is one.
template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Validator for numbers from `least` to `greatest`; also rejects NaN and everything that is not a
/// number.
template <class Number>
CLI::Validator range(Number least, Number greatest, const char* kind) {
  return CLI::Validator(
      [=](std::string& text) {
        const auto value = number_of<Number>(text);
        if (value && *value >= least && *value <= greatest) return std::string{};
        return fmt::format("'{}' is not a {}number from {} to {}", text, kind, least, greatest);
      },
      fmt::format("from {} to {}", least, greatest));
}

}  // namespace

const Option& Option::required() const {
  option_->required();
  return *this;
}

const Option& Option::hidden() const {
  option_->group("");
  return *this;
}

const Option& Option::shows_default() const {
  option_->capture_default_str();
  return *this;
}

const Option& Option::one_each() const {
  option_->allow_extra_args(false);
  return *this;
}

const Option& Option::natural() const {
  option_->check(CLI::Validator(
      [](std::string& text) {
        const bool digits =
            !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        if (!digits) return "'" + text + "' is not a whole number of 0 or more";
        if (!number_of<uint64_t>(text)) return "'" + text + "' is more than any count may be";
        return std::string{};
      },
      ""));
  return *this;
}

const Option& Option::between(int least, int greatest) const {
  option_->check(range(least, greatest, "whole "));
  return *this;
}

const Option& Option::between(double least, double greatest) const {
  option_->check(range(least, greatest, ""));
  return *this;
}

const Option& Option::one_of(std::vector<std::string> names) const {
  const std::string list = fmt::format("{}", fmt::join(names, ", "));
  option_->check(CLI::Validator(
      [names = std::move(names), list](std::string& text) {
        const bool known = std::find(names.begin(), names.end(), text) != names.end();
        return known ? std::string{} : fmt::format("'{}' is not one of {}", text, list);
      },
      "one of " + list));
  return *this;
}

const Option& Option::not_empty() const {
  option_->check(CLI::Validator(
      [](std::string& text) { return text.empty() ? std::string("is empty") : std::string{}; },
      ""));
  return *this;
}

const Option& Option::ends_in(std::vector<std::string> endings) const {
  option_->check(CLI::Validator(
      [endings = std::move(endings)](std::string& text) {
        std::string ending = std::filesystem::path(text).extension().string();
        std::ranges::transform(ending, ending.begin(),
                               [](unsigned char c) { return char(std::tolower(c)); });
        const bool known = std::find(endings.begin(), endings.end(), ending) != endings.end();
        return known ? std::string{}
                     : fmt::format("'{}' does not end in {}", text, fmt::join(endings, ", "));
      },
      ""));
  return *this;
}

const Option& Option::needs(const Option& other) const {
  option_->needs(other.option_);
  return *this;
}

const Option& Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

template <class T>
Option Options::value(const std::string& name, T& variable, const std::string& doc) {
  return Option(app_.add_option(name, variable, doc));
}
template Option Options::value(const std::string&, std::string&, const std::string&);
template Option Options::value(const std::string&, double&, const std::string&);
template Option Options::value(const std::string&, int&, const std::string&);
template Option Options::value(const std::string&, uint64_t&, const std::string&);
template Option Options::value(const std::string&, std::optional<double>&, const std::string&);
template Option Options::value(const std::string&, std::optional<int>&, const std::string&);
template Option Options::value(const std::string&, std::optional<uint64_t>&, const std::string&);
template Option Options::value(const std::string&, std::vector<std::string>&, const std::string&);

Option Options::flag(const std::string& name, bool& variable, const std::string& doc) {
  return Option(app_.add_flag(name, variable, doc));
}

Option Options::flag(const std::string& name, std::string& variable, const std::string& doc) {
  return Option(app_.add_flag(name, variable, doc));
}

void Options::footer(const std::string& text) {
  app_.footer(text);
}

}  // namespace tumble
