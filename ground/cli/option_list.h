#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Tells the options that a person sets for a scan from all others, which stand in `expert` blocks.
enum class OptionRing { kEveryday, kExpert };

/// Programs whose options can be listed: edge, ground, simulate.
std::vector<std::string> ProgramsWithOptions();

/// Lists the options of a program with their defaults and what they mean (the comments of the
/// .proto files): the everyday ones, followed by the others if `with_expert`. Those of one stage
/// only if `stage` is not empty ("tsdf", "tracker.external_odometry", "thermal.expert").
Result<std::string> ListOptions(std::string_view program, std::string_view stage, bool with_expert);

/// Makes a page of the documents (docs/options.md) of the options of all programs.
Result<std::string> OptionsPage();

}  // namespace isotherm
