#pragma once
#include "engine/scene/build.hpp"

namespace tumble {

/// The definitions of a described joint in a world whose bodies exist. Errors: a body that does not
/// exist (a copy that is not present).
Result<std::vector<JointDef>> joint_defs(const std::string& name, const JointDescription& joint,
                                         const BuiltScene& built);

/// The definitions, with couplings, of those copies whose coordinates follow others, when all
/// joints of the scene exist. Errors: no such joint or coordinate.
Result<std::vector<std::pair<JointId, JointDef>>> couple_joints(const std::string& name,
                                                                const JointDescription& joint,
                                                                const BuiltScene& built);

}  // namespace tumble
