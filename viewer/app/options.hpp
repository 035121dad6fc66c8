#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tumble {

/// An option that was declared, to say more about it; each call gives the same option back.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  const Option& required() const;
  const Option& hidden() const;         ///< not in the help
  const Option& shows_default() const;  ///< the help names the value that it has now
  const Option& one_each() const;       ///< of a list: a value follows each name, never more
  const Option& natural() const;        ///< a whole number of 0 or more
  const Option& between(int least, int greatest) const;  ///< a whole number, bounds included
  const Option& between(double least, double greatest) const;
  const Option& one_of(std::vector<std::string> names) const;
  const Option& not_empty() const;                                ///< of a text
  const Option& ends_in(std::vector<std::string> endings) const;  ///< of a file: .obj, .png ...
  const Option& needs(const Option& other) const;                 ///< is refused without the other
  const Option& excludes(const Option& other) const;              ///< is refused beside the other

 private:
  CLI::Option* option_;
};

/// The options of one command. What parses them (CLI11) is known to options.cpp and commands.cpp
/// alone: its header costs every source that reads it ten seconds of compilation.
///
/// A name such as "--steps" or "-o,--output" makes an option, one without dashes a positional
/// argument. The variable has the default and gets the value when the command line is parsed: it
/// must live as long as the command.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}

  /// T: std::string, double, int, uint64_t, an optional one of the last three, or a vector of
  /// strings, which may be given more than once.
  template <class T>
  Option value(const std::string& name, T& variable, const std::string& doc = {});
  Option flag(const std::string& name, bool& variable, const std::string& doc);
  /// With a value of its own after "=", e.g. --hash=60; "--hash{final}" says what stands for none.
  Option flag(const std::string& name, std::string& variable, const std::string& doc);
  /// What the help ends with.
  void footer(const std::string& text);

 private:
  CLI::App& app_;
};

}  // namespace tumble
