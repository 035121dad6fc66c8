// Reference: exact fractions worked out by hand, and 10,000 frames against long double.
#include "viewer/capture/frame_clock.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("frames of 30 and 60 per second are exact ticks of a 60 Hz world") {
  CHECK(frame_time(0, {30, 1}, {60, 1}).tick == 0);
  CHECK(frame_time(7, {30, 1}, {60, 1}).tick == 14);
  CHECK(frame_time(7, {30, 1}, {60, 1}).exact());
  CHECK(frame_time(7, {60, 1}, {60, 1}).last_tick() == 7);
}

TEST_CASE("a frame between two ticks knows its place exactly") {
  // 25 fps in a 60 Hz world: frame k at tick 12 k / 5.
  const FrameTime t = frame_time(3, {25, 1}, {60, 1});
  CHECK(t.tick == 7);
  CHECK(t.rest_num == 1);
  CHECK(t.rest_den == 5);
  CHECK(t.last_tick() == 8);
  CHECK_FALSE(t.exact());
}

TEST_CASE("television rate never drifts") {
  const Fraction fps{30000, 1001};
  for (uint64_t k = 0; k < 10000; ++k) {
    const FrameTime t = frame_time(k, fps, {60, 1});
    const long double position = (long double)k * 1001.0L * 60.0L / 30000.0L;
    CHECK(std::abs((long double)t.tick + (long double)t.s() - position) < 1e-9L * (1 + position));
    CHECK(t.s() >= 0);
    CHECK(t.s() < 1);
  }
  // After 1001 * 500 frames exactly 1002001.0/... : frame 30000 n is at 1001 n seconds.
  CHECK(frame_time(30000, fps, {60, 1}).tick == 60060);
  CHECK(frame_time(30000, fps, {60, 1}).exact());
}

TEST_CASE("the farthest frame does not overflow") {
  const FrameTime t = frame_time(1'000'000'000'000ull, {1, 1}, {100000, 1});
  CHECK(t.tick == 100'000'000'000'000'000ull);
}

TEST_CASE("frames until a tick are those that counting one by one finds") {
  for (const Fraction fps : {Fraction{30, 1}, {60, 1}, {25, 1}, {30000, 1001}, {1000, 7}, {1, 3}})
    for (const TickRate rate : {TickRate{60, 1}, {240, 1}, {1000, 3}})
      for (const uint64_t tick : {0u, 1u, 2u, 59u, 60u, 1001u}) {
        uint64_t counted = 0;
        while (frame_time(counted, fps, rate).last_tick() <= tick) ++counted;
        CHECK(frames_until(tick, fps, rate) == counted);
      }
  CHECK(frames_until(60, {greatest_term, 1}, {60, 1}) == uint64_t(greatest_term) + 1);
  CHECK(frames_until(~uint64_t{0}, {greatest_term, 1}, {1, greatest_term}) == (~uint64_t{0} >> 1));
}

TEST_CASE("counts round half up") {
  CHECK(frame_count({2, 1}, {30, 1}) == 60);
  CHECK(frame_count({1, 60}, {30, 1}) == 1);
  CHECK(frame_count({1, 61}, {30, 1}) == 0);
  CHECK(frame_count({5, 2}, {25, 1}) == 63);
  CHECK(tick_count({1, 2}, {60, 1}) == 30);
}

TEST_CASE("numbers are read as fractions, exactly") {
  CHECK(*parse_fraction("30", "--fps") == Fraction{30, 1});
  CHECK(*parse_fraction("2.5", "--fps") == Fraction{5, 2});
  CHECK(*parse_fraction("0.1", "--fps") == Fraction{1, 10});
  CHECK(*parse_fraction(".5", "--fps") == Fraction{1, 2});
  CHECK(*parse_fraction("30000/1001", "--fps") == Fraction{30000, 1001});
  CHECK(*parse_fraction("0", "--seconds", true) == Fraction{0, 1});
  CHECK(*parse_fraction("1e3", "--fps") == Fraction{1000, 1});
  CHECK(*parse_fraction("2.5e-3", "--fps") == Fraction{1, 400});
  CHECK(*parse_fraction("1.25E+1", "--fps") == Fraction{25, 2});
  CHECK(*parse_fraction("3e1/1.001", "--fps") == Fraction{30000, 1001});
  CHECK(*parse_fraction("0e99", "--seconds", true) == Fraction{0, 1});
  for (const char* bad : {"",      "-1",          "0",
                          "abc",   "1e",          "e3",
                          "1e+-3", "1e1.5",       "1e13",
                          "1e-13", "1e999999999", "1e99999999999",
                          "1e3e3", "1/0",         "1.2.3",
                          "nan",   "inf",         ".",
                          "1/",    "/2",          "99999999999999999999",
                          " 1"})
    CHECK_MESSAGE(!parse_fraction(bad, "--fps").ok(), bad);
  const auto fine = parse_fraction("31.622776601683793", "--fps");
  REQUIRE_FALSE(fine.ok());
  CHECK(fine.error().text().find("12 digits") != std::string::npos);
}
