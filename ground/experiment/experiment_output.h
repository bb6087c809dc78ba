#pragma once

#include <filesystem>
#include <string>

#include "common/base/status.h"
#include "ground/experiment/experiment.h"

namespace isotherm {

/// The table and each requirement with what was measured, for a terminal.
std::string ToText(const Experiment& experiment, const ExperimentReport& report);

/// The table, one line per row; a name or number with a comma or quote in it is quoted (RFC 4180).
std::string ToCsv(const ExperimentTable& table);

/// Writes NAME.csv (the table), NAME.json (table and requirements) and NAME_<rendering>.png into
/// `dir`, which is created.
Status WriteExperiment(const Experiment& experiment, const ExperimentReport& report,
                       const std::filesystem::path& dir);

}  // namespace isotherm
