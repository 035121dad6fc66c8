#include "engine/math/expression.hpp"

#include "engine/core/text.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

struct Function {
  std::string_view name;
  int arguments;
  double (*call)(double a, double b);
};

double radians(double degrees) {
  return degrees * (det::pi / 180);
}

constexpr std::array functions = {
    Function{"abs", 1, [](double a, double) { return std::fabs(a); }},
    Function{"sqrt", 1, [](double a, double) { return std::sqrt(a); }},
    Function{"floor", 1, [](double a, double) { return std::floor(a); }},
    Function{"ceil", 1, [](double a, double) { return std::ceil(a); }},
    Function{"round", 1, [](double a, double) { return std::floor(a + 0.5); }},
    Function{"sin", 1, [](double a, double) { return det::sin(a); }},
    Function{"cos", 1, [](double a, double) { return det::cos(a); }},
    Function{"tan", 1, [](double a, double) { return det::sin(a) / det::cos(a); }},
    Function{"asin", 1, [](double a, double) { return det::asin(a); }},
    Function{"acos", 1, [](double a, double) { return det::acos(a); }},
    Function{"atan", 1, [](double a, double) { return det::atan(a); }},
    Function{"exp", 1, [](double a, double) { return det::exp(a); }},
    Function{"log", 1, [](double a, double) { return det::log(a); }},
    Function{"sin_deg", 1, [](double a, double) { return det::sin(radians(a)); }},
    Function{"cos_deg", 1, [](double a, double) { return det::cos(radians(a)); }},
    Function{"tan_deg", 1,
             [](double a, double) { return det::sin(radians(a)) / det::cos(radians(a)); }},
    Function{"min", 2, [](double a, double b) { return std::min(a, b); }},
    Function{"max", 2, [](double a, double b) { return std::max(a, b); }},
    Function{"pow", 2, [](double a, double b) { return det::pow(a, b); }},
    Function{"atan2", 2, [](double a, double b) { return det::atan2(a, b); }},
};

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

/// Recursive descent, lowest precedence first: || && comparison + * unary ^.
class ExpressionParser {
 public:
  explicit ExpressionParser(std::string_view text) : text_(text) {}

  Result<Expression> run() {
    if (text_.size() > 4096)
      return Error{ErrorCode::parse, "an expression of more than 4096 characters", {}, {}};
    logical_or();
    skip_space();
    if (!failed_ && at_ < text_.size()) fail("an operator or the end");
    if (failed_) return error_;
    return std::move(out_);
  }

 private:
  using Op = Expression::Op;

  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool accept(std::string_view token) {
    skip_space();
    if (failed_ || !text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void fail(std::string_view expected) {
    if (failed_) return;
    failed_ = true;
    skip_space();
    const std::string found =
        at_ < text_.size() ? "'" + std::string(text_.substr(at_, 12)) + "'" : "the end";
    error_ = {ErrorCode::parse,
              fmt::format("in expression '{}': column {}: expected {}, found {}",
                          text_.substr(0, 200), at_ + 1, expected, found),
              {},
              {}};
  }
  void emit(Op op, uint32_t index = 0, double value = 0) {
    out_.steps_.push_back({op, index, value});
  }

  void logical_or() {
    logical_and();
    while (accept("||")) logical_and(), emit(Op::logical_or);
  }
  void logical_and() {
    comparison();
    while (accept("&&")) comparison(), emit(Op::logical_and);
  }
  void comparison() {
    sum();
    if (accept("<="))
      sum(), emit(Op::less_equal);
    else if (accept(">="))
      sum(), emit(Op::greater_equal);
    else if (accept("=="))
      sum(), emit(Op::equal);
    else if (accept("!="))
      sum(), emit(Op::not_equal);
    else if (accept("<"))
      sum(), emit(Op::less);
    else if (accept(">"))
      sum(), emit(Op::greater);
  }
  void sum() {
    product();
    for (;;) {
      if (accept("+"))
        product(), emit(Op::add);
      else if (accept("-"))
        product(), emit(Op::subtract);
      else
        return;
    }
  }
  void product() {
    unary();
    for (;;) {
      if (accept("*"))
        unary(), emit(Op::multiply);
      else if (accept("/"))
        unary(), emit(Op::divide);
      else if (accept("%"))
        unary(), emit(Op::modulo);
      else
        return;
    }
  }
  void unary() {
    if (++depth_ > 100) return fail("fewer than 100 nested brackets and signs");
    if (accept("-")) {
      unary();
      emit(Op::negate);
    } else if (accept("!")) {
      unary();
      emit(Op::logical_not);
    } else {
      primary();
      if (accept("^")) unary(), emit(Op::power);
    }
    --depth_;
  }
  void primary() {
    skip_space();
    if (failed_) return;
    if (at_ >= text_.size()) return fail("a value");
    const char c = text_[at_];
    if (is_digit(c) || c == '.') return number();
    if (is_name_start(c)) return name();
    if (accept("(")) {
      logical_or();
      if (!accept(")")) fail("')'");
      return;
    }
    fail("a value");
  }
  void number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [end, status] = std::from_chars(first, text_.data() + text_.size(), value);
    if (status != std::errc{}) return fail("a number");
    at_ += size_t(end - first);
    emit(Op::number, 0, value);
  }
  /// name, name.name, name[3].name; a bracket after a function's name makes it a call.
  void name() {
    const size_t start = at_;
    for (;;) {
      while (at_ < text_.size() && (is_name_start(text_[at_]) || is_digit(text_[at_]))) ++at_;
      while (at_ < text_.size() && text_[at_] == '[') {
        size_t end = at_ + 1;
        while (end < text_.size() && is_digit(text_[end])) ++end;
        if (end == at_ + 1 || end >= text_.size() || text_[end] != ']') {
          ++at_;
          return fail("an index and ']'");
        }
        at_ = end + 1;
      }
      if (at_ + 1 < text_.size() && text_[at_] == '.' && is_name_start(text_[at_ + 1]))
        ++at_;
      else
        break;
    }
    const std::string_view word = text_.substr(start, at_ - start);
    if (word == "pi") return emit(Op::number, 0, det::pi);
    if (accept("(")) return call(word, start);
    const auto it = std::find(out_.names_.begin(), out_.names_.end(), word);
    const auto index = uint32_t(it - out_.names_.begin());
    if (it == out_.names_.end()) out_.names_.emplace_back(word);
    emit(Op::name, index);
  }
  void call(std::string_view word, size_t start) {
    const auto* f = std::find_if(functions.begin(), functions.end(),
                                 [&](const Function& g) { return g.name == word; });
    if (f == functions.end()) {
      at_ = start;
      std::vector<std::string> known;
      for (const Function& g : functions) known.emplace_back(g.name);
      return fail("a function (" + unknown_name("function", word, known) + ")");
    }
    for (int i = 0; i < f->arguments; ++i) {
      if (i > 0 && !accept(",")) return fail("','");
      logical_or();
    }
    if (!accept(")")) return fail("')'");
    emit(Op::call, uint32_t(f - functions.begin()));
  }

  std::string_view text_;
  size_t at_ = 0;
  int depth_ = 0;
  bool failed_ = false;
  Error error_;
  Expression out_;
};

namespace {

double binary(Expression::Op op, double a, double b) {
  using Op = Expression::Op;
  switch (op) {
    case Op::add:
      return a + b;
    case Op::subtract:
      return a - b;
    case Op::multiply:
      return a * b;
    case Op::divide:
      return a / b;
    case Op::modulo:
      return a - b * std::floor(a / b);
    case Op::power:
      return det::pow(a, b);
    case Op::less:
      return a < b ? 1 : 0;
    case Op::less_equal:
      return a <= b ? 1 : 0;
    case Op::greater:
      return a > b ? 1 : 0;
    case Op::greater_equal:
      return a >= b ? 1 : 0;
    case Op::equal:
      return a == b ? 1 : 0;
    case Op::not_equal:
      return a != b ? 1 : 0;
    case Op::logical_and:
      return a != 0 && b != 0 ? 1 : 0;
    case Op::logical_or:
      return a != 0 || b != 0 ? 1 : 0;
    default:
      return 0;
  }
}

}  // namespace

Result<Expression> Expression::parse(std::string_view text) {
  return ExpressionParser(text).run();
}

bool Expression::is_condition() const {
  // What each value on the stack is, and whether all that !, && and || join are conditions.
  std::vector<bool> conditions;
  bool joins_conditions = true;
  const auto take = [&conditions] {
    const bool out = conditions.back();
    conditions.pop_back();
    return out;
  };
  for (const Step& s : steps_) {
    if (s.op == Op::number || s.op == Op::name) {
      conditions.push_back(false);
    } else if (s.op == Op::negate || (s.op == Op::call && functions[s.index].arguments == 1)) {
      conditions.back() = false;
    } else if (s.op == Op::logical_not) {
      joins_conditions = joins_conditions && conditions.back();
    } else {
      const bool b = take(), a = take();
      const bool logical = s.op == Op::logical_and || s.op == Op::logical_or;
      if (logical) joins_conditions = joins_conditions && a && b;
      conditions.push_back(logical || (s.op >= Op::less && s.op < Op::logical_and));
    }
  }
  return joins_conditions && conditions.size() == 1 && conditions.back();
}

namespace {

/// The operands that wait for their operation. Few expressions have more than a handful, and those
/// that courses evaluate in each tick take nothing from the heap.
class OperandStack {
 public:
  size_t size() const { return size_; }
  double& back() { return size_ <= few ? first_[size_ - 1] : rest_.back(); }
  void push(double value) {
    if (size_ < few)
      first_[size_] = value;
    else
      rest_.push_back(value);
    ++size_;
  }
  double pop() {
    const double value = back();
    if (size_ > few) rest_.pop_back();
    --size_;
    return value;
  }

 private:
  static constexpr size_t few = 32;
  std::array<double, few> first_;
  std::vector<double> rest_;
  size_t size_ = 0;
};

}  // namespace

Result<double> Expression::evaluate(const NameLookup& names) const {
  OperandStack stack;
  for (const Step& s : steps_) {
    if (s.op == Op::number) {
      stack.push(s.value);
    } else if (s.op == Op::name) {
      const auto value = names ? names(names_[s.index]) : std::nullopt;
      if (!value)
        return Error{ErrorCode::not_found, "unknown name '" + names_[s.index] + "'", {}, {}};
      stack.push(*value);
    } else if (s.op == Op::negate) {
      stack.back() = -stack.back();
    } else if (s.op == Op::logical_not) {
      stack.back() = stack.back() == 0 ? 1 : 0;
    } else if (s.op == Op::call && functions[s.index].arguments == 1) {
      stack.back() = functions[s.index].call(stack.back(), 0);
    } else {
      const double b = stack.pop();
      stack.back() = s.op == Op::call ? functions[s.index].call(stack.back(), b)
                                      : binary(s.op, stack.back(), b);
    }
  }
  if (stack.size() != 1 || !std::isfinite(stack.back()))
    return Error{ErrorCode::numeric, "the expression has no finite value", {}, {}};
  return stack.back();
}

Result<double> evaluate(std::string_view text, const NameLookup& names) {
  const auto parsed = Expression::parse(text);
  if (!parsed) return parsed.error();
  return parsed->evaluate(names);
}

}  // namespace tumble
