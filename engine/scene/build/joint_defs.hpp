#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The definitions of a described joint in a world whose bodies exist. Errors: a body that does not
/// (a copy that is not present).
Result<std::vector<JointDef>> joint_defs(const std::string& name, const JointDescription& joint,
                                         const BuiltScene& built);

/// Those of its copies whose coordinates follow others, with what they follow; all joints of the
/// scene exist. Errors: no such joint or coordinate.
Result<std::vector<std::pair<JointId, JointDef>>> couple_joints(const std::string& name,
                                                                const JointDescription& joint,
                                                                const BuiltScene& built);

}  // namespace tumble
