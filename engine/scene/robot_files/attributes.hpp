#pragma once
#include "engine/math/types.hpp"
#include "engine/scene/description/values.hpp"
#include "engine/scene/robot_files/xml_file.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// The attributes of an element during reading: attributes that were not read are reported at the
/// end, so that nothing of a file is dropped silently.
class Attributes {
 public:
  Attributes(const XmlElement& element, RobotLog& log);
  ~Attributes();
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  struct Value {
    std::string text;
    RobotPlace at;
  };
  /// The value of an attribute that the element itself does not have.
  void set_default(const std::string& name, const Value& value);

  const RobotPlace& at() const { return at_; }
  bool has(std::string_view name) const { return values_.find(name) != values_.end(); }

  // Each leaves `out` as it is when the attribute is not there, or after a fault.
  void read(std::string_view name, double& out);
  void read(std::string_view name, std::optional<double>& out);
  void read(std::string_view name, Vec3& out);
  void read(std::string_view name, std::string& out);
  /// "true" or "false"; others are a fault.
  void read(std::string_view name, bool& out);
  /// A required name.
  std::string name_of(std::string_view name);
  std::optional<std::string> text(std::string_view name);
  /// Between `least` and `most` numbers; empty when it is not there, or after a fault.
  std::vector<double> numbers(std::string_view name, size_t least, size_t most);
  /// One of some words; the first when it is not there, or after a fault.
  size_t word(std::string_view name, std::initializer_list<std::string_view> words);
  std::optional<Colour> rgba(std::string_view name, double* alpha = nullptr);

  /// Attributes that are known, but irrelevant here.
  void skip(std::initializer_list<std::string_view> names);
  /// Warns that these attributes, if given, are not supported.
  void warn_of(std::initializer_list<std::string_view> names, const std::string& why);
  void fault(std::string_view name, const std::string& message);

 private:
  const Value* take(std::string_view name);

  std::string element_;
  RobotPlace at_;
  RobotLog& log_;
  std::map<std::string, Value, std::less<>> values_;
  std::map<std::string, bool, std::less<>> used_;
};

}  // namespace tumble
