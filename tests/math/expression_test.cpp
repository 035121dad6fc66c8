// Expressions against values worked out by hand (C++'s own arithmetic on the same numbers), and
// messages against the column counted in the text.
#include "engine/math/expression.hpp"

#include <cmath>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::optional<double> named(std::string_view name) {
  if (name == "time") return 2;
  if (name == "bodies.ball.position.y") return -3;
  if (name == "bodies.brick[12].mass") return 7;
  return std::nullopt;
}

double value(std::string_view text) {
  const auto result = evaluate(text, named);
  INFO(text << (result ? "" : result.error().message));
  REQUIRE(result.ok());
  return *result;
}

std::string message(std::string_view text) {
  const auto result = evaluate(text, named);
  INFO(text);
  REQUIRE_FALSE(result.ok());
  return result.error().message;
}

}  // namespace

TEST_CASE("precedence and association") {
  CHECK(value("1 + 2 * 3") == 7);
  CHECK(value("(1 + 2) * 3") == 9);
  CHECK(value("10 - 4 - 3") == 3);
  CHECK(value("100 / 5 / 2") == 10);
  CHECK(value("-2 ^ 2") == -4);
  CHECK(value("2 ^ 3 ^ 2") == doctest::Approx(512).epsilon(1e-14));
  CHECK(value("2 ^ -1") == 0.5);
  CHECK(value("7 % 3") == 1);
  CHECK(value("-7 % 3") == 2);
  CHECK(value("--3") == 3);
  CHECK(value(".5e1") == 5);
}

TEST_CASE("comparisons and logic give 1 or 0") {
  CHECK(value("1 < 2") == 1);
  CHECK(value("1 + 1 == 2 && 3 >= 4 || 5 != 5") == 0);
  CHECK(value("0 || 2") == 1);
  CHECK(value("!0 && !(1 > 2)") == 1);
  CHECK(value("abs(bodies.ball.position.y - 1) < 4.5") == 1);
  CHECK(value("2 <= 2") == 1);
}

TEST_CASE("a condition is made of comparisons alone") {
  const auto condition = [](const char* text) { return Expression::parse(text)->is_condition(); };
  for (const char* yes : {"a < 1", "!(a < 1)", "a < 1 && b > 2", "a == b || !(a > 3) && b < 1",
                          "(a < 1) == (b < 1)", "abs(a) <= max(1, b)"})
    CHECK_MESSAGE(condition(yes), yes);
  for (const char* no : {"a", "!a", "a < 1 && 3", "b || a < 1", "(a < 1) + 1", "-(a < 1)",
                         "abs(a < 1)", "!(a && b)", "a < 1 && !b"})
    CHECK_MESSAGE(!condition(no), no);
}

TEST_CASE("functions") {
  CHECK(value("max(min(3, 5), time)") == 3);
  CHECK(value("sqrt(16) + floor(2.7) + ceil(2.1) + round(2.5)") == 12);
  CHECK(value("sin(pi / 6)") == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(value("cos_deg(60)") == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(value("tan_deg(45)") == doctest::Approx(1).epsilon(1e-14));
  CHECK(value("atan2(1, -1)") == doctest::Approx(std::atan2(1, -1)).epsilon(1e-14));
  CHECK(value("exp(log(7)) + pow(2, 10)") == doctest::Approx(1031).epsilon(1e-14));
}

TEST_CASE("operands that wait in any number of nested brackets") {
  // 1 + (2 - (3 + (4 - ... (n)))): from inside out, by C++'s own arithmetic.
  for (const int n : {2, 31, 32, 33, 34, 60, 90}) {
    CAPTURE(n);
    std::string text;
    for (int i = 1; i < n; ++i) text += std::to_string(i) + (i % 2 == 1 ? " + (" : " - (");
    text += std::to_string(n) + std::string(size_t(n - 1), ')');
    double sum = n;
    for (int i = n - 1; i >= 1; --i) sum = i % 2 == 1 ? i + sum : i - sum;
    CHECK(value(text) == sum);
  }
}

TEST_CASE("names") {
  CHECK(value("bodies.brick[12].mass * time") == 14);
  const auto parsed = Expression::parse("a + b.c * a");
  REQUIRE(parsed.ok());
  CHECK(parsed->names() == std::vector<std::string>{"a", "b.c"});
}

TEST_CASE("errors say where and what") {
  CHECK(message("").find("column 1: expected a value, found the end") != std::string::npos);
  CHECK(message("1 +").find("column 4: expected a value") != std::string::npos);
  CHECK(message("(1").find("expected ')'") != std::string::npos);
  CHECK(message("1 2").find("column 3: expected an operator or the end, found '2'") !=
        std::string::npos);
  CHECK(message("1 = 2").find("expected an operator") != std::string::npos);
  CHECK(message("sinn(1)").find("did you mean 'sin'?") != std::string::npos);
  CHECK(message("min(1)").find("expected ','") != std::string::npos);
  CHECK(message("a[x]").find("expected an index") != std::string::npos);
  CHECK(message("speed > 1") == "unknown name 'speed'");
  CHECK(message("1 / 0").find("no finite value") != std::string::npos);
  CHECK(message("sqrt(-1)").find("no finite value") != std::string::npos);
  CHECK(message(std::string(5000, '(')).find("4096") != std::string::npos);
  CHECK(message(std::string(4000, '(')).find("nested") != std::string::npos);
  CHECK(message(std::string(4000, '-')).find("nested") != std::string::npos);
  CHECK(message("1e999").find("expected a number") != std::string::npos);
}
