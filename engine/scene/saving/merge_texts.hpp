#pragma once
#include <optional>
#include <string>

namespace tumble {

/// The text with the changes of both `ours` and `theirs` to `base`, line by line (a three-way
/// merge; Khanna, Kunal and Pierce, "A formal investigation of diff3", 2007). Other than with
/// diff3, changes may be of lines that follow each other: each item of a scene has lines of its
/// own. Empty if the same line was changed in two ways, or lines were added at the same place.
std::optional<std::string> merge_texts(const std::string& base, const std::string& ours,
                                       const std::string& theirs);

}  // namespace tumble
