#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The name of a body with the expression in its brackets worked out for copy `i`: "link[i+1]"
/// becomes "link[4]". Errors: an expression that is none, or has no whole value.
Result<std::string> counted_name(const std::string& name, int i);

/// The definitions of a described joint in a world whose bodies exist. Errors: a body that does not
/// (a copy that is not present).
Result<std::vector<JointDef>> joint_defs(const std::string& name, const JointDescription& joint,
                                         const BuiltScene& built);

}  // namespace tumble
