#include "engine/scene/visitors/read_values.hpp"

#include "engine/core/text.hpp"
#include "engine/math/expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

using Kind = JsonNode::Kind;

bool is_expression(const JsonNode& node) {
  return node.is(Kind::string) && !node.string.empty() &&
         (node.string[0] == '$' || node.string[0] == '=');
}

/// The number that a node stands for, or a fault.
std::optional<double> number(ReadContext& c, const JsonNode& node, const std::string& path) {
  if (node.is_number()) return node.number;
  if (!is_expression(node)) {
    c.fault(node, path, "must be a number, got " + brief(node));
    return std::nullopt;
  }
  const auto lookup = [&](std::string_view name) -> std::optional<double> {
    for (const auto& [known, value] : c.parameters)
      if (known == name) return value;
    return std::nullopt;
  };
  const auto expression = Expression::parse(std::string_view(node.string).substr(1));
  if (!expression) {
    c.fault(node, path, expression.error().message);
    return std::nullopt;
  }
  for (const std::string& name : expression->names()) {
    if (lookup(name)) continue;
    if (name == "t") {
      c.fault(node, path, "does not change with time: there is no t here");
      return std::nullopt;
    }
    std::vector<std::string> known;
    for (const auto& [parameter, value] : c.parameters) known.push_back(parameter);
    c.fault(node, path, unknown_name("parameter", name, known));
    return std::nullopt;
  }
  const auto value = expression->evaluate(lookup);
  if (!value) {
    c.fault(node, path, "'" + node.string + "': " + value.error().message);
    return std::nullopt;
  }
  return *value;
}

/// Reads `n` numbers from an array of exactly `n`.
bool numbers(ReadContext& c, const JsonNode& node, const std::string& path, double* out, size_t n) {
  if (!node.is(Kind::array) || node.items.size() != n) {
    c.fault(node, path,
            "must be an array of " + std::to_string(n) + " numbers, got " + brief(node));
    return false;
  }
  bool ok = true;
  for (size_t i = 0; i < n; ++i) {
    const auto value = number(c, node.items[i], path + "[" + std::to_string(i) + "]");
    if (value) out[i] = *value;
    ok &= value.has_value();
  }
  return ok;
}

/// A number from an expression as an integer, rounded if it is within rounding of one: 2.9999999999
/// is 3.
std::optional<double> whole(double x) {
  const double nearest = std::floor(x + 0.5);
  if (std::fabs(x - nearest) > 1e-9 * std::fmax(1, std::fabs(x))) return std::nullopt;
  return nearest;
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, double& out) {
  if (const auto value = number(c, node, path)) out = *value;
}

bool varies(const Expression& expression, const ReadContext& c) {
  const auto is_time = [](const auto& parameter) { return parameter.first == "t"; };
  return std::ranges::find(expression.names(), "t") != expression.names().end() &&
         std::ranges::none_of(c.parameters, is_time);
}

void take_course(ReadContext& c, const JsonNode& node, const std::string& path,
                 Result<TimeCourse> course, Varying& out) {
  if (!course) return c.fault(node, path, course.error().message);
  out.value = course->at(0);
  out.course = std::make_shared<const TimeCourse>(*std::move(course));
}

void read_table(ReadContext& c, const JsonNode& node, const std::string& path, Varying& out) {
  TimeCourse::Points points;
  for (size_t i = 0; i < node.items.size(); ++i) {
    double pair[2] = {};
    if (!numbers(c, node.items[i], path + "[" + std::to_string(i) + "]", pair, 2)) return;
    points.emplace_back(pair[0], pair[1]);
  }
  take_course(c, node, path, TimeCourse::table(std::move(points)), out);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, Varying& out) {
  if (node.is(Kind::array)) return read_table(c, node, path, out);
  if (is_expression(node)) {
    std::string text = node.string.substr(1);
    const auto expression = Expression::parse(text);
    if (expression && varies(*expression, c)) {
      return take_course(c, node, path, TimeCourse::expression(std::move(text), c.parameters), out);
    }
  }
  if (const auto value = number(c, node, path)) out = *value;
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, VaryingVec3& out) {
  if (!node.is(Kind::array) || node.items.size() != 3)
    return c.fault(node, path,
                   "must be an array of 3 numbers, expressions in t or tables, got " + brief(node));
  for (size_t i = 0; i < 3; ++i)
    read_leaf(c, node.items[i], path + "[" + std::to_string(i) + "]", out.of[i]);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, int& out) {
  const auto value = number(c, node, path);
  if (!value) return;
  const auto integer = whole(*value);
  if (!integer) return c.fault(node, path, "must be a whole number, got " + brief(node));
  // The validator, which works on int, cannot see values beyond its range.
  constexpr double most = std::numeric_limits<int>::max();
  if (std::fabs(*integer) > most)
    return c.fault(node, path, "must be at most 2147483647, got " + brief(node));
  out = int(*integer);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, uint64_t& out) {
  if (node.is(Kind::integer) && !node.negative) {
    out = node.magnitude;
    return;
  }
  const auto value = number(c, node, path);
  if (!value) return;
  const auto integer = whole(*value);
  if (!integer || *integer < 0 || *integer > 9007199254740992.0)
    return c.fault(node, path, "must be a whole number >= 0, got " + brief(node));
  out = uint64_t(*integer);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, bool& out) {
  if (!node.is(Kind::boolean))
    return c.fault(node, path, "must be true or false, got " + brief(node));
  out = node.boolean;
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, std::string& out) {
  if (!node.is(Kind::string)) return c.fault(node, path, "must be a string, got " + brief(node));
  out = node.string;
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, Vec3& out) {
  Vec3 value = out;
  if (numbers(c, node, path, value.data(), 3)) out = value;
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, Quat& out) {
  double value[4];
  if (numbers(c, node, path, value, 4)) out = Quat(value[0], value[1], value[2], value[3]);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path,
               std::array<int, 3>& out) {
  if (!node.is(Kind::array) || node.items.size() != 3)
    return c.fault(node, path, "must be an array of 3 whole numbers, got " + brief(node));
  for (size_t i = 0; i < 3; ++i)
    read_leaf(c, node.items[i], path + "[" + std::to_string(i) + "]", out[i]);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, Colour& out) {
  if (node.is(Kind::array)) {
    double value[3];
    if (numbers(c, node, path, value, 3)) out = {value[0], value[1], value[2]};
    return;
  }
  if (!node.is(Kind::string))
    return c.fault(node, path,
                   "must be [r, g, b], \"#rrggbb\" or the name of a colour, got " + brief(node));
  if (const auto colour = colour_from_text(node.string)) {
    out = *colour;
    return;
  }
  if (node.string.starts_with('#'))
    return c.fault(node, path, "must be \"#rrggbb\", got " + brief(node));
  c.fault(node, path, unknown_name("colour", node.string, palette_names()));
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, TickRate& out) {
  if (node.is(Kind::string) && !is_expression(node)) {
    TickRate rate;
    const char* end = node.string.data() + node.string.size();
    const auto [slash, bad] = std::from_chars(node.string.data(), end, rate.num);
    if (bad == std::errc{} && slash != end && *slash == '/') {
      const auto [stop, bad_den] = std::from_chars(slash + 1, end, rate.den);
      if (bad_den == std::errc{} && stop == end && rate.num > 0 && rate.den > 0) {
        out = rate;
        return;
      }
    }
    return c.fault(node, path, "must be a whole number or \"n/d\", got " + brief(node));
  }
  int hertz = 0;
  const bool had_faults = c.faults.covers(path);
  read_leaf(c, node, path, hertz);
  if (!had_faults && c.faults.covers(path)) return;
  if (hertz < 1) return c.fault(node, path, "must be >= 1 Hz, got " + brief(node));
  out = {hertz, 1};
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path, const EnumRef& out) {
  if (const auto i = read_name(c, node, path, "value", out.type->names))
    out.type->set(out.value, *i);
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path,
               const OptionalLeafRef& out) {
  read_value(c, node, path, out.type->emplace(out.option));
}

void read_leaf(ReadContext& c, const JsonNode& node, const std::string& path,
               const LeafListRef& out) {
  if (!node.is(Kind::array)) return c.fault(node, path, "must be an array, got " + brief(node));
  out.type->clear(out.list);
  for (size_t i = 0; i < node.items.size(); ++i)
    read_value(c, node.items[i], path + "[" + std::to_string(i) + "]", out.type->append(out.list));
}

}  // namespace

void ReadContext::fault(const JsonNode& node, std::string path, std::string message) {
  faults.add({node.line > 0 ? file : "--set", node.line, std::move(path), std::move(message)});
}

void read_value(ReadContext& c, const JsonNode& node, const std::string& path, const Leaf& out) {
  std::visit(
      [&](auto value) {
        if constexpr (std::is_pointer_v<decltype(value)>)
          read_leaf(c, node, path, *value);
        else
          read_leaf(c, node, path, value);
      },
      static_cast<const Leaf::variant&>(out));
}

std::optional<size_t> read_name(ReadContext& c, const JsonNode& node, const std::string& path,
                                std::string_view what, const std::vector<std::string>& names) {
  if (!node.is(Kind::string)) {
    c.fault(node, path, "must be a string, got " + brief(node));
    return std::nullopt;
  }
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == node.string) return i;
  c.fault(node, path, unknown_name(what, node.string, names));
  return std::nullopt;
}

}  // namespace tumble
