// Numbers over time. References: values worked out by hand; the same course from its bytes.
#include "engine/math/time_course.hpp"

#include "tests/support/why_not.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("an expression over time, with constants, times a factor") {
  const auto course = TimeCourse::expression("a*sin(2*pi*t) + b", {{"a", 3}, {"b", 0.5}, {"c", 9}});
  REQUIRE_MESSAGE(course.ok(), test::why_not(course));
  CHECK(course->at(0) == doctest::Approx(0.5));
  CHECK(course->at(0.25) == doctest::Approx(3.5));
  CHECK(course->scaled(2).at(0.75) == doctest::Approx(-5));
  CHECK(std::isnan(TimeCourse::expression("1/(t - 1)")->at(1)));
}

TEST_CASE("a table over time: straight between its points, and still outside") {
  const auto course = TimeCourse::table({{1, 10}, {2, 30}, {4, 20}});
  REQUIRE(course.ok());
  CHECK(course->at(0) == 10);
  CHECK(course->at(1) == 10);
  CHECK(course->at(1.5) == doctest::Approx(20));
  CHECK(course->at(3) == doctest::Approx(25));
  CHECK(course->at(9) == 20);
}

TEST_CASE("courses that are none say why") {
  const auto why = [](const Result<TimeCourse>& made) { return made ? "" : made.error().message; };
  CHECK(why(TimeCourse::expression("2*u")).find("'u' is neither t nor") != std::string::npos);
  CHECK(why(TimeCourse::expression("log(t)")).find("not finite at t = 0") != std::string::npos);
  CHECK_FALSE(TimeCourse::expression("2*(").ok());
  CHECK(why(TimeCourse::table({})).find("at least one") != std::string::npos);
  CHECK(why(TimeCourse::table({{0, 1}, {0, 2}})).find("must ascend") != std::string::npos);
  CHECK(why(TimeCourse::table({{0, NAN}})).find("finite") != std::string::npos);
}

TEST_CASE("courses go through bytes, and damaged bytes give none") {
  const auto wave =
      std::make_shared<const TimeCourse>(TimeCourse::expression("k*t^2", {{"k", 1.5}})->scaled(3));
  const auto table = std::make_shared<const TimeCourse>(*TimeCourse::table({{0, 1}, {2, -1}}));
  ByteWriter out;
  for (const auto& course : {wave, table, std::shared_ptr<const TimeCourse>()})
    write_course(out, course);
  ByteReader in(out.bytes());
  const auto wave_again = read_course(in), table_again = read_course(in), none = read_course(in);
  REQUIRE(in.ok());
  CHECK_FALSE(none);
  for (const double t : {0.0, 0.3, 1.7, 8.0}) {
    CHECK(wave_again->at(t) == wave->at(t));
    CHECK(table_again->at(t) == table->at(t));
  }
  ByteReader cut(std::span(out.bytes()).first(20));
  CHECK_FALSE(read_course(cut));
  CHECK_FALSE(cut.ok());
}
