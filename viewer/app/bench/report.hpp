#pragma once
#include "engine/scene/workloads/run.hpp"

#include <span>
#include <string>

namespace tumble {

/// Header of the table of `tumble bench`.
std::string bench_head();
/// A row of the table and, indented, the time of each stage.
std::string bench_row(const WorkloadRun& run);
/// One JSON object with all runs: {"results": [...]}.
std::string bench_json(std::span<const WorkloadRun> runs);

}  // namespace tumble
