#include "viewer/app/verify/differences.hpp"

#include "engine/dynamics/simd/simd_target.hpp"
#include "engine/scene/description.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tumble {
namespace {

std::string spaced(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// A value in the form of scene files and in that for display. Names are enough for themselves.
struct WrittenValue {
  std::string path, value, words;
};

WrittenValue named(std::string path, std::string_view name, std::string value, std::string shown,
                   std::string_view unit = {}) {
  std::string words = fmt::format("{} {}", spaced(name), shown);
  if (!unit.empty()) words += fmt::format(" {}", unit);
  return {std::move(path), std::move(value), std::move(words)};
}

/// Every setting, in the order of declaration.
class WrittenSettings {
 public:
  std::vector<WrittenValue> all;

  template <class T>
  void field(const T& value, const Parameter& p) {
    all.push_back(written(path_ + std::string(p.name), value, p));
  }
  template <class T>
  void object(const T& value, const Parameter& p) {
    const std::string outer = path_;
    path_ += std::string(p.name) + ".";
    T::parameters(*this, value);
    path_ = outer;
  }

 private:
  static WrittenValue written(std::string path, const std::string& value, const Parameter&) {
    return {std::move(path), fmt::format("\"{}\"", value), spaced(value)};
  }
  static WrittenValue written(std::string path, const TickRate& rate, const Parameter&) {
    std::string value =
        rate.den == 1 ? fmt::format("{}", rate.num) : fmt::format("\"{}/{}\"", rate.num, rate.den);
    return {std::move(path), std::move(value), fmt::format("{:.6g} ticks/s", 1 / rate.tick())};
  }
  static WrittenValue written(std::string path, const Vec3& v, const Parameter& p) {
    return named(std::move(path), p.name, fmt::format("[{},{},{}]", v.x(), v.y(), v.z()),
                 fmt::format("{:.4g} {:.4g} {:.4g}", v.x(), v.y(), v.z()), p.unit);
  }
  static std::string written(const Varying& number) {
    if (!number.course) return fmt::format("{}", number.value);
    if (!number.course->text().empty()) return fmt::format("\"={}\"", number.course->text());
    std::string out;
    for (const auto& [t, value] : number.course->points())
      out += fmt::format("{}[{},{}]", out.empty() ? "" : ",", t, value);
    return "[" + out + "]";
  }
  static WrittenValue written(std::string path, const VaryingVec3& v, const Parameter& p) {
    if (!v.varies()) return written(std::move(path), v.now(), p);
    const std::string x = written(v.of[0]), y = written(v.of[1]), z = written(v.of[2]);
    return named(std::move(path), p.name, fmt::format("[{},{},{}]", x, y, z),
                 fmt::format("{} {} {}", x, y, z), p.unit);
  }
  static WrittenValue written(std::string path, bool on, const Parameter& p) {
    return named(std::move(path), p.name, on ? "true" : "false", on ? "on" : "off");
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  static WrittenValue written(std::string path, T value, const Parameter& p) {
    return named(std::move(path), p.name, fmt::format("{}", value),
                 fmt::format("{:.6g}", double(value)), p.unit);
  }

  std::string path_ = "settings.";
};

std::vector<WrittenValue> written(const WorldSettings& settings) {
  WrittenSettings out;
  WorldSettings::parameters(out, settings);
  return std::move(out.all);
}

/// A number that only one choice names has in that world the value given there; the other world has
/// the scene's.
void add_numbers(const WorldChoice& a, const WorldChoice& b, std::vector<WorldDifference>& out) {
  for (const auto& [name, of_a] : a.numbers)
    for (const auto& [same, of_b] : b.numbers) {
      if (name != same || of_a == of_b) continue;
      const std::string va = fmt::format("{}", of_a), vb = fmt::format("{}", of_b);
      out.push_back({"parameters." + name, va, vb, fmt::format("{} {}", spaced(name), va),
                     fmt::format("{} {}", spaced(name), vb)});
    }
}

std::string words_of_threads(int threads) {
  if (threads == 0) return "a thread per core";
  return threads == 1 ? "1 thread" : fmt::format("{} threads", threads);
}

std::string words_of_simd(const std::string& name) {
  return name.empty() ? std::string("best SIMD") : name;
}

}  // namespace

std::vector<WorldDifference> differences(const WorldChoice& a, const WorldChoice& b) {
  std::vector<WorldDifference> out;
  const auto of_a = written(a.settings), of_b = written(b.settings);
  for (size_t i = 0; i < of_a.size(); ++i)
    if (of_a[i].value != of_b[i].value)
      out.push_back({of_a[i].path, of_a[i].value, of_b[i].value, of_a[i].words, of_b[i].words});
  add_numbers(a, b, out);
  if (a.threads != b.threads)
    out.push_back({"threads", std::to_string(a.threads), std::to_string(b.threads),
                   words_of_threads(a.threads), words_of_threads(b.threads)});
  if (a.simd != b.simd)
    out.push_back({"simd", a.simd, b.simd, words_of_simd(a.simd), words_of_simd(b.simd)});
  return out;
}

std::vector<std::string> overrides_of(std::span<const WorldDifference> differences) {
  std::vector<std::string> out;
  for (const WorldDifference& d : differences)
    if (d.path.find('.') != std::string::npos) out.push_back(d.path + "=" + d.value_b);
  return out;
}

std::vector<std::string> changed_settings(const WorldSettings& a, const WorldSettings& b) {
  const auto of_a = written(a), of_b = written(b);
  std::vector<std::string> names;
  for (size_t i = 0; i < of_a.size(); ++i)
    if (of_a[i].value != of_b[i].value)
      names.push_back(of_a[i].path.substr(of_a[i].path.rfind('.') + 1));
  return names;
}

std::pair<std::string, std::string> names_by(std::span<const WorldDifference> differences) {
  constexpr size_t most = 2;
  std::string name_a, name_b;
  for (size_t i = 0; i < std::min(differences.size(), most); ++i) {
    const char* comma = i > 0 ? ", " : "";
    name_a += comma + differences[i].words_a;
    name_b += comma + differences[i].words_b;
  }
  if (differences.size() > most) {
    const std::string more = fmt::format(" and {} more", differences.size() - most);
    name_a += more;
    name_b += more;
  }
  return {name_a, name_b};
}

std::vector<std::pair<std::string, double>> numbers_of(const SceneDescription& scene) {
  std::vector<std::pair<std::string, double>> out;
  for (const auto& [name, number] : scene.parameters_.items) out.emplace_back(name, number.value);
  return out;
}

Status take_machine(std::vector<std::string>& overrides, WorldChoice& choice) {
  constexpr std::string_view threads = "threads=", simd = "simd=";
  constexpr int most_threads = 1024;
  for (const std::string& one : overrides) {
    if (one.starts_with(threads)) {
      const std::string_view value = std::string_view(one).substr(threads.size());
      const auto [end, error] =
          std::from_chars(value.data(), value.data() + value.size(), choice.threads);
      if (error != std::errc() || end != value.data() + value.size() || choice.threads < 0 ||
          choice.threads > most_threads)
        return Error{ErrorCode::invalid_argument, "threads is a whole number from 0 to 1024", one,
                     "0 takes one per core"};
    } else if (one.starts_with(simd)) {
      choice.simd = one.substr(simd.size());
      const auto known = simd_targets();
      if (std::ranges::find(known, choice.simd) == known.end())
        return Error{ErrorCode::invalid_argument, "this machine has no such instruction set", one,
                     fmt::format("it has {}", fmt::join(known, ", "))};
    }
  }
  std::erase_if(overrides, [&](const std::string& one) {
    return one.starts_with(threads) || one.starts_with(simd);
  });
  return {};
}

}  // namespace tumble
