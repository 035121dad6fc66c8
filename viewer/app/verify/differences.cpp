#include "viewer/app/session/changed_settings.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Every setting with its value as bytes or text, in the order of declaration.
struct Values {
  std::vector<std::pair<std::string, std::string>> all;

  template <class T>
  void field(const T& value, const Parameter& p) {
    all.emplace_back(p.name, text(value));
  }
  template <class T>
  void object(const T& value, const Parameter&) {
    T::parameters(*this, value);
  }

 private:
  static const std::string& text(const std::string& value) { return value; }
  static std::string text(const TickRate& rate) {
    return std::to_string(rate.num) + "/" + std::to_string(rate.den);
  }
  static std::string text(const Vec3& v) { return text(v.x()) + text(v.y()) + text(v.z()); }
  template <class T>
  requires std::is_arithmetic_v<T>
  static std::string text(T value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }
};

Values values_of(const WorldSettings& settings) {
  Values values;
  WorldSettings::parameters(values, settings);
  return values;
}

/// Every setting as people read it; names speak for themselves.
struct Words {
  std::vector<std::string> all;

  template <class T>
  void field(const T& value, const Parameter& p) {
    all.push_back(text(value, p));
  }
  template <class T>
  void object(const T& value, const Parameter&) {
    T::parameters(*this, value);
  }

 private:
  static std::string named(const Parameter& p, std::string value) {
    std::string name(p.name);
    std::ranges::replace(name, '_', ' ');
    return p.unit.empty() ? fmt::format("{} {}", name, value)
                          : fmt::format("{} {} {}", name, value, p.unit);
  }
  static std::string text(const std::string& value, const Parameter&) {
    std::string words = value;
    std::ranges::replace(words, '_', ' ');
    return words;
  }
  static std::string text(const TickRate& rate, const Parameter&) {
    return fmt::format("{:.6g} ticks/s", 1 / rate.tick());
  }
  static std::string text(const Vec3& v, const Parameter& p) {
    return named(p, fmt::format("{:.4g} {:.4g} {:.4g}", v.x(), v.y(), v.z()));
  }
  static std::string text(bool on, const Parameter& p) { return named(p, on ? "on" : "off"); }
  template <class T>
  requires std::is_arithmetic_v<T>
  static std::string text(T value, const Parameter& p) {
    return named(p, fmt::format("{:.6g}", double(value)));
  }
};

}  // namespace

std::pair<std::string, std::string> names_by_settings(const WorldSettings& a,
                                                      const WorldSettings& b) {
  const Values of_a = values_of(a), of_b = values_of(b);
  Words words_a, words_b;
  WorldSettings::parameters(words_a, a);
  WorldSettings::parameters(words_b, b);
  constexpr int most = 2;
  std::string name_a, name_b;
  int count = 0;
  for (size_t i = 0; i < of_a.all.size(); ++i) {
    if (of_a.all[i].second == of_b.all[i].second || ++count > most) continue;
    const char* comma = count > 1 ? ", " : "";
    name_a += comma + words_a.all[i];
    name_b += comma + words_b.all[i];
  }
  if (count > most) {
    const std::string more = fmt::format(" and {} more", count - most);
    name_a += more;
    name_b += more;
  }
  return {name_a, name_b};
}

std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b) {
  const Values of_a = values_of(a), of_b = values_of(b);
  std::vector<std::string> names;
  for (size_t i = 0; i < of_a.all.size(); ++i)
    if (of_a.all[i].second != of_b.all[i].second) names.push_back(of_a.all[i].first);
  return names;
}

}  // namespace tumble
