#include "engine/scene/robot_files/attributes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Larger numbers are considered errors of the file, since results computed from them might
/// overflow.
constexpr double largest = 1e12;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Parses numbers separated by space; returns the message of a fault, or nothing.
std::optional<std::string> read_numbers(std::string_view text, std::vector<double>& out) {
  size_t at = 0;
  while (true) {
    while (at < text.size() && is_space(text[at])) ++at;
    if (at == text.size()) return std::nullopt;
    size_t end = at;
    while (end < text.size() && !is_space(text[end])) ++end;
    std::string_view word = text.substr(at, end - at);
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [stop, bad] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (bad != std::errc{} || stop != word.data() + word.size())
      return fmt::format("'{}' is not a number", word);
    if (!(std::fabs(value) <= largest)) return fmt::format("{} is no usable number", word);
    out.push_back(value);
    at = end;
  }
}

}  // namespace

Attributes::Attributes(const XmlElement& element, RobotLog& log)
    : element_(element.name), at_(element.at), log_(log) {
  for (const auto& [name, text] : element.attributes) values_[name] = {text, element.at};
}

Attributes::~Attributes() {
  for (const auto& [name, value] : values_)
    if (!used_.contains(name))
      log_.warn(value.at, fmt::format("<{}>: '{}' is not followed", element_, name));
}

void Attributes::set_default(const std::string& name, const Value& value) {
  values_.emplace(name, value);
}

const Attributes::Value* Attributes::take(std::string_view name) {
  used_.emplace(name, true);
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

void Attributes::fault(std::string_view name, const std::string& message) {
  const auto found = values_.find(name);
  log_.fault(
      found == values_.end() ? at_ : found->second.at,
      fmt::format("<{}>: {}{}", element_, name.empty() ? "" : fmt::format("'{}' ", name), message));
}

std::vector<double> Attributes::numbers(std::string_view name, size_t least, size_t most) {
  const Value* value = take(name);
  std::vector<double> out;
  if (!value) return out;
  if (const auto wrong = read_numbers(value->text, out)) {
    fault(name, *wrong);
    return {};
  }
  if (out.size() >= least && out.size() <= most) return out;
  fault(name,
        fmt::format("needs {} number{}, got {}",
                    least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most),
                    most == 1 ? "" : "s", out.size()));
  return {};
}

void Attributes::read(std::string_view name, double& out) {
  const auto values = numbers(name, 1, 1);
  if (!values.empty()) out = values[0];
}

void Attributes::read(std::string_view name, std::optional<double>& out) {
  const auto values = numbers(name, 1, 1);
  if (!values.empty()) out = values[0];
}

void Attributes::read(std::string_view name, Vec3& out) {
  const auto values = numbers(name, 3, 3);
  if (!values.empty()) out = {values[0], values[1], values[2]};
}

void Attributes::read(std::string_view name, std::string& out) {
  if (const Value* value = take(name)) out = value->text;
}

void Attributes::read(std::string_view name, bool& out) {
  const Value* value = take(name);
  if (!value) return;
  if (value->text == "true" || value->text == "1" || value->text == "enable")
    out = true;
  else if (value->text == "false" || value->text == "0" || value->text == "disable")
    out = false;
  else
    fault(name, fmt::format("must be true or false, got '{}'", value->text));
}

std::string Attributes::name_of(std::string_view name) {
  const Value* value = take(name);
  if (value && !value->text.empty()) return value->text;
  fault("", fmt::format("the attribute '{}' is missing", name));
  return {};
}

std::optional<std::string> Attributes::text(std::string_view name) {
  const Value* value = take(name);
  return value ? std::optional(value->text) : std::nullopt;
}

size_t Attributes::word(std::string_view name, std::initializer_list<std::string_view> words) {
  const Value* value = take(name);
  if (!value) return 0;
  const auto found = std::find(words.begin(), words.end(), value->text);
  if (found != words.end()) return size_t(found - words.begin());
  std::string list;
  for (const std::string_view w : words) list += (list.empty() ? "" : ", ") + std::string(w);
  fault(name, fmt::format("must be one of {}, got '{}'", list, value->text));
  return 0;
}

std::optional<Colour> Attributes::rgba(std::string_view name, double* alpha) {
  const auto v = numbers(name, 3, 4);
  if (v.empty()) return std::nullopt;
  const auto part = [](double x) { return std::clamp(x, 0.0, 1.0); };
  if (alpha && v.size() == 4) *alpha = part(v[3]);
  return Colour{part(v[0]), part(v[1]), part(v[2])};
}

void Attributes::skip(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) used_.emplace(name, true);
}

void Attributes::warn_of(std::initializer_list<std::string_view> names, const std::string& why) {
  for (const std::string_view name : names)
    if (const Value* value = take(name))
      log_.warn(value->at, fmt::format("<{}>: '{}' is not followed: {}", element_, name, why));
}

}  // namespace tumble
