// Numbers of dynamics, of the world and of the solvers of complementarity stand with their reasons
// in the tolerances.hpp of their room. Reference: the text of every other file there; what is
// written with an exponent, or as a named floating-point constant, is a tolerance.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <utility>

#include <doctest/doctest.h>

namespace fs = std::filesystem;

TEST_CASE("numbers of dynamics, lcp and world have their reasons in tolerances.hpp") {
  const std::regex comment("//.*"), text("\"[^\"]*\"");
  const std::regex with_exponent("\\b[0-9]+\\.?[0-9]*e-?[0-9]+");
  const std::regex named("constexpr (double|float) \\w+ = -?[0-9.]+f?;");
  // A constant, a unit, the default of a value that scenes give.
  const std::regex unit("constexpr double (pi|second|percent|default_\\w+) = .*");
  // A member that callers or scenes set, with what it means beside its default.
  const std::regex option("\\s+(double|Varying) \\w+ = [^;]+;\\s+///<.*");
  const std::regex settings(".*_settings\\.[ch]pp");
  int files = 0;
  for (const char* room :
       {"dynamics/bodies", "dynamics/particles", "dynamics/forces", "dynamics/rows",
        "dynamics/joints", "dynamics/contact", "dynamics/islands", "dynamics/realtime",
        "dynamics/grains", "dynamics/event", "math/lcp", "world"}) {
    const fs::path folder = fs::path(TUMBLE_SOURCE_DIR) / "engine" / room;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string name = entry.path().filename();
      const std::string extension = entry.path().extension();
      if (name == "tolerances.hpp" || std::regex_match(name, settings)) continue;
      if (extension != ".hpp" && extension != ".cpp") continue;
      ++files;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number) {
        const std::string code =
            std::regex_replace(std::regex_replace(line, comment, ""), text, "");
        if (std::regex_search(code, unit) || std::regex_match(line, option)) continue;
        const bool bare = std::regex_search(code, with_exponent) || std::regex_search(code, named);
        CHECK_MESSAGE(!bare, entry.path().string(), ":", number, ": ", line);
      }
    }
  }
  CHECK(files > 100);
}

// Inline constants of one name in one namespace are one constant to the linker, whatever their
// values.
TEST_CASE("a name in tolerances.hpp has one value in its namespace") {
  const std::regex comment("//.*"), space("^namespace ([\\w:]+) \\{");
  const std::regex constant("(\\w+)(?:\\[\\])? = ([^,;]+)[,;]");
  std::map<std::string, std::pair<std::string, std::string>> seen;  // name: value, file
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(TUMBLE_SOURCE_DIR) / "engine")) {
    if (entry.path().filename() != "tolerances.hpp") continue;
    std::ifstream in(entry.path());
    std::string line, scope;
    while (std::getline(in, line)) {
      const std::string code = std::regex_replace(line, comment, "");
      std::smatch m;
      if (std::regex_search(code, m, space)) scope = m[1];
      for (std::sregex_iterator it(code.begin(), code.end(), constant), end; it != end; ++it) {
        const std::string name = scope + "::" + (*it)[1].str(), value = (*it)[2];
        const auto& first = seen.try_emplace(name, value, entry.path().string()).first->second;
        CHECK_MESSAGE(first.first == value, name, " is ", first.first, " in ", first.second,
                      " and ", value, " in ", entry.path().string());
      }
    }
  }
  CHECK(seen.size() > 200);
}
