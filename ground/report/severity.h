#pragma once

#include <filesystem>
#include <optional>

#include "common/base/status.h"
#include "ground/report/severity.pb.h"

namespace isotherm {

/// Reads and checks tables: rows ascend and do not overlap. Messages name the file.
Result<SeverityTables> ReadSeverityTables(const std::filesystem::path& path);
Status Validate(const SeverityTables& tables);

/// The row for a difference by the table with this basis; nullptr if none holds.
const SeverityRow* FindSeverity(const SeverityTables& tables, const std::string& basis,
                                double difference_k);

}  // namespace isotherm
