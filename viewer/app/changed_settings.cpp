#include "viewer/app/changed_settings.hpp"

#include <utility>

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

}  // namespace

std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b) {
  const Values of_a = values_of(a), of_b = values_of(b);
  std::vector<std::string> names;
  for (size_t i = 0; i < of_a.all.size(); ++i)
    if (of_a.all[i].second != of_b.all[i].second) names.push_back(of_a.all[i].first);
  return names;
}

}  // namespace tumble
