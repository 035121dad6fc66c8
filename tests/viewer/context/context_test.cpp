// Contexts without a display. Reference: what EGL and OSMesa of this machine report.
#include "tests/support/why_not.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"

#include <cctype>
#include <string>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("every offscreen backend gives a current context of 3.3 or later") {
  for (const char* name : {"auto", "egl", "egl:0", "surfaceless", "osmesa"}) {
    CAPTURE(name);
    auto choice = create_context(name);
    REQUIRE_MESSAGE(choice.ok(), test::why_not(choice));
    const ContextInfo& info = choice->context->info();
    CHECK_FALSE(info.renderer.empty());
    CHECK(info.version.substr(0, 1) >= "3");
    CHECK(choice->attempts.back().ok);
    CHECK(choice->attempts.back().name == info.name);
    CHECK(bool(choice->context->get_proc_address("glDrawArraysInstanced")));
    CHECK(make_gl_device(*choice->context).ok());
  }
}

TEST_CASE("auto prefers EGL, and says what it chose") {
  std::string said;
  auto choice = create_context("auto", [&](LogLevel, std::string_view s) { said += s; });
  REQUIRE(choice.ok());
  CHECK(contains(choice->context->info().name, "egl:"));
  CHECK(contains(said, choice->context->info().renderer.c_str()));
}

TEST_CASE("names that mean nothing are refused with what is known") {
  for (const char* name : {"", "vulkan", "egl:"}) {
    CAPTURE(name);
    auto choice = create_context(name);
    REQUIRE_FALSE(choice.ok());
    CHECK(choice.error().code == ErrorCode::invalid_argument);
    CHECK(contains(choice.error().text(), "surfaceless"));
  }
  auto beyond = create_context("egl:999");
  REQUIRE_FALSE(beyond.ok());
  CHECK(contains(beyond.error().message, "EGL devices"));
}

TEST_CASE("an EGL device is found by part of its name, in any case") {
  const auto first = create_context("egl:0");
  REQUIRE(first.ok());
  const std::string renderer = first->context->info().renderer;
  std::string part = renderer.substr(0, renderer.find(' '));
  for (char& c : part) c = char(std::toupper(c));
  const auto found = create_context("egl:" + part);
  REQUIRE_MESSAGE(found.ok(), test::why_not(found));
  CHECK(found->context->info().name == "egl:0");
  CHECK(found->attempts.back().name == "egl:0");
  for (const char* name : {"egl:no such card", "egl:0x", "egl:-1"}) {
    CAPTURE(name);
    const auto none = create_context(name);
    REQUIRE_FALSE(none.ok());
    CHECK(none.error().code == ErrorCode::invalid_argument);
    CHECK(contains(none.error().text(), renderer.c_str()));  // what there is
  }
}

TEST_CASE("contexts come and go thirty times") {
  for (const char* name : {"egl:0", "osmesa"})
    for (int round = 0; round < 30; ++round) {
      auto choice = create_context(name);
      REQUIRE(choice.ok());
      auto device = make_gl_device(*choice->context);
      REQUIRE(device.ok());
      CHECK((*device)->take_faults().empty());
    }
}

TEST_CASE("a context moves to another thread") {
  auto choice = create_context("auto");
  REQUIRE(choice.ok());
  choice->context->release();
  bool made = false, clean = false;
  std::thread([&] {
    if (!choice->context->make_current()) return;
    auto device = make_gl_device(*choice->context);
    made = device.ok();
    clean = made && (*device)->take_faults().empty();
    choice->context->release();
  }).join();
  CHECK(made);
  CHECK(clean);
  CHECK(choice->context->make_current().ok());
}
