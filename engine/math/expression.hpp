#pragma once
#include "engine/core/result.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Value of a named quantity, or empty if there is no such name.
using NameLookup = std::function<std::optional<double>(std::string_view)>;

/// An arithmetic expression over named quantities: numbers, names such as `time` or
/// `bodies.brick[3].position.y`, + - * / % ^, comparisons, && || !, brackets, `pi`, and the
/// functions abs sqrt floor ceil round sin cos tan asin acos atan exp log (one argument, radians),
/// min max pow atan2 (two), sin_deg cos_deg tan_deg. Comparisons give 1 or 0; what is not 0 is
/// true. The same bits on every machine (math/det).
class Expression {
 public:
  /// Errors give the column and what was expected there.
  static Result<Expression> parse(std::string_view text);
  /// Errors: an unknown name, a result that is not finite.
  Result<double> evaluate(const NameLookup& names) const;
  /// Whether its value is a truth value: a comparison, or a logical combination.
  bool is_condition() const;
  /// Every name that occurs, each once.
  const std::vector<std::string>& names() const { return names_; }

  enum class Op : uint8_t {
    number,
    name,
    negate,
    logical_not,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    power,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
    logical_and,
    logical_or,
    call,
  };
  /// Postfix instruction.
  struct Step {
    Op op;
    uint32_t index = 0;  ///< into names, or the function
    double value = 0;
  };

 private:
  friend class ExpressionParser;
  std::vector<Step> steps_;
  std::vector<std::string> names_;
};

/// Parses and evaluates at once.
Result<double> evaluate(std::string_view text, const NameLookup& names);

}  // namespace tumble
