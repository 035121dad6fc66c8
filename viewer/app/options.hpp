#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tumble {

/// Handle to a declared option for adding constraints; each call returns the same option.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  const Option& required() const;
  const Option& hidden() const;         ///< not listed in the help
  const Option& shows_default() const;  ///< the help states its present value as the default
  /// Of a list: each occurrence of the name takes exactly one value.
  const Option& one_each() const;
  const Option& natural() const;                         ///< a whole number of 0 or more
  const Option& between(int least, int greatest) const;  ///< a whole number, bounds included
  const Option& between(double least, double greatest) const;
  const Option& one_of(std::vector<std::string> names) const;
  const Option& not_empty() const;  ///< rejects an empty text
  /// File name must have one of these endings: .obj, .png ...
  const Option& ends_in(std::vector<std::string> endings) const;
  const Option& needs(const Option& other) const;     ///< rejected without the other
  const Option& excludes(const Option& other) const;  ///< rejected together with the other

 private:
  CLI::Option* option_;
};

/// The options of one command. Only options.cpp and commands.cpp include the parser (CLI11), whose
/// header adds ten seconds to the compilation of every source.
///
/// A name such as "--steps" or "-o,--output" declares an option, one without dashes a positional
/// argument. The variable holds the default and gets the value when the command line is parsed: it
/// must live as long as the command.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}

  /// T: std::string, double, int, uint64_t, std::optional of one of the last three, or a vector of
  /// strings (for an option that may be repeated).
  template <class T>
  Option value(const std::string& name, T& variable, const std::string& doc = {});
  Option flag(const std::string& name, bool& variable, const std::string& doc);
  /// A flag that may have a value after "=", e.g. --hash=60; "--hash{final}" declares the value
  /// used without one.
  Option flag(const std::string& name, std::string& variable, const std::string& doc);
  /// Text at the end of the help.
  void footer(const std::string& text);

 private:
  CLI::App& app_;
};

}  // namespace tumble
