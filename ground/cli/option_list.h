#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Programs whose options can be listed: edge, ground, simulate.
std::vector<std::string> ProgramsWithOptions();

/// Every option of a program with its default and what it means (the comments of the .proto files);
/// of one stage only if `stage` is not empty ("tsdf", "tracker.external_odometry").
Result<std::string> ListOptions(std::string_view program, std::string_view stage);

}  // namespace isotherm
